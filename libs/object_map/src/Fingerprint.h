#pragma once

#include <mrpt/poses/CPose3D.h>

#include <cstdint>
#include <cstring>

namespace semloop
{
class CObjectMap;
class LabelSet;

/** A hash over words of 64 bits, after FNV-1a (Fowler, Noll, Vo). */
class Fingerprint
{
public:
	template <class Value>
	void add(const Value& value)
	{
		static_assert(sizeof(value) <= sizeof(uint64_t));
		uint64_t word = 0;
		std::memcpy(&word, &value, sizeof(value));
		hash_ = (hash_ ^ word) * 1099511628211u;
		hash_ ^= hash_ >> 29;  // the product carries differences upwards only
	}
	void add(const mrpt::poses::CPose3D& pose);
	void add(const LabelSet& labels);
	/** What changes when the map does: labels, ids, volumes, number of observations, poses. */
	void add(const CObjectMap& map);

	uint64_t value() const { return hash_; }

private:
	uint64_t hash_ = 14695981039346656037u;
};

}  // namespace semloop

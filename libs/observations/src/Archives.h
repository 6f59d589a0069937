#pragma once

#include <mrpt/serialization/CArchive.h>
#include <semloop/config/Error.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "GzFile.h"

namespace semloop
{
/** Reads MRPT objects from a file. MRPT takes a short read for a whole one: here it throws. */
class GzArchive : public mrpt::serialization::CArchive
{
public:
	explicit GzArchive(const std::string& path) : file(path) {}

	std::string getArchiveDescription() const override { return "gz file"; }

	/** Up to count of the next bytes, which stay to be read. */
	std::string peek(std::size_t count)
	{
		const std::size_t known = ahead_.size();
		if (known < count)
		{
			ahead_.resize(count);
			ahead_.resize(known + file.read(&ahead_[known], count - known));
		}
		return ahead_.substr(0, count);
	}

	/** From here on takeCopy() has all bytes that are read. */
	void startCopy() { copy_.emplace(); }
	std::string takeCopy()
	{
		std::string bytes = std::move(*copy_);
		copy_.reset();
		return bytes;
	}

	GzInput file;

protected:
	std::size_t read(void* buffer, std::size_t count) override
	{
		const std::size_t first = ahead_.copy(static_cast<char*>(buffer), count);
		ahead_.erase(0, first);
		if (first + file.read(static_cast<uint8_t*>(buffer) + first, count - first) < count)
			throw InputError("the file ends inside an object");
		if (copy_) copy_->append(static_cast<const char*>(buffer), count);
		return count;
	}
	std::size_t write(const void*, std::size_t) override
	{
		throw std::logic_error("an archive for reading");
	}

private:
	std::string ahead_;
	std::optional<std::string> copy_;
};

/** Collects what an object writes. */
class BufferArchive : public mrpt::serialization::CArchive
{
public:
	std::string getArchiveDescription() const override { return "memory"; }
	std::vector<uint8_t> bytes;

protected:
	std::size_t read(void*, std::size_t) override
	{
		throw std::logic_error("an archive for writing");
	}
	std::size_t write(const void* data, std::size_t count) override
	{
		const auto* const first = static_cast<const uint8_t*>(data);
		bytes.insert(bytes.end(), first, first + count);
		return count;
	}
};

}  // namespace semloop

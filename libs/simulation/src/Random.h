#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace semloop
{
/** Random numbers that are functions of keys (seed, image, object, pixel, ...): the same on every
 *  platform, in every order of calls and in every thread. The distributions of <random> are not. */

/** A bijection of 64 bits in which every bit depends on every bit: the finaliser of SplitMix64
 *  (Steele, Lea and Flood, OOPSLA 2014; Stafford's variant 13). */
inline uint64_t mixed(uint64_t x)
{
	x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
	x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
	return x ^ (x >> 31);
}

constexpr uint64_t kGoldenRatio = 0x9E3779B97F4A7C15U;  //!< of 2^64; odd, so its multiples differ

/** Of the keys in their order; hashed(s, 1, 2) and hashed(s, 2, 1) are unrelated. */
template <typename... Keys>
uint64_t hashed(uint64_t seed, Keys... keys)
{
	uint64_t h = mixed(seed + kGoldenRatio);
	((h = mixed((h ^ uint64_t(keys)) + kGoldenRatio)), ...);
	return h;
}

/** FNV-1a of the bytes, for names as keys. */
uint64_t hashedText(std::string_view text);

/** Same, for numbers that serve a purpose: those of another purpose are unrelated. */
template <typename... Keys>
uint64_t hashedFor(std::string_view purpose, uint64_t seed, Keys... keys)
{
	return hashed(seed, hashedText(purpose), keys...);
}

/** The upper 53 bits as a number in [0, 1). */
inline double uniformFrom(uint64_t bits)
{
	return double(bits >> 11) * 0x1p-53;
}

/** x with Phi(x) = p for p in (0, 1), within 1e-7 of its value: Wichura, Applied Statistics 37(3),
 *  1988, AS 241, PPND7. */
double normalQuantile(double p);

/** Standard normal numbers from 21 bits, by a table, for noise of each pixel: the quantiles of
 *  multiples of 1/4096 and a straight line between. Mean 0; variance 1 and fourth moment 3 within 1 %;
 *  the distribution function is exact within 2e-5 up to 3.49 sigma; none lies beyond 4 sigma. */
class NormalTable
{
public:
	NormalTable();

	/** From the lowest 21 bits; 64 random bits give three independent numbers. */
	float operator()(uint64_t bits) const
	{
		const auto i = (bits >> kFractionBits) & (kPieces - 1);
		const float t = (float(bits & ((1U << kFractionBits) - 1)) + 0.5F) * 0x1p-9F;
		return nodes_[i] + t * (nodes_[i + 1] - nodes_[i]);
	}

	static constexpr int kBits = 21;  //!< used by a number

private:
	static constexpr int kFractionBits = 9;
	static constexpr uint64_t kPieces = uint64_t(1) << (kBits - kFractionBits);
	std::array<float, kPieces + 1> nodes_;
};

/** The table, made at the first call. */
const NormalTable& normalTable();

/** The numbers of one key, one after the other. */
class RandomStream
{
public:
	explicit RandomStream(uint64_t key) : state_(key) {}

	uint64_t bits() { return mixed(state_ += kGoldenRatio); }
	/** In [0, 1). */
	double uniform() { return uniformFrom(bits()); }
	double uniform(double from, double to) { return from + (to - from) * uniform(); }
	/** In [0, count), count > 0. */
	uint32_t below(uint32_t count) { return uint32_t(uniform() * count); }
	/** Standard normal, to +-8.2 sigma. */
	double normal() { return normalQuantile((double(bits() >> 11) + 0.5) * 0x1p-53); }
	/** A number of events of that rate, by Knuth's product of uniform numbers; for rates below 100. */
	int poisson(double rate);

private:
	uint64_t state_;
};

}  // namespace semloop

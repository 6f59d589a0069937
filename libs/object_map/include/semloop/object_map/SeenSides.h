#pragma once

#include <mrpt/math/TPoint3D.h>
#include <mrpt/poses/CPose3D.h>

#include <bitset>

namespace semloop
{
/** From which sides a box was seen: -x, +x, -y, +y and +z, the top. What stands on something has no bottom. */
class SeenSides
{
public:
	static constexpr std::size_t kSides = 5;

	SeenSides() = default;
	/** Each bit a side, in the order above; throws std::invalid_argument on more bits. */
	explicit SeenSides(unsigned long bits);

	/** A camera looks from here [m], relative to the centre of the box: it sees the sides that it looks at by more
	 *  than 20 degrees. */
	void seenFrom(const mrpt::math::TPoint3D& camera);
	/** What another box has seen whose axes are turned by this; a side goes to the nearest of ours. */
	void add(const SeenSides& other, const mrpt::poses::CPose3D& T_ours_other);

	bool all() const { return sides_.all(); }
	unsigned long bits() const { return sides_.to_ulong(); }
	/** Seen sides / all, in [0, 1]. */
	double completeness() const { return double(sides_.count()) / double(kSides); }
	/** The axis is measured from both ends, x and y; z from the top. */
	bool isMeasured(std::size_t axis) const;

private:
	std::bitset<kSides> sides_;
};

/** Standard deviation of an object's centre, for what was not seen of it, per axis [m]: a quarter of its size times
 *  (1 - completeness)^2, on top of that of an object that was seen all round. The size is the longer horizontal side
 *  [m]. Measured in simulated flats, doc/loop-detection.md. */
double centreSigma(double completeness, double size);

}  // namespace semloop

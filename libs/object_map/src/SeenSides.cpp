#include <mrpt/core/bits_math.h>
#include <semloop/object_map/SeenSides.h>

#include <array>
#include <cmath>
#include <stdexcept>

namespace semloop
{
namespace
{
using mrpt::math::TVector3D;

const std::array<TVector3D, SeenSides::kSides> kNormals{
	TVector3D(-1, 0, 0), TVector3D(1, 0, 0), TVector3D(0, -1, 0), TVector3D(0, 1, 0),
	TVector3D(0, 0, 1)};
const double kLeastSine = std::sin(mrpt::DEG2RAD(20.0));

double dot(const TVector3D& a, const TVector3D& b)
{
	return a.x * b.x + a.y * b.y + a.z * b.z;
}
}  // namespace

SeenSides::SeenSides(unsigned long bits) : sides_(bits)
{
	if (bits >= (1UL << kSides)) throw std::invalid_argument("a box has five sides to be seen");
}

void SeenSides::seenFrom(const mrpt::math::TPoint3D& camera)
{
	const double distance = camera.norm();
	for (std::size_t side = 0; side < kSides; ++side)
		if (dot(kNormals[side], camera) > kLeastSine * distance) sides_.set(side);
}

void SeenSides::add(const SeenSides& other, const mrpt::poses::CPose3D& T_ours_other)
{
	const double kNearest = std::cos(mrpt::DEG2RAD(45.0)) - 1e-9;
	for (std::size_t theirs = 0; theirs < kSides; ++theirs)
	{
		if (!other.sides_[theirs]) continue;
		const auto normal = T_ours_other.rotateVector(kNormals[theirs]);
		for (std::size_t side = 0; side < kSides; ++side)
			if (dot(kNormals[side], normal) >= kNearest) sides_.set(side);
	}
}

bool SeenSides::isMeasured(std::size_t axis) const
{
	return axis == 2 ? sides_[4] : sides_[2 * axis] && sides_[2 * axis + 1];
}

double centreSigma(double completeness, double size)
{
	return 0.25 * size * (1 - completeness) * (1 - completeness);
}

}  // namespace semloop

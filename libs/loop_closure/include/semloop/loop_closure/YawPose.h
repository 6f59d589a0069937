#pragma once

#include <mrpt/math/TPoint3D.h>
#include <mrpt/poses/CPose3D.h>

#include <cmath>
#include <optional>
#include <vector>

namespace semloop
{
/** A rigid motion that keeps gravity: p' = Rz(yaw) p + t. */
struct YawPose
{
	double cosine = 1, sine = 0;
	mrpt::math::TPoint3D translation;

	mrpt::math::TPoint3D operator*(const mrpt::math::TPoint3D& p) const
	{
		return {
			cosine * p.x - sine * p.y + translation.x, sine * p.x + cosine * p.y + translation.y,
			p.z + translation.z};
	}

	/** Takes `from` to `to`, turned by the angle whose cosine and sine are proportional to c and s. */
	static YawPose about(
		const mrpt::math::TPoint3D& from, const mrpt::math::TPoint3D& to, double c, double s)
	{
		YawPose pose;
		const double norm = std::sqrt(c * c + s * s);
		pose.cosine = c / norm;
		pose.sine = s / norm;
		pose.translation = to - pose * from;
		return pose;
	}

	mrpt::poses::CPose3D toPose3D() const
	{
		return mrpt::poses::CPose3D::FromXYZYawPitchRoll(
			translation.x, translation.y, translation.z, std::atan2(sine, cosine), 0, 0);
	}
};

/** A point and where it should come to. */
struct WeightedPair
{
	mrpt::math::TPoint3D from, to;
	double weight = 1;
};

/** The motion that minimises sum w |T from - to|^2, in closed form: the centroids coincide, and the yaw is that of
 *  sum w conj(a) b over the horizontal differences a, b from them as complex numbers. Empty when they
 *  leave the yaw open: fewer than two pairs, or all in one place. */
std::optional<YawPose> fitYawPose(const std::vector<WeightedPair>& pairs);

}  // namespace semloop

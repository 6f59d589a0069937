#pragma once

#include <mrpt/math/TPoint3D.h>
#include <mrpt/poses/CPose3D.h>

#include <cmath>

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

}  // namespace semloop

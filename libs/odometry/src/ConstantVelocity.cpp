#include <mrpt/poses/Lie/SE.h>
#include <semloop/odometry/ConstantVelocity.h>

#include <algorithm>
#include <chrono>

namespace semloop
{
namespace
{
using SE3 = mrpt::poses::Lie::SE<3>;

constexpr double kLongestStep = 1.0;    // [s]
constexpr double kShortestStep = 1e-3;  // [s]; a velocity from less than that is noise

double secondsBetween(mrpt::Clock::time_point from, mrpt::Clock::time_point to)
{
	return std::chrono::duration<double>(to - from).count();
}
}  // namespace

mrpt::poses::CPose3D ConstantVelocity::predict(mrpt::Clock::time_point time) const
{
	if (!previous_) return {};
	const double step = std::clamp(secondsBetween(*previous_, time), 0.0, kLongestStep);
	mrpt::math::CVectorFixed<double, 6> motion = velocity_;
	for (int i = 0; i < 6; i++) motion[i] *= step;
	return SE3::exp(motion);
}

void ConstantVelocity::measured(
	mrpt::Clock::time_point time, const mrpt::poses::CPose3D& T_previous_camera)
{
	const double step = previous_ ? secondsBetween(*previous_, time) : 0.0;
	previous_ = time;
	velocity_.setZero();
	if (step < kShortestStep) return;
	velocity_ = SE3::log(T_previous_camera);
	for (int i = 0; i < 6; i++) velocity_[i] /= step;
}

void ConstantVelocity::stop(mrpt::Clock::time_point time)
{
	previous_ = time;
	velocity_.setZero();
}

}  // namespace semloop

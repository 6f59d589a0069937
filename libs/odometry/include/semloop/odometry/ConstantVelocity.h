#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/poses/CPose3D.h>

#include <optional>

namespace semloop
{
/** Motion model: the camera goes on as between the last two measured poses. */
class ConstantVelocity
{
public:
	/** T_previous_camera expected at a time. Identity before two poses are known and when time does
	 *  not advance; a longer gap than a second counts as a second. */
	mrpt::poses::CPose3D predict(mrpt::Clock::time_point time) const;

	/** A pose was measured: T_previous_camera is the motion since the previous call. */
	void measured(mrpt::Clock::time_point time, const mrpt::poses::CPose3D& T_previous_camera);

	/** A pose was not measured: keeps the velocity. */
	void passed(mrpt::Clock::time_point time) { previous_ = time; }

	/** The camera's velocity is not known any more. */
	void stop(mrpt::Clock::time_point time);

private:
	std::optional<mrpt::Clock::time_point> previous_;
	mrpt::math::CVectorFixed<double, 6> velocity_{};  //!< [m/s], [rad/s], in the camera's frame
};

}  // namespace semloop

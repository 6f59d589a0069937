#pragma once

#include <mrpt/img/TColor.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <semloop/observations/Trajectory.h>

namespace semloop
{
inline const mrpt::img::TColor kTrajectoryColor(0, 90, 200);  //!< the optimised one
inline const mrpt::img::TColor kOdometryColor(150, 150, 150);

/** The camera's way in the world; without lines when there are less than two poses.
 *
 *  @param dotSize of a dot at each pose [pixels], for windows whose lines are one pixel wide at most;
 *         0: no dots, but a wider line */
mrpt::opengl::CSetOfLines::Ptr pathLine(
	const Trajectory& trajectory, const mrpt::img::TColor& color, float dotSize = 0);

}  // namespace semloop

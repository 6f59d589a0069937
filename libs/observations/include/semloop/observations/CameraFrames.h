#pragma once

#include <mrpt/poses/CPose3D.h>

namespace semloop
{
/** T_sensor_camera: takes coordinates in the camera's optical frame (x right, y down, z forward) to
 *  MRPT's sensor frame (x forward, y left, z up). Nothing else in semloop knows about this turn. */
const mrpt::poses::CPose3D& sensorFromCamera();

/** T_robot_camera for a sensor whose pose on the robot is given in MRPT's convention. */
mrpt::poses::CPose3D robotFromCamera(const mrpt::poses::CPose3D& sensorPose);

}  // namespace semloop

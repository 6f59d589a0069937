#include <mrpt/core/bits_math.h>
#include <semloop/observations/CameraFrames.h>

namespace semloop
{
const mrpt::poses::CPose3D& sensorFromCamera()
{
	using namespace mrpt;  // for _deg
	static const auto turn =
		mrpt::poses::CPose3D::FromXYZYawPitchRoll(0, 0, 0, -90.0_deg, 0.0_deg, -90.0_deg);
	return turn;
}

mrpt::poses::CPose3D robotFromCamera(const mrpt::poses::CPose3D& sensorPose)
{
	return sensorPose + sensorFromCamera();
}

}  // namespace semloop

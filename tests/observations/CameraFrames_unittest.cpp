#include <gtest/gtest.h>
#include <mrpt/math/TPoint3D.h>
#include <semloop/observations/CameraFrames.h>

using mrpt::math::TPoint3D;
using mrpt::poses::CPose3D;

namespace
{
void expectNear(const TPoint3D& a, const TPoint3D& b)
{
	EXPECT_NEAR((a - b).norm(), 0.0, 1e-12) << a.asString() << " " << b.asString();
}
}  // namespace

TEST(CameraFrames, TheOpticalAxisIsTheSensorsForwardAxis)
{
	const auto& T = semloop::sensorFromCamera();
	expectNear(T.composePoint(TPoint3D(0, 0, 1)), {1, 0, 0});
	expectNear(T.composePoint(TPoint3D(1, 0, 0)), {0, -1, 0});  // right
	expectNear(T.composePoint(TPoint3D(0, 1, 0)), {0, 0, -1});  // down
}

TEST(CameraFrames, ASensorOnTheRobotMovesTheCameraWithIt)
{
	const auto pose = CPose3D::FromXYZYawPitchRoll(1, 2, 3, M_PI / 2, 0, 0);  // looks along y
	expectNear(semloop::robotFromCamera(pose).composePoint(TPoint3D(0, 0, 2)), {1, 4, 3});
}

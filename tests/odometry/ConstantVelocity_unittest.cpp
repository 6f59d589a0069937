#include <semloop/odometry/ConstantVelocity.h>

#include "OdometryFixtures.h"

namespace semloop::test
{
namespace
{
TEST(ConstantVelocity, ExpectsNoMotionBeforeTwoPosesAreKnown)
{
	ConstantVelocity model;
	EXPECT_EQ(model.predict(at(1)).norm(), 0);
	model.measured(at(0), CPose3D());
	EXPECT_EQ(model.predict(at(1)).norm(), 0);
}

TEST(ConstantVelocity, ScalesTheLastMotionWithTheTimeThatPassed)
{
	ConstantVelocity model;
	model.measured(at(0), CPose3D());
	model.measured(at(0.1), CPose3D(0.02, 0, 0.01, 0.03, 0, 0));
	expectPoseNear(model.predict(at(0.2)), CPose3D(0.02, 0, 0.01, 0.03, 0, 0), 1e-7, 1e-7);
	expectPoseNear(model.predict(at(0.3)), CPose3D(0.04, 0, 0.02, 0.06, 0, 0), 1e-7, 1e-7);
}

TEST(ConstantVelocity, KeepsTheVelocityWhileNothingIsMeasured)
{
	ConstantVelocity model;
	model.measured(at(0), CPose3D());
	model.measured(at(0.1), CPose3D(0.02, 0, 0, 0, 0, 0));
	model.passed(at(0.2));
	EXPECT_NEAR(model.predict(at(0.3)).x(), 0.02, 1e-7);
	model.stop(at(0.3));
	EXPECT_EQ(model.predict(at(0.4)).norm(), 0);
}

TEST(ConstantVelocity, DoesNotRunAwayOverALongGapOrBackInTime)
{
	ConstantVelocity model;
	model.measured(at(0), CPose3D());
	model.measured(at(0.1), CPose3D(0.1, 0, 0, 0, 0, 0));
	EXPECT_NEAR(model.predict(at(100)).x(), 1.0, 1e-6);  // 1 m/s for at most a second
	EXPECT_EQ(model.predict(at(0)).norm(), 0);
}

TEST(ConstantVelocity, TakesTwoPosesAtOneTimeForNoVelocity)
{
	ConstantVelocity model;
	model.measured(at(0), CPose3D());
	model.measured(at(0), CPose3D(0.1, 0, 0, 0, 0, 0));
	EXPECT_EQ(model.predict(at(1)).norm(), 0);
}
}  // namespace
}  // namespace semloop::test

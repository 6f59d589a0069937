#include "../../libs/odometry/src/PoseAlgebra.h"

#include "OdometryFixtures.h"

namespace semloop::test
{
namespace
{
using Vector6 = Eigen::Matrix<double, 6, 1>;

TEST(PoseAlgebra, AdjointMovesASmallMotionThroughAPose)
{
	// exp(Ad(T) e) = T exp(e) T^-1, to first order in e.
	const CPose3D T(0.4, -1.2, 2.0, 0.8, -0.3, 1.9);
	for (int i = 0; i < 6; i++)
	{
		Vector6 e = Vector6::Zero();
		e(i) = 1e-6;
		const Vector6 moved = adjoint(T) * e;
		const CPose3D conjugate = T + toPose(smallMotion(e)) + (-T);
		expectPoseNear(toPose(smallMotion(moved)), conjugate, 1e-11, 1e-11);
	}
}

TEST(PoseAlgebra, CovarianceSeenFromATurnedFrameHasItsAxesSwapped)
{
	Matrix6 C = Matrix6::Zero();
	C(0, 0) = 4;                                   // along x of a
	const CPose3D T_a_b(0, 0, 0, M_PI / 2, 0, 0);  // y of b is -x of a
	const Matrix6 seen = covarianceSeenFrom(T_a_b, C);
	EXPECT_NEAR(seen(1, 1), 4, 1e-12);
	EXPECT_NEAR(seen(0, 0), 0, 1e-12);
}

TEST(PoseAlgebra, AnUncertainTurnMovesWhatIsFarAway)
{
	Matrix6 C = Matrix6::Zero();
	C(5, 5) = 0.01;  // 0.1 rad about z
	const Matrix6 seen = covarianceSeenFrom(CPose3D(2, 0, 0, 0, 0, 0), C);
	EXPECT_NEAR(seen(1, 1), 0.04, 1e-12);  // 2 m * 0.1 rad, sideways
	EXPECT_NEAR(seen(0, 0), 0, 1e-12);
}

TEST(PoseAlgebra, KeepsALongChainOfInversesOrthonormal)
{
	const CPose3D step(0.01, 0, 0.01, 0.02, 0.01, -0.01);
	CPose3D pose, velocity = step;
	for (int i = 0; i < 1000; i++)
	{
		const CPose3D next = orthonormalized(pose + velocity);
		velocity = next - pose;
		pose = next;
	}
	const Eigen::Matrix3d R = toIsometry(pose).linear();
	EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
	expectPoseNear(velocity, step, 1e-9, 1e-9);
}

TEST(PoseAlgebra, RotationAngleIsZeroForIdentityAndPiForAHalfTurn)
{
	EXPECT_EQ(rotationAngle(CPose3D()), 0);
	EXPECT_NEAR(rotationAngle(CPose3D(1, 2, 3, M_PI, 0, 0)), M_PI, 1e-9);
}
}  // namespace
}  // namespace semloop::test

#include <gtest/gtest.h>
#include <mrpt/poses/Lie/SE.h>
#include <semloop/pose_graph/PoseResidual.h>

#include <random>
#include <unsupported/Eigen/MatrixFunctions>

#include "Fixtures.h"

namespace semloop
{
namespace
{
using mrpt::poses::CPose3D;
using LieSE3 = mrpt::poses::Lie::SE<3>;

Eigen::Matrix4d hat(const Vector6& xi)
{
	Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
	m(0, 1) = -(m(1, 0) = xi[5]);
	m(2, 0) = -(m(0, 2) = xi[4]);
	m(1, 2) = -(m(2, 1) = xi[3]);
	m.topRightCorner<3, 1>() = xi.head<3>();
	return m;
}

Eigen::Matrix4d matrixOf(const RigidTransform& T)
{
	Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
	m.topLeftCorner<3, 3>() = T.rotation.toRotationMatrix();
	m.topRightCorner<3, 1>() = T.translation;
	return m;
}

RigidTransform randomTransform(std::mt19937& random, double rotation)
{
	return exponential(randomVector(random, 3, rotation));
}

/** de/d(step) of one node by central differences; the step is the solver's, T exp(d). */
Matrix6 numericJacobian(
	const RigidTransform& Z, const RigidTransform& a, const RigidTransform& b, bool ofA)
{
	constexpr double h = 1e-5;
	Matrix6 J;
	for (int i = 0; i < 6; ++i)
	{
		const RigidTransform plus = exponential(h * Vector6::Unit(i));
		const RigidTransform minus = exponential(-h * Vector6::Unit(i));
		const Vector6 ahead = poseResidual(Z, ofA ? a * plus : a, ofA ? b : b * plus);
		const Vector6 behind = poseResidual(Z, ofA ? a * minus : a, ofA ? b : b * minus);
		J.col(i) = (ahead - behind) / (2 * h);
	}
	return J;
}

TEST(PoseResidual, LogarithmOfAQuarterTurnOnTheUnitCircleIsTheArc)
{
	// Driving the arc from (0, 0) to (1, 1) while turning left: pi/2 long, all of it along x.
	const Vector6 xi = logarithm(RigidTransform::fromPose(pose(1, 1, 0, kPi / 2)));
	Vector6 expected;
	expected << kPi / 2, 0, 0, 0, 0, kPi / 2;
	EXPECT_LT((xi - expected).norm(), 1e-14);
}

TEST(PoseResidual, ExponentialIsTheMatrixExponential)
{
	std::mt19937 random(1);
	for (const double angle : {0.0, 1e-8, 1e-3, 0.05, 0.11, 1.0, 1.8})
	{
		const Vector6 xi = randomVector(random, 2, angle);
		const Eigen::Matrix4d expected = hat(xi).exp();
		EXPECT_LT((matrixOf(exponential(xi)) - expected).norm(), 1e-13) << "angle " << angle;
	}
}

TEST(PoseResidual, LogarithmUndoesTheExponentialUpToHalfATurn)
{
	std::mt19937 random(2);
	for (const double angle : {0.0, 1e-12, 1e-6, 0.0999, 0.1001, 1.0, 3.0, 3.14159})
	{
		Vector6 xi = randomVector(random, 2, 1);
		xi.tail<3>() *= angle / xi.tail<3>().norm();
		EXPECT_LT((logarithm(exponential(xi)) - xi).norm(), 1e-11) << "angle " << angle;
	}
}

TEST(PoseResidual, TheSignOfTheQuaternionDoesNotMatter)
{
	RigidTransform T = RigidTransform::fromPose(pose(1, 2, 3, 0.4, -0.2, 1.1));
	const Vector6 xi = logarithm(T);
	T.rotation.coeffs() *= -1;
	EXPECT_LT((logarithm(T) - xi).norm(), 1e-15);
}

TEST(PoseResidual, RotationPartAndOrderAgreeWithMrpt)
{
	const CPose3D T = pose(1, 2, 3, 0.4, -0.2, 1.1);
	const auto theirs = LieSE3::log(T);
	const Vector6 ours = logarithm(RigidTransform::fromPose(T));
	for (int i = 3; i < 6; ++i) EXPECT_NEAR(ours[i], theirs[i], 1e-12);
}

TEST(PoseResidual, ConvertsToMrptPosesAndBack)
{
	const CPose3D T = pose(1, -2, 3, 3.0, 0.5, -2.0);
	EXPECT_LT(difference(T, RigidTransform::fromPose(T).toPose()), 1e-14);
}

TEST(PoseResidual, IsZeroWhereTheMeasurementHolds)
{
	const CPose3D a = pose(1, 2, 0, 0.5), Z = pose(0.3, 0, 0.1, -0.2, 0.4);
	const Vector6 e = poseResidual(
		RigidTransform::fromPose(Z), RigidTransform::fromPose(a), RigidTransform::fromPose(a + Z));
	EXPECT_LT(e.norm(), 1e-14);
}

TEST(PoseResidual, PureTranslationErrorIsInTheFrameOfB)
{
	// b stands 0.1 m further along the world's x than measured, and looks along the world's y.
	const RigidTransform Z = RigidTransform::fromPose(pose(1, 0, 0, kPi / 2));
	const Vector6 e = poseResidual(Z, {}, RigidTransform::fromPose(pose(1.1, 0, 0, kPi / 2)));
	EXPECT_NEAR(e[0], 0, 1e-15);
	EXPECT_NEAR(e[1], -0.1, 1e-15);
	EXPECT_LT(e.tail<4>().norm(), 1e-15);
}

TEST(PoseResidual, DoesNotChangeWhenTheWorldIsMoved)
{
	std::mt19937 random(3);
	const RigidTransform Z = randomTransform(random, 1), a = randomTransform(random, 1),
						 b = randomTransform(random, 1), world = randomTransform(random, 1);
	EXPECT_LT((poseResidual(Z, a, b) - poseResidual(Z, world * a, world * b)).norm(), 1e-12);
}

TEST(PoseResidual, JacobiansAgreeWithNumericOnesForErrorsFromNoneToLarge)
{
	std::mt19937 random(4);
	for (const double size : {0.0, 1e-4, 0.05, 0.0578, 0.3, 1.0, 1.7})
	{
		const RigidTransform a = randomTransform(random, 1.5), Z = randomTransform(random, 1.5);
		const RigidTransform b = a * Z * exponential(size * randomVector(random, 2, 1));
		Matrix6 J_a, J_b;
		poseResidual(Z, a, b, &J_a, &J_b);
		// Central differences with steps of 1e-5 err by about 1e-10 times the third derivative.
		EXPECT_LT((J_a - numericJacobian(Z, a, b, true)).cwiseAbs().maxCoeff(), 2e-8) << size;
		EXPECT_LT((J_b - numericJacobian(Z, a, b, false)).cwiseAbs().maxCoeff(), 2e-8) << size;
	}
}

TEST(PoseResidual, SeriesAndClosedFormMeetWhereTheyChange)
{
	Vector6 xi;
	xi << 1, -2, 0.5, 0.06, 0.08, 0;
	Vector6 below = xi, above = xi;
	below.tail<3>() *= 1 - 1e-10;
	above.tail<3>() *= 1 + 1e-10;
	const Matrix6 step = inverseRightJacobian(above) - inverseRightJacobian(below);
	EXPECT_LT(step.cwiseAbs().maxCoeff(), 1e-9);
}

TEST(PoseResidual, AdjointMovesAStepToTheOtherSide)
{
	std::mt19937 random(5);
	const RigidTransform T = randomTransform(random, 2);
	const Vector6 d = randomVector(random, 0.5, 0.5);
	const RigidTransform left = T * exponential(d), right = exponential(adjoint(T) * d) * T;
	EXPECT_LT((matrixOf(left) - matrixOf(right)).norm(), 1e-13);
}
}  // namespace
}  // namespace semloop

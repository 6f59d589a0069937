#pragma once

#include <ceres/manifold.h>
#include <ceres/sized_cost_function.h>
#include <semloop/pose_graph/PoseResidual.h>

#include <Eigen/Cholesky>
#include <array>

namespace semloop
{
// A node as Ceres sees it: qx qy qz qw tx ty tz.
using State = std::array<double, 7>;
using Jacobian67 = Eigen::Matrix<double, 6, 7, Eigen::RowMajor>;
using Jacobian76 = Eigen::Matrix<double, 7, 6, Eigen::RowMajor>;

inline RigidTransform transformOf(const double* state)
{
	return {Eigen::Quaterniond(state), Eigen::Vector3d(state + 4)};
}

inline void store(const RigidTransform& T, double* state)
{
	Eigen::Map<Eigen::Matrix<double, 7, 1>> all(state);
	all << T.rotation.normalized().coeffs(), T.translation;
}

/** Derivative of q (x) (phi / 2, 1) by phi, for coefficients x y z w. */
inline Eigen::Matrix<double, 4, 3> quaternionByPhi(const Eigen::Quaterniond& q)
{
	Eigen::Matrix<double, 4, 3> J;
	J << q.w(), -q.z(), q.y(), q.z(), q.w(), -q.x(), -q.y(), q.x(), q.w(), -q.x(), -q.y(), -q.z();
	return 0.5 * J;
}

/** Derivative of the step (rho, phi) by the state, at a step of zero. */
inline Jacobian67 stepByState(const double* state)
{
	const RigidTransform T = transformOf(state);
	Jacobian67 J = Jacobian67::Zero();
	J.topRightCorner<3, 3>() = T.rotation.toRotationMatrix().transpose();
	J.bottomLeftCorner<3, 4>() = 4.0 * quaternionByPhi(T.rotation).transpose();
	return J;
}

/** T (+) (rho, phi) = (t + R rho, q (x) exp(phi)). */
class PoseManifold : public ceres::Manifold
{
public:
	int AmbientSize() const override { return 7; }
	int TangentSize() const override { return 6; }

	bool Plus(const double* x, const double* delta, double* result) const override
	{
		const Eigen::Map<const Vector6> step(delta);
		const RigidTransform T = transformOf(x);
		Vector6 turn = step;
		turn.head<3>().setZero();
		store(
			{T.rotation * exponential(turn).rotation, T.translation + T.rotation * step.head<3>()},
			result);
		return true;
	}

	bool PlusJacobian(const double* x, double* jacobian) const override
	{
		const RigidTransform T = transformOf(x);
		Eigen::Map<Jacobian76> J(jacobian);
		J.setZero();
		J.topRightCorner<4, 3>() = quaternionByPhi(T.rotation);
		J.bottomLeftCorner<3, 3>() = T.rotation.toRotationMatrix();
		return true;
	}

	bool Minus(const double* y, const double* x, double* result) const override
	{
		const RigidTransform T = transformOf(x).inverse() * transformOf(y);
		Eigen::Map<Vector6> step(result);
		step << T.translation, logarithm({T.rotation, Eigen::Vector3d::Zero()}).tail<3>();
		return true;
	}

	bool MinusJacobian(const double* x, double* jacobian) const override
	{
		Eigen::Map<Jacobian67> J(jacobian);
		J = stepByState(x);
		return true;
	}
};

/** L^T log(Z^-1 T_a^-1 T_b), Eq. (7), with L L^T = information. */
class RelativePoseCost : public ceres::SizedCostFunction<6, 7, 7>
{
public:
	explicit RelativePoseCost(const PoseEdge& edge)
		: Z_(RigidTransform::fromPose(edge.Z_a_b)),
		  whitening_(edge.information.llt().matrixL().transpose())
	{
	}

	bool Evaluate(double const* const* states, double* residuals, double** jacobians) const override
	{
		const RigidTransform T_a = transformOf(states[0]), T_b = transformOf(states[1]);
		Eigen::Map<Vector6> whitened(residuals);
		if (!jacobians)
		{
			whitened = whitening_ * poseResidual(Z_, T_a, T_b);
			return whitened.allFinite();
		}
		std::array<Matrix6, 2> J;
		whitened = whitening_ * poseResidual(Z_, T_a, T_b, &J[0], &J[1]);
		// Ceres multiplies by PlusJacobian again: a step's derivative comes back as it was.
		for (std::size_t i = 0; i < 2; ++i)
			if (jacobians[i])
				Eigen::Map<Jacobian67>(jacobians[i]).noalias() =
					(whitening_ * J[i]) * stepByState(states[i]);
		return whitened.allFinite();
	}

private:
	RigidTransform Z_;
	Matrix6 whitening_;
};

}  // namespace semloop

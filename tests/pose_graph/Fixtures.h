#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/pose_graph/PoseGraph.h>
#include <semloop/pose_graph/PoseResidual.h>

#include <Eigen/Core>
#include <cmath>
#include <random>
#include <vector>

namespace semloop
{
inline constexpr double kPi = 3.14159265358979323846;

/** x, y, z [m], yaw, pitch, roll [rad]. */
inline mrpt::poses::CPose3D pose(
	double x, double y, double z = 0, double yaw = 0, double pitch = 0, double roll = 0)
{
	return {x, y, z, yaw, pitch, roll};
}

inline Vector6 randomVector(std::mt19937& random, double translation, double rotation)
{
	std::uniform_real_distribution<double> unit(-1, 1);
	Vector6 v;
	for (int i = 0; i < 6; ++i) v[i] = unit(random) * (i < 3 ? translation : rotation);
	return v;
}

inline Matrix6 randomInformation(std::mt19937& random)
{
	Matrix6 m;
	for (int i = 0; i < 6; ++i) m.col(i) = randomVector(random, 1, 1);
	return m * m.transpose() + Matrix6::Identity();
}

inline Matrix6 information(double sigmaTranslation, double sigmaRotation)
{
	Matrix6 m = Matrix6::Zero();
	m.diagonal().head<3>().setConstant(1 / (sigmaTranslation * sigmaTranslation));
	m.diagonal().tail<3>().setConstant(1 / (sigmaRotation * sigmaRotation));
	return m;
}

/** The residual of an edge, from the poses that the graph has. */
inline Vector6 residual(const PoseGraph& graph, const PoseEdge& edge)
{
	return poseResidual(
		RigidTransform::fromPose(edge.Z_a_b), RigidTransform::fromPose(graph.pose(edge.a)),
		RigidTransform::fromPose(graph.pose(edge.b)));
}

inline double cost(const PoseGraph& graph)
{
	double sum = 0;
	for (const PoseEdge& edge : graph.edges())
	{
		const Vector6 e = residual(graph, edge);
		sum += 0.5 * e.dot(edge.information * e);
	}
	return sum;
}

/** Length of the relative motion's translation plus its angle. */
inline double difference(const mrpt::poses::CPose3D& a, const mrpt::poses::CPose3D& b)
{
	const Vector6 e =
		logarithm(RigidTransform::fromPose(a).inverse() * RigidTransform::fromPose(b));
	return e.head<3>().norm() + e.tail<3>().norm();
}

}  // namespace semloop

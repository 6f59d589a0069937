#pragma once

#include <semloop/pose_graph/G2oFile.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>

// What reading and writing g2o files share.
namespace semloop
{
inline constexpr uint64_t kLargestId = std::numeric_limits<int32_t>::max();
inline constexpr const char* kVertex = "VERTEX_SE3:QUAT";
inline constexpr const char* kEdge = "EDGE_SE3:QUAT";
inline constexpr const char* kFix = "FIX";
inline constexpr std::array<const char*, 3> kKindNames = {"odometry", "observation", "loop"};

inline const char* nameOf(PoseEdge::Kind kind)
{
	return kKindNames.at(static_cast<std::size_t>(kind));
}

/** e_file = scale e_ours. */
inline Vector6 residualScale(G2oRotation rotation)
{
	Vector6 scale = Vector6::Ones();
	if (rotation == G2oRotation::QuaternionVector) scale.tail<3>().setConstant(0.5);
	return scale;
}

/** The kind that an edge has when no comment line says otherwise. */
inline PoseEdge::Kind usualKind(
	const PoseEdge& edge, const std::map<NodeId, mrpt::poses::CPose3D>& nodes)
{
	if (edge.a.kind == NodeId::Kind::Object || edge.b.kind == NodeId::Kind::Object)
		return PoseEdge::Kind::Observation;
	const auto next = std::next(nodes.find(std::min(edge.a, edge.b)));
	const bool neighbours = next != nodes.end() && next->first == std::max(edge.a, edge.b);
	return neighbours ? PoseEdge::Kind::Odometry : PoseEdge::Kind::Loop;
}

}  // namespace semloop

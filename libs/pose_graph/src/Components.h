#pragma once

#include <semloop/pose_graph/PoseGraph.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace semloop
{
/** One node of each connected component: the fixed camera in its own, the first one elsewhere. */
std::set<NodeId> nodesToHold(
	const std::map<NodeId, mrpt::poses::CPose3D>& nodes, const std::vector<PoseEdge>& edges,
	const std::optional<NodeId>& fixedCamera);

/** For the report: "; parts not joined to camera 0: 2, each held at its first node (camera 7, object 4)";
 *  empty when all is one part. */
std::string describeParts(std::set<NodeId> held, const std::optional<NodeId>& fixedCamera);

}  // namespace semloop

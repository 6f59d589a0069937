#include "Components.h"

namespace semloop
{
std::set<NodeId> nodesToHold(
	const std::map<NodeId, mrpt::poses::CPose3D>& nodes, const std::vector<PoseEdge>& edges,
	const std::optional<NodeId>& fixedCamera)
{
	std::map<NodeId, NodeId> parent;
	for (const auto& [id, pose] : nodes) parent.emplace(id, id);
	const auto root = [&](NodeId id)
	{
		while (!(parent.at(id) == id))
		{
			parent.at(id) = parent.at(parent.at(id));
			id = parent.at(id);
		}
		return id;
	};
	// The smaller id becomes the root, so that a root is its component's first node.
	for (const PoseEdge& edge : edges)
	{
		const NodeId a = root(edge.a), b = root(edge.b);
		if (a < b)
			parent.at(b) = a;
		else
			parent.at(a) = b;
	}
	std::set<NodeId> held;
	for (const auto& [id, pose] : nodes) held.insert(root(id));
	if (fixedCamera)
	{
		held.erase(root(*fixedCamera));
		held.insert(*fixedCamera);
	}
	return held;
}

std::string describeParts(std::set<NodeId> held, const std::optional<NodeId>& fixedCamera)
{
	constexpr std::size_t kNamed = 5;
	const NodeId main = fixedCamera ? *fixedCamera : *held.begin();
	held.erase(main);
	if (held.empty()) return "";
	std::string text = "; parts not joined to " + toString(main) + ": " +
					   std::to_string(held.size()) + ", each held at its first node (";
	std::size_t named = 0;
	for (const NodeId& id : held)
	{
		if (named == kNamed) return text + ", ...)";
		text += (named++ ? ", " : "") + toString(id);
	}
	return text + ")";
}

}  // namespace semloop

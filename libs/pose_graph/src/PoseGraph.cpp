#include <semloop/pose_graph/PoseGraph.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(PoseGraph, mrpt::rtti::CObject, semloop)

namespace semloop
{
namespace
{
bool isFinite(const mrpt::poses::CPose3D& pose)
{
	return std::isfinite(pose.x()) && std::isfinite(pose.y()) && std::isfinite(pose.z()) &&
		   pose.getRotationMatrix().asEigen().allFinite();
}

bool isSymmetricPositiveDefinite(const Matrix6& m)
{
	if (!m.allFinite()) return false;
	const double largest = m.cwiseAbs().maxCoeff();
	if ((m - m.transpose()).cwiseAbs().maxCoeff() > 1e-9 * largest) return false;
	const Eigen::LLT<Matrix6> cholesky(m);
	return cholesky.info() == Eigen::Success && cholesky.matrixLLT().allFinite();
}

std::string name(const PoseEdge& edge)
{
	return "edge from " + toString(edge.a) + " to " + toString(edge.b);
}
}  // namespace

std::string toString(const NodeId& id)
{
	return (id.kind == NodeId::Kind::Camera ? "camera " : "object ") + std::to_string(id.index);
}

void PoseGraph::setNode(const NodeId& id, const mrpt::poses::CPose3D& pose)
{
	if (!isFinite(pose)) throw std::invalid_argument(toString(id) + ": its pose is not finite");
	nodes_[id] = pose;
	if (!fixedCamera_ && id.kind == NodeId::Kind::Camera) fixedCamera_ = id;
}

void PoseGraph::addEdge(const PoseEdge& edge)
{
	for (const NodeId& id : {edge.a, edge.b})
		if (!has(id))
			throw std::invalid_argument(
				name(edge) + ": " + toString(id) + " is not in the graph; add its node first");
	if (edge.a == edge.b) throw std::invalid_argument(name(edge) + ": joins a node to itself");
	if (!isFinite(edge.Z_a_b))
		throw std::invalid_argument(name(edge) + ": the measured pose is not finite");
	if (!isSymmetricPositiveDefinite(edge.information))
		throw std::invalid_argument(
			name(edge) + ": the information matrix is not symmetric positive definite");
	edges_.push_back(edge);
}

void PoseGraph::removeObject(uint64_t object)
{
	const NodeId id = NodeId::object(object);
	if (nodes_.erase(id) == 0)
		throw std::invalid_argument("removing an object: no " + toString(id));
	const auto touches = [&](const PoseEdge& edge) { return edge.a == id || edge.b == id; };
	edges_.erase(std::remove_if(edges_.begin(), edges_.end(), touches), edges_.end());
}

const mrpt::poses::CPose3D& PoseGraph::pose(const NodeId& id) const
{
	const auto node = nodes_.find(id);
	if (node == nodes_.end()) throw std::out_of_range("no " + toString(id) + " in the pose graph");
	return node->second;
}

}  // namespace semloop

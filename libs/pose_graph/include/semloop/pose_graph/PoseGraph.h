#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/rtti/CObject.h>

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace semloop
{
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/** A node of the graph: T_world_camera of a frame, or T_world_object. */
struct NodeId
{
	enum class Kind : uint8_t
	{
		Camera,
		Object
	};
	Kind kind = Kind::Camera;
	uint64_t index = 0;

	static NodeId camera(uint64_t index) { return {Kind::Camera, index}; }
	static NodeId object(uint64_t index) { return {Kind::Object, index}; }
	bool operator<(const NodeId& o) const
	{
		return kind != o.kind ? kind < o.kind : index < o.index;
	}
	bool operator==(const NodeId& o) const { return kind == o.kind && index == o.index; }
};

/** "camera 12", "object 3". */
std::string toString(const NodeId& id);

/** A measurement Z_a_b of the relative pose T_a_b = T_world_a^-1 T_world_b, with residual
 *  e = log(Z^-1 T_world_a^-1 T_world_b) in mrpt::poses::Lie::SE<3>'s order (translation, rotation)
 *  and cost 1/2 e^T information e: both residuals of Eq. (7) (e_cc: a = camera i, b = camera i + 1;
 *  e_oc: a = object j, b = camera i). See PoseResidual.h. */
struct PoseEdge
{
	enum class Kind : uint8_t
	{
		Odometry,     //!< camera to camera
		Observation,  //!< object to camera
		Loop          //!< from a loop closure: under a robust loss
	};
	Kind kind = Kind::Odometry;
	NodeId a, b;
	mrpt::poses::CPose3D Z_a_b;
	Matrix6 information = Matrix6::Identity();  //!< inverse covariance, positive definite
};

struct OptimizationReport
{
	/** Half the sum of the squared whitened residuals, those of loop edges under their loss. */
	double initialCost = 0.0;
	double finalCost = 0.0;  //!< same, at the poses that the graph has afterwards
	int iterations = 0;
	bool converged = false;
	std::string message;  //!< why it stopped, one line
	double milliseconds = 0.0;
};

/** Cameras and objects in SE(3) (Sec. III-D). A module. */
class PoseGraph : public mrpt::rtti::CObject
{
	DEFINE_VIRTUAL_MRPT_OBJECT(PoseGraph)

public:
	virtual void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) = 0;

	/** Adds a node or sets its pose. The first camera that is added stays fixed: it is the world.
	 *  Throws std::invalid_argument on a pose that is not finite. */
	void setNode(const NodeId& id, const mrpt::poses::CPose3D& pose);
	/** Throws std::invalid_argument on an unknown node, an edge from a node to itself, a pose that is
	 *  not finite, or an information matrix that is not symmetric positive definite. */
	void addEdge(const PoseEdge& edge);
	/** Removes an object's node and edges; throws std::invalid_argument on an unknown object. */
	void removeObject(uint64_t object);

	const std::map<NodeId, mrpt::poses::CPose3D>& nodes() const { return nodes_; }
	const std::vector<PoseEdge>& edges() const { return edges_; }
	const mrpt::poses::CPose3D& pose(const NodeId& id) const;  //!< throws std::out_of_range
	bool has(const NodeId& id) const { return nodes_.count(id) > 0; }

	/** The first camera that was added; empty while there is none. */
	const std::optional<NodeId>& fixedCamera() const { return fixedCamera_; }

	/** Minimises Eq. (7) from the current poses; the poses change only when the result is finite.
	 *
	 *  A part of the graph that no chain of edges joins to the fixed camera is optimised on its own,
	 *  its first node (cameras before objects, by index) held in place; the message names it. */
	virtual OptimizationReport optimize() = 0;

protected:
	std::optional<NodeId> fixedCamera_;
	std::map<NodeId, mrpt::poses::CPose3D> nodes_;
	std::vector<PoseEdge> edges_;
};

}  // namespace semloop

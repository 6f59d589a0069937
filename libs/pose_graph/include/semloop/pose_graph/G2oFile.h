#pragma once

#include <semloop/pose_graph/PoseGraph.h>

#include <string>

namespace semloop
{
/** What the last three rows of an information matrix in a g2o file speak of. */
enum class G2oRotation
{
	/** The rotation vector [rad]: how the public benchmarks are commonly read and their costs quoted
	 *  (Ceres' and GTSAM's examples, SE-Sync). */
	RotationVector,
	/** The vector part of the quaternion, half the rotation vector to first order: the residual that
	 *  g2o itself minimises. A rotation block of the file is 4 times ours. */
	QuaternionVector
};

/** Adds the nodes and edges of a g2o file (R. Kuemmerle et al., "g2o: A general framework for graph
 *  optimization", ICRA 2011) to an empty graph. Records, in any order:
 *
 *      VERTEX_SE3:QUAT id  x y z  qx qy qz qw
 *      EDGE_SE3:QUAT a b  x y z  qx qy qz qw  (21 numbers: upper triangle of the information, by rows)
 *      FIX id             the camera that stays in place; without it the first camera of the file
 *
 *  A vertex is a camera and its id the index, unless a line `# semloop first_object_id N` comes
 *  first: then ids from N on are objects with index id - N. An edge is of kind Observation when it
 *  has an object, Odometry when its cameras are neighbours in the order of ids, Loop otherwise; a
 *  line `# semloop kind odometry|observation|loop` overrules that for the next edge. Other lines
 *  that begin with # and empty lines are passed over.
 *
 *  Throws InputError naming file and line on an unreadable file, another record, a cut or overlong
 *  line, a number that is not finite, a quaternion whose length is not 1 within 1 %, a repeated or
 *  unknown id, a second FIX, or an information matrix that is not positive definite; then the graph
 *  may hold a part of the file. Throws std::invalid_argument when the graph is not empty. */
void readG2o(
	const std::string& path, PoseGraph& graph, G2oRotation rotation = G2oRotation::RotationVector);

/** Writes a graph so that readG2o() gives it back, and g2o's own tools read it too: objects get ids
 *  beyond the cameras', and what g2o has no record for stands in comment lines. Throws InputError
 *  when the file cannot be written or an id does not fit in g2o's 31 bits. */
void writeG2o(
	const std::string& path, const PoseGraph& graph,
	G2oRotation rotation = G2oRotation::RotationVector);

}  // namespace semloop

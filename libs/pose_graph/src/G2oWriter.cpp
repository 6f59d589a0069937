#include <semloop/config/Error.h>
#include <semloop/pose_graph/PoseResidual.h>

#include <fstream>
#include <ostream>
#include <string>

#include "G2oRecords.h"

namespace semloop
{
namespace
{
void writeTransform(std::ostream& out, const mrpt::poses::CPose3D& pose)
{
	const RigidTransform T = RigidTransform::fromPose(pose);
	for (int i = 0; i < 3; ++i) out << ' ' << T.translation[i];
	for (int i = 0; i < 4; ++i) out << ' ' << T.rotation.coeffs()[i];
}

void writeInformation(std::ostream& out, const Matrix6& information, const Vector6& scale)
{
	for (int row = 0; row < 6; ++row)
		for (int column = row; column < 6; ++column)
			out << ' ' << information(row, column) / (scale[row] * scale[column]);
}
}  // namespace

void writeG2o(const std::string& path, const PoseGraph& graph, G2oRotation rotation)
{
	uint64_t cameraIds = 0, objectIds = 0;
	for (const auto& [id, pose] : graph.nodes())
		(id.kind == NodeId::Kind::Camera ? cameraIds : objectIds) = id.index + 1;
	// A power of ten keeps the objects' indices legible in the ids.
	uint64_t firstObjectId = 1000;
	while (firstObjectId < cameraIds) firstObjectId *= 10;
	if (cameraIds > kLargestId + 1 || (objectIds > 0 && firstObjectId + objectIds > kLargestId + 1))
		throw InputError(path + ": not written, g2o has no ids beyond 2^31 - 1");

	std::ofstream out(path);
	if (!out) throw InputError(path + ": cannot be written; does its folder exist?");
	out.precision(std::numeric_limits<double>::max_digits10);
	const auto vertexOf = [&](const NodeId& id)
	{ return id.kind == NodeId::Kind::Camera ? id.index : firstObjectId + id.index; };

	out << "# A pose graph of semloop: cameras first, then objects.\n"
		<< "# Information: translation [m], then "
		<< (rotation == G2oRotation::RotationVector ? "rotation vector [rad]"
													: "quaternion vector part")
		<< ".\n";
	if (objectIds > 0) out << "# semloop first_object_id " << firstObjectId << "\n";
	for (const auto& [id, pose] : graph.nodes())
	{
		out << kVertex << ' ' << vertexOf(id);
		writeTransform(out, pose);
		out << "\n";
	}
	if (graph.fixedCamera()) out << kFix << ' ' << vertexOf(*graph.fixedCamera()) << "\n";
	const Vector6 scale = residualScale(rotation);
	for (const PoseEdge& edge : graph.edges())
	{
		if (edge.kind != usualKind(edge, graph.nodes()))
			out << "# semloop kind " << nameOf(edge.kind) << "\n";
		out << kEdge << ' ' << vertexOf(edge.a) << ' ' << vertexOf(edge.b);
		writeTransform(out, edge.Z_a_b);
		writeInformation(out, edge.information, scale);
		out << "\n";
	}
	out.close();
	if (!out) throw InputError(path + ": writing failed; is the disk full?");
}

}  // namespace semloop

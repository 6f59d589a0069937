#include "GraphInput.h"

#include <semloop/config/Error.h>
#include <semloop/object_map/ObjectFiles.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <filesystem>

namespace semloop
{
SemanticGraph readGraph(const std::string& path)
{
	if (std::filesystem::path(path).extension() == ".objmap")
		return SemanticGraph::fromMap(*loadObjectMap(path));
	return SemanticGraph::load(path);
}

mrpt::poses::CPose3D poseFromMatrix(const std::vector<double>& rowMajor, const std::string& what)
{
	constexpr double kTolerance = 1e-3;  // of numbers that were printed with few digits
	if (rowMajor.size() != 16)
		throw InputError(
			what + ": has " + std::to_string(rowMajor.size()) +
			" numbers; give the 16 of a 4x4 matrix, row by row");
	const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(rowMajor.data());
	const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
	if (!matrix.allFinite() ||
		(rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() > kTolerance ||
		rotation.determinant() < 0 ||
		(matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).norm() > kTolerance)
		throw InputError(
			what + ": is no rigid motion; give a rotation and a translation, last row 0 0 0 1");
	mrpt::math::CMatrixDouble44 pose;
	for (int row = 0; row < 4; ++row)
		for (int column = 0; column < 4; ++column) pose(row, column) = matrix(row, column);
	return mrpt::poses::CPose3D(pose);
}

std::vector<double> matrixFromPose(const mrpt::poses::CPose3D& pose)
{
	const auto matrix = pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>();
	std::vector<double> rowMajor;
	for (int row = 0; row < 4; ++row)
		for (int column = 0; column < 4; ++column) rowMajor.push_back(matrix(row, column));
	return rowMajor;
}

}  // namespace semloop

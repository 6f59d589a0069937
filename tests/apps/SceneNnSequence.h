#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "SyntheticScene.h"

/** A small sequence like SceneNN's: what a camera sees of boxes in a corner of a room, the trajectory, the
 *  mesh with labels, and the annotation. */
namespace semloop::test
{
using mrpt::obs::CObservation3DRangeScan;
using mrpt::poses::CPose3D;
using synthetic::Box;
using synthetic::View;

inline constexpr int kFrames = 8;
inline constexpr double kSpacing = 0.01;  // of the mesh's vertices [m]

// Ids of the shapes, and what the annotation calls them.
inline constexpr int kRoom = 0, kChair = 1, kTable = 2, kUnnamed = 3, kNotInMesh = 4;
inline constexpr uint32_t kChairLabel = 8844, kTableLabel = 17, kFloorLabel = 5, kUnnamedLabel = 6,
						  kWallLabel = 7;
inline constexpr const char* kAnnotation =
	"<?xml version=\"1.0\"?>\n<annotation>\n"
	"  <label id=\"8844\" text=\"chair\" color=\"255 0 0\" nyu_class=\"chair\"/>\n"
	"  <label id=\"17\" text=\" coffee table \" aabbox=\"0 0 0 1 1 1\"/>\n"
	"  <label id=\"5\" text=\"floor\"/>\n"
	"  <label id=\"6\" text=\"\"/>\n"
	"  <label id=\"7\" text=\"wall\"/>\n"
	"  <label id=\"99\" text=\"lamp\"/>\n"
	"</annotation>\n";

/** Two objects, one without a name and one that was put there after the reconstruction. */
inline std::vector<Box> boxes()
{
	return {
		{CPose3D(0, 0, 0.3, 0.3, 0, 0), {0.4, 0.4, 0.6}, {40, 40, 200}, kChair, 0.1},
		{CPose3D(0.1, 0.8, 0.2, 0, 0, 0), {0.8, 0.5, 0.4}, {40, 200, 40}, kTable, 0.1},
		{CPose3D(0.1, -0.8, 0.2, 0, 0, 0), {0.3, 0.3, 0.4}, {200, 40, 40}, kUnnamed, 0.1},
		{CPose3D(0.4, -0.3, 0.6, 0, 0, 0), {0.2, 0.2, 0.2}, {20, 200, 200}, kNotInMesh, 0.1}};
}

inline CPose3D cameraAt(int frame)
{
	return synthetic::lookAt({2.0, -0.7 + 0.2 * frame, 1.3}, {0, 0.05 * frame, 0.2});
}

inline View viewOf(int frame, const mrpt::img::TCamera& camera = synthetic::smallCamera())
{
	synthetic::Scene scene;
	scene.boxes = boxes();
	scene.planes.push_back({{0, 0, 1}, 0, {128, 128, 128}, kRoom, 0.2});
	scene.planes.push_back({{1, 0, 0}, -1.5, {160, 160, 160}, kRoom, 0.2});
	return renderView(scene, camera, cameraAt(frame));
}

/** What the camera delivers [mm]. */
inline uint16_t storedDepth(float metres)
{
	return cv::saturate_cast<uint16_t>(metres * 1000.0F);
}

inline CObservation3DRangeScan scanOf(const View& view, int frame)
{
	CObservation3DRangeScan scan;
	scan.timestamp = mrpt::Clock::fromDouble(1000 + frame / 30.0);
	scan.sensorLabel = "RGBD";
	scan.cameraParams = scan.cameraParamsIntensity = view.frame.camera;
	scan.range_is_depth = true;
	scan.rangeUnits = 0.001F;
	scan.hasRangeImage = scan.hasIntensityImage = true;
	scan.rangeImage.resize(view.frame.depth.rows, view.frame.depth.cols);
	for (int v = 0; v < view.frame.depth.rows; v++)
		for (int u = 0; u < view.frame.depth.cols; u++)
			scan.rangeImage(v, u) = storedDepth(view.frame.depth.at<float>(v, u));
	scan.intensityImage = mrpt::img::CImage(view.frame.color, mrpt::img::DEEP_COPY);
	return scan;
}

/** SceneNN's world has y up. */
inline mrpt::math::TPoint3D toSceneNn(const mrpt::math::TPoint3D& p)
{
	return {p.x, p.z, -p.y};
}

struct Vertex
{
	mrpt::math::TPoint3D p;
	uint32_t label = 0;
};

struct Mesh
{
	std::vector<Vertex> vertices;
	std::vector<std::array<uint32_t, 3>> triangles;

	/** A rectangle from a corner, along two edges. */
	void addRectangle(
		const CPose3D& pose, const mrpt::math::TPoint3D& corner, const mrpt::math::TVector3D& a,
		const mrpt::math::TVector3D& b, uint32_t label)
	{
		const int rows = int(std::ceil(a.norm() / kSpacing));
		const int columns = int(std::ceil(b.norm() / kSpacing));
		const auto first = uint32_t(vertices.size());
		const auto at = [&](int i, int j) { return first + uint32_t(i * (columns + 1) + j); };
		for (int i = 0; i <= rows; i++)
			for (int j = 0; j <= columns; j++)
			{
				const auto p = corner + a * (double(i) / rows) + b * (double(j) / columns);
				vertices.push_back({toSceneNn(pose.composePoint(p)), label});
				if (i == rows || j == columns) continue;
				triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
				triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
			}
	}

	void add(const Box& box, uint32_t label)
	{
		for (int axis = 0; axis < 3; axis++)
			for (const double side : {-0.5, 0.5})
			{
				const int right = (axis + 1) % 3, up = (axis + 2) % 3;
				mrpt::math::TPoint3D corner(0, 0, 0);
				mrpt::math::TVector3D a(0, 0, 0), b(0, 0, 0);
				corner[axis] = side * box.size[axis];
				corner[right] = -0.5 * box.size[right];
				corner[up] = -0.5 * box.size[up];
				a[right] = box.size[right];
				b[up] = box.size[up];
				addRectangle(box.T_world_box, corner, a, b, label);
			}
	}

	/** Binary, with properties round the one that counts. */
	std::string ply(bool withLabels = true) const
	{
		std::ostringstream out;
		out << "ply\nformat binary_little_endian 1.0\nelement vertex " << vertices.size()
			<< "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
			<< (withLabels ? "property uint label\n" : "property uint segment\n")
			<< "property float nx\nelement face " << triangles.size()
			<< "\nproperty list uchar int vertex_indices\nend_header\n";
		const auto append = [&](auto value)
		{ out.write(reinterpret_cast<const char*>(&value), sizeof(value)); };
		for (const auto& vertex : vertices)
		{
			for (int axis = 0; axis < 3; axis++) append(float(vertex.p[axis]));
			append(uint8_t(200));
			append(vertex.label);
			append(0.5F);
		}
		for (const auto& triangle : triangles)
		{
			append(uint8_t(3));
			for (const uint32_t corner : triangle) append(int32_t(corner));
		}
		return out.str();
	}
};

inline Mesh sceneMesh()
{
	Mesh mesh;
	mesh.addRectangle({}, {-4, -4, 0}, {0.001, 0, 0}, {0.001, 0, 0}, 0);  // noise of no label
	mesh.addRectangle({}, {-1.5, -3, 0}, {3, 0, 0}, {0, 6, 0}, kFloorLabel);
	mesh.addRectangle({}, {-1.5, -3, 0}, {0, 6, 0}, {0, 0, 1.4}, kWallLabel);
	mesh.add(boxes()[0], kChairLabel);
	mesh.add(boxes()[1], kTableLabel);
	mesh.add(boxes()[2], kUnnamedLabel);
	return mesh;
}

/** A block of a trajectory.log. */
inline std::string block(int frame, const CPose3D& T_world_camera)
{
	std::ostringstream out;
	out.precision(7);
	out << frame << " " << frame << " " << frame + 1 << "\n";
	// The columns are the camera's axes in the world, and its place.
	std::array<mrpt::math::TPoint3D, 4> columns;
	for (int i = 0; i < 3; i++)
	{
		mrpt::math::TVector3D axis(0, 0, 0);
		axis[i] = 1;
		const auto turned = T_world_camera.rotateVector(axis);
		columns[i] = toSceneNn({turned.x, turned.y, turned.z});
	}
	columns[3] = toSceneNn(mrpt::math::TPoint3D(T_world_camera.translation()));
	for (int row = 0; row < 3; row++)
	{
		for (const auto& column : columns) out << column[row] << " ";
		out << "\n";
	}
	out << "0.000000 0.000000 0.000000 1.000000\n";
	return out.str();
}

inline std::string lostBlock(int frame)
{
	std::ostringstream out;
	out << frame << " " << frame << " " << frame + 1 << "\n0 0 0 0.03\n0 0 0 3.1\n0 0 0 -1.4\n"
		<< "0.000000 0.000000 0.000000 1.000000\n";
	return out.str();
}

inline std::string trajectoryLog(int frames = kFrames)
{
	std::string text;
	for (int i = 0; i < frames; i++) text += block(i, cameraAt(i));
	return text;
}
}  // namespace semloop::test

#pragma once

#include <mrpt/img/TCamera.h>
#include <mrpt/math/TPoint3D.h>
#include <mrpt/poses/CPose3D.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/InstanceMask.h>
#include <semloop/observations/RgbdFrame.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

/** RGB-D frames and masks of analytic shapes, for tests: exact depth of every pixel, no noise.
 *
 *  The world is MRPT's (z up). Camera poses are of the optical frame (x right, y down, z forward):
 *
 *      Scene scene;
 *      scene.boxes.push_back(tableAt(0.7));                                  // background
 *      scene.spheres.push_back({{0, 0, 0.8}, 0.1, {0, 0, 255}, 1});          // object 1
 *      const View view = renderView(scene, vgaCamera(), lookAt({1.5, 0, 1.3}, {0, 0, 0.8}));
 *      // view.frame: RgbdFrame, view.masks[1]: InstanceMask of object 1 */
namespace semloop::synthetic
{
using mrpt::math::TPoint3D;
using mrpt::math::TVector3D;
using mrpt::poses::CPose3D;

/** Ids of objects are 1, 2, ...; 0 is background (seen, but without a mask). Shapes of one id are
 *  one object. textureCell > 0 makes a random brightness per cube of that size [m]. */
struct Sphere
{
	TPoint3D centre;                    //!< [m]
	double radius = 0.1;                //!< [m]
	cv::Vec3b color = {128, 128, 128};  //!< BGR
	int id = 0;
	double textureCell = 0;
};

struct Box
{
	CPose3D T_world_box;  //!< centre of the box
	TVector3D size;       //!< edge lengths [m]
	cv::Vec3b color = {128, 128, 128};
	int id = 0;
	double textureCell = 0;
};

/** n . p = offset, seen from both sides. */
struct Plane
{
	TVector3D normal = {0, 0, 1};
	double offset = 0;  //!< [m]
	cv::Vec3b color = {128, 128, 128};
	int id = 0;
	double textureCell = 0;
};

struct Scene
{
	std::vector<Sphere> spheres;
	std::vector<Box> boxes;
	std::vector<Plane> planes;
};

struct View
{
	RgbdFrame frame;  //!< T_robot_camera: the robot sits in the camera, x forward, z up
	cv::Mat ids;      //!< CV_32SC1: id per pixel, -1 where nothing is hit
	std::vector<InstanceMask> masks;  //!< [id]; [0] is the background; empty masks where unseen
};

inline mrpt::img::TCamera makeCamera(int width, int height, double focalLength)
{
	mrpt::img::TCamera camera;
	camera.ncols = width;
	camera.nrows = height;
	camera.setIntrinsicParamsFromValues(
		focalLength, focalLength, 0.5 * (width - 1), 0.5 * (height - 1));
	return camera;
}

inline mrpt::img::TCamera vgaCamera()
{
	return makeCamera(640, 480, 525);
}
inline mrpt::img::TCamera smallCamera()
{
	return makeCamera(160, 120, 131.25);
}

/** T_world_camera (optical) of a camera at eye whose axis goes through target, upright. */
inline CPose3D lookAt(const TPoint3D& eye, const TPoint3D& target)
{
	const TVector3D z = (target - eye).unitarize();
	// The image's right side; any horizontal direction will do when looking straight up or down.
	const TVector3D up = std::abs(z.z) < 0.999 ? TVector3D(0, 0, 1) : TVector3D(1, 0, 0);
	const TVector3D x =
		TVector3D(z.y * up.z - z.z * up.y, z.z * up.x - z.x * up.z, z.x * up.y - z.y * up.x)
			.unitarize();
	const TVector3D y(z.y * x.z - z.z * x.y, z.z * x.x - z.x * x.z, z.x * x.y - z.y * x.x);
	mrpt::math::CMatrixDouble33 rotation;
	for (int row = 0; row < 3; ++row)
	{
		rotation(row, 0) = x[row];
		rotation(row, 1) = y[row];
		rotation(row, 2) = z[row];
	}
	return CPose3D(rotation, mrpt::math::CMatrixDouble31(TVector3D(eye.x, eye.y, eye.z)));
}

/** A table of 1.6 x 1.6 x 0.04 m round the z axis whose top is at this height. */
inline Box tableAt(double top)
{
	return {CPose3D(0, 0, top - 0.02, 0, 0, 0), {1.6, 1.6, 0.04}, {60, 90, 120}, 0, 0};
}

/** Smallest t > 0 with origin + t direction on the shape; infinity when there is none. */
inline double intersect(const Sphere& sphere, const TPoint3D& origin, const TVector3D& direction)
{
	const TVector3D m = origin - sphere.centre;
	const auto dot = [](const TVector3D& a, const TVector3D& b)
	{ return a.x * b.x + a.y * b.y + a.z * b.z; };
	const double a = dot(direction, direction), b = dot(m, direction);
	const double discriminant = b * b - a * (dot(m, m) - sphere.radius * sphere.radius);
	if (discriminant < 0) return std::numeric_limits<double>::infinity();
	const double root = std::sqrt(discriminant);
	for (const double t : {(-b - root) / a, (-b + root) / a})
		if (t > 0) return t;
	return std::numeric_limits<double>::infinity();
}

inline double intersect(const Box& box, const TPoint3D& origin, const TVector3D& direction)
{
	const auto& R = box.T_world_box.getRotationMatrix();
	const TVector3D m = origin - box.T_world_box.translation();
	TVector3D o, slope;  // the ray along the box's axes
	for (int axis = 0; axis < 3; ++axis)
	{
		o[axis] = R(0, axis) * m.x + R(1, axis) * m.y + R(2, axis) * m.z;
		slope[axis] =
			R(0, axis) * direction.x + R(1, axis) * direction.y + R(2, axis) * direction.z;
	}
	double enter = -std::numeric_limits<double>::infinity(), leave = -enter;
	for (int axis = 0; axis < 3; ++axis)
	{
		const double half = 0.5 * box.size[axis], d = slope[axis];
		if (d == 0)
		{
			if (std::abs(o[axis]) > half) return std::numeric_limits<double>::infinity();
			continue;
		}
		const double t1 = (-half - o[axis]) / d, t2 = (half - o[axis]) / d;
		enter = std::max(enter, std::min(t1, t2));
		leave = std::min(leave, std::max(t1, t2));
	}
	if (enter > leave || leave <= 0) return std::numeric_limits<double>::infinity();
	return enter > 0 ? enter : leave;
}

inline double intersect(const Plane& plane, const TPoint3D& origin, const TVector3D& direction)
{
	const auto dot = [&](const TVector3D& v)
	{ return plane.normal.x * v.x + plane.normal.y * v.y + plane.normal.z * v.z; };
	const double towards = dot(direction);
	if (towards == 0) return std::numeric_limits<double>::infinity();
	const double t = (plane.offset - dot(TVector3D(origin.x, origin.y, origin.z))) / towards;
	return t > 0 ? t : std::numeric_limits<double>::infinity();
}

/** The colour at a point of a surface: the same from every view. */
inline cv::Vec3b texture(const cv::Vec3b& color, double cell, const TPoint3D& p)
{
	if (cell <= 0) return color;
	uint32_t hash = 2166136261u;
	for (int axis = 0; axis < 3; ++axis)
		hash = (hash ^ uint32_t(int32_t(std::floor(p[axis] / cell)))) * 16777619u;
	hash ^= hash >> 15;
	hash *= 2246822519u;
	const double brightness = 0.4 + 0.9 * double((hash >> 8) & 0xff) / 255.0;
	return {
		cv::saturate_cast<uint8_t>(color[0] * brightness),
		cv::saturate_cast<uint8_t>(color[1] * brightness),
		cv::saturate_cast<uint8_t>(color[2] * brightness)};
}

/** Casts one ray per pixel centre. Depth is along the optical axis. */
inline View renderView(
	const Scene& scene, const mrpt::img::TCamera& camera, const CPose3D& T_world_camera)
{
	const int width = int(camera.ncols), height = int(camera.nrows);
	View view;
	view.frame.camera = camera;
	view.frame.color = cv::Mat(height, width, CV_8UC3, cv::Scalar::all(0));
	view.frame.depth = cv::Mat(height, width, CV_32FC1, cv::Scalar::all(0));
	view.frame.T_robot_camera = CPose3D::FromYawPitchRoll(-M_PI / 2, 0, -M_PI / 2);
	view.ids = cv::Mat(height, width, CV_32SC1, cv::Scalar::all(-1));
	const TPoint3D origin = T_world_camera.translation();
	int maxId = 0;
	for (int v = 0; v < height; ++v)
		for (int u = 0; u < width; ++u)
		{
			// z = 1 along the axis, so that the ray's parameter is the depth.
			const TVector3D direction = T_world_camera.rotateVector(
				TVector3D((u - camera.cx()) / camera.fx(), (v - camera.cy()) / camera.fy(), 1));
			double depth = std::numeric_limits<double>::infinity();
			const auto cast = [&](const auto& shapes)
			{
				for (const auto& shape : shapes)
				{
					const double t = intersect(shape, origin, direction);
					if (!(t < depth)) continue;
					depth = t;
					view.ids.at<int>(v, u) = shape.id;
					view.frame.color.at<cv::Vec3b>(v, u) =
						texture(shape.color, shape.textureCell, origin + direction * t);
				}
			};
			cast(scene.spheres);
			cast(scene.boxes);
			cast(scene.planes);
			if (std::isfinite(depth)) view.frame.depth.at<float>(v, u) = float(depth);
		}
	for (const auto& s : scene.spheres) maxId = std::max(maxId, s.id);
	for (const auto& s : scene.boxes) maxId = std::max(maxId, s.id);
	for (const auto& s : scene.planes) maxId = std::max(maxId, s.id);
	for (int id = 0; id <= maxId; ++id) view.masks.push_back(InstanceMask::encode(view.ids == id));
	return view;
}

inline RgbdFrame renderFrame(
	const Scene& scene, const mrpt::img::TCamera& camera, const CPose3D& T_world_camera)
{
	return renderView(scene, camera, T_world_camera).frame;
}

/** A detection with this mask; certain of its label unless told otherwise. */
inline Instance makeInstance(
	const InstanceMask& mask, uint32_t label, float score = 1.0f, std::vector<float> embedding = {})
{
	Instance instance;
	instance.box = mask.boundingBox();
	instance.mask = mask;
	instance.labelScores = {{label, score}};
	instance.confidence = score;
	instance.embedding = std::move(embedding);
	return instance;
}

/** Zero-mean Gaussian noise on the valid depth, growing with its square: sigma at one metre [m]. */
inline void addDepthNoise(RgbdFrame& frame, double sigmaAtOneMetre, unsigned seed)
{
	std::mt19937 generator(seed);
	std::normal_distribution<double> normal;
	for (int v = 0; v < frame.depth.rows; ++v)
		for (int u = 0; u < frame.depth.cols; ++u)
		{
			float& z = frame.depth.at<float>(v, u);
			if (z > 0) z += float(sigmaAtOneMetre * z * z * normal(generator));
		}
}

}  // namespace semloop::synthetic

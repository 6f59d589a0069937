#pragma once

#include <semloop/object_map/TsdfVolume.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace semloop::testing
{
/** Ray parameter t > 0 of the first point origin + t direction on a shape. */
using Shape =
	std::function<std::optional<double>(const Eigen::Vector3d& origin, const Eigen::Vector3d& dir)>;

inline Shape sphere(double radius, const Eigen::Vector3d& centre = Eigen::Vector3d::Zero())
{
	return [=](const Eigen::Vector3d& origin, const Eigen::Vector3d& dir) -> std::optional<double>
	{
		const Eigen::Vector3d o = origin - centre;
		const double a = dir.squaredNorm(), b = o.dot(dir), c = o.squaredNorm() - radius * radius;
		const double root = b * b - a * c;
		if (root < 0) return std::nullopt;
		const double t = (-b - std::sqrt(root)) / a;
		return t > 0 ? std::optional(t) : std::nullopt;
	};
}

inline Shape box(const Eigen::Vector3d& low, const Eigen::Vector3d& high)
{
	return [=](const Eigen::Vector3d& origin, const Eigen::Vector3d& dir) -> std::optional<double>
	{
		double enter = 0, leave = 1e9;
		for (int i = 0; i < 3; ++i)
		{
			const double a = (low[i] - origin[i]) / dir[i], b = (high[i] - origin[i]) / dir[i];
			enter = std::max(enter, std::min(a, b));
			leave = std::min(leave, std::max(a, b));
		}
		return enter > 0 && enter < leave ? std::optional(enter) : std::nullopt;
	};
}

inline mrpt::img::TCamera kinect()
{
	mrpt::img::TCamera camera;
	camera.ncols = 640;
	camera.nrows = 480;
	camera.setIntrinsicParamsFromValues(525, 525, 319.5, 239.5);
	return camera;
}

/** T_object_camera of a camera at eye that looks at target, with its image upright along z. */
inline mrpt::poses::CPose3D lookAt(
	const Eigen::Vector3d& eye, const Eigen::Vector3d& target = Eigen::Vector3d::Zero())
{
	const Eigen::Vector3d forward = (target - eye).normalized();
	const Eigen::Vector3d up =
		std::abs(forward.z()) > 0.95 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
	const Eigen::Vector3d right = forward.cross(up).normalized();
	mrpt::math::CMatrixDouble44 T;
	T.setIdentity();
	T.asEigen().block<3, 1>(0, 0) = right;
	T.asEigen().block<3, 1>(0, 1) = forward.cross(right);
	T.asEigen().block<3, 1>(0, 2) = forward;
	T.asEigen().block<3, 1>(0, 3) = eye;
	return mrpt::poses::CPose3D(T);
}

struct View
{
	RgbdFrame frame;
	InstanceMask mask;  //!< the first shape's visible pixels
};

/** Depth of the shapes, each in its grey (BGR 40 i + 100), and the mask of the first one. */
inline View render(const std::vector<Shape>& shapes, const mrpt::poses::CPose3D& T_object_camera)
{
	View view;
	view.frame.camera = kinect();
	view.frame.depth = cv::Mat(480, 640, CV_32FC1, cv::Scalar(0));
	view.frame.color = cv::Mat(480, 640, CV_8UC3, cv::Scalar(0, 0, 0));
	cv::Mat mask(480, 640, CV_8UC1, cv::Scalar(0));
	const Eigen::Matrix3d R = T_object_camera.getRotationMatrix().asEigen();
	const Eigen::Vector3d eye(T_object_camera.x(), T_object_camera.y(), T_object_camera.z());
	for (int v = 0; v < 480; ++v)
		for (int u = 0; u < 640; ++u)
		{
			const Eigen::Vector3d dir =
				R * Eigen::Vector3d((u - 319.5) / 525, (v - 239.5) / 525, 1);
			double nearest = 1e9;
			for (std::size_t i = 0; i < shapes.size(); ++i)
			{
				const auto t = shapes[i](eye, dir);
				if (!t || *t >= nearest) continue;
				nearest = *t;
				view.frame.depth.at<float>(v, u) = static_cast<float>(*t);
				const auto grey = static_cast<uint8_t>(100 + 40 * i);
				view.frame.color.at<cv::Vec3b>(v, u) = {grey, grey, grey};
				mask.at<uint8_t>(v, u) = i == 0 ? 255 : 0;
			}
		}
	view.mask = InstanceMask::encode(mask);
	return view;
}

inline void fuse(
	TsdfVolume& volume, const std::vector<Shape>& shapes,
	const mrpt::poses::CPose3D& T_object_camera)
{
	const View view = render(shapes, T_object_camera);
	volume.integrate(view.frame, view.mask, T_object_camera);
}

/** The six axes and eight diagonals, seen from so far. */
inline std::vector<mrpt::poses::CPose3D> posesAllAround(double distance)
{
	std::vector<mrpt::poses::CPose3D> poses;
	for (int x = -1; x <= 1; ++x)
		for (int y = -1; y <= 1; ++y)
			for (int z = -1; z <= 1; ++z)
			{
				const int n = std::abs(x) + std::abs(y) + std::abs(z);
				if (n == 1 || n == 3)
					poses.push_back(lookAt(distance * Eigen::Vector3d(x, y, z).normalized()));
			}
	return poses;
}

inline TsdfOptions options(double voxelSize)
{
	TsdfOptions o;
	o.voxelSize = voxelSize;
	o.truncation = 4 * voxelSize;
	return o;
}

}  // namespace semloop::testing

#include <semloop/config/Error.h>
#include <semloop/simulation/SceneRenderer.h>

#include <algorithm>
#include <cmath>

#include "Shading.h"

namespace semloop
{
namespace
{
// A packet's pixels: neighbours, so that its rays stay together.
constexpr int kTileWidth = 4, kTileHeight = 4;
constexpr int kHiddenStep = 4;

/** The rays of a pinhole camera in the world, direction with unit length along the optical axis: tfar
 *  then is the depth. */
struct CameraRays
{
	CameraRays(const mrpt::img::TCamera& camera, const mrpt::poses::CPose3D& T_world_camera)
		: width(int(camera.ncols)),
		  height(int(camera.nrows)),
		  fx(float(camera.fx())),
		  fy(float(camera.fy())),
		  cx(float(camera.cx())),
		  cy(float(camera.cy()))
	{
		const auto T = T_world_camera.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>();
		rotation = T.asEigen().topLeftCorner<3, 3>().cast<float>();
		origin = T.asEigen().topRightCorner<3, 1>().cast<float>();
	}

	Eigen::Vector3f direction(int x, int y) const
	{
		return rotation * Eigen::Vector3f((float(x) - cx) / fx, (float(y) - cy) / fy, 1.0F);
	}
	/** Pixels that a point set may cover: the whole image when it reaches behind the camera. */
	cv::Rect projectedBox(const std::vector<Eigen::Vector3f>& points) const;

	int width, height;
	float fx, fy, cx, cy;
	Eigen::Matrix3f rotation;
	Eigen::Vector3f origin;
};

cv::Rect CameraRays::projectedBox(const std::vector<Eigen::Vector3f>& points) const
{
	const cv::Rect image(0, 0, width, height);
	Eigen::Vector3f low = points.front(), high = points.front();
	for (const auto& point : points)
	{
		low = low.cwiseMin(point);
		high = high.cwiseMax(point);
	}
	Eigen::Vector2f least(1e9F, 1e9F), most(-1e9F, -1e9F);
	int behind = 0;
	for (int corner = 0; corner < 8; ++corner)
	{
		const Eigen::Vector3f p_world(
			corner & 1 ? high.x() : low.x(), corner & 2 ? high.y() : low.y(),
			corner & 4 ? high.z() : low.z());
		const Eigen::Vector3f p = rotation.transpose() * (p_world - origin);
		if (p.z() < 0.05F)
		{
			++behind;
			continue;
		}
		const Eigen::Vector2f pixel(fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy);
		least = least.cwiseMin(pixel);
		most = most.cwiseMax(pixel);
	}
	if (behind == 8) return {};
	if (behind > 0) return image;
	// Beyond the image by how much does not matter, and would overflow an int.
	least = least.cwiseMax(-1.0F).cwiseMin(float(width + height));
	most = most.cwiseMax(-1.0F).cwiseMin(float(width + height));
	return cv::Rect(
			   cv::Point(int(least.x()), int(least.y())),
			   cv::Point(int(most.x()) + 2, int(most.y()) + 2)) &
		   image;
}

/** Casts up to kPacket of the camera's rays; false where nothing is hit. */
struct Packet
{
	alignas(64) std::array<int, kPacket> valid{};
	RTCRayHit16 rays;
	std::array<cv::Point, kPacket> pixels;
	unsigned size = 0;

	void add(const CameraRays& camera, int x, int y)
	{
		setRay(rays.ray, size, camera.origin, camera.direction(x, y));
		rays.ray.tnear[size] = 0.01F;
		rays.ray.tfar[size] = 1e9F;
		rays.hit.geomID[size] = RTC_INVALID_GEOMETRY_ID;
		rays.hit.instID[0][size] = RTC_INVALID_GEOMETRY_ID;
		pixels[size] = {x, y};
		valid[size++] = -1;
	}
	void cast(RTCScene scene)
	{
		RTCIntersectContext context;
		rtcInitIntersectContext(&context);
		context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
		rtcIntersect16(valid.data(), scene, &context, &rays);
	}
	bool hit(unsigned i) const { return rays.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID; }
	Eigen::Vector3f direction(unsigned i) const
	{
		return {rays.ray.dir_x[i], rays.ray.dir_y[i], rays.ray.dir_z[i]};
	}
	/** Not of unit length, to either side. */
	Eigen::Vector3f normal(unsigned i) const
	{
		return {rays.hit.Ng_x[i], rays.hit.Ng_y[i], rays.hit.Ng_z[i]};
	}
	/** Of the angle between ray and normal. */
	float cosine(unsigned i) const
	{
		const Eigen::Vector3f d = direction(i), n = normal(i);
		return std::min(1.0F, std::abs(n.dot(d)) / std::sqrt(n.squaredNorm() * d.squaredNorm()));
	}
};

Hit hitOf(const Packet& packet, unsigned i)
{
	const auto& ray = packet.rays.ray;
	const auto& found = packet.rays.hit;
	Hit hit;
	hit.object = found.geomID[i];
	hit.triangle = found.primID[i];
	hit.u = found.u[i];
	hit.v = found.v[i];
	const Eigen::Vector3f direction = packet.direction(i);
	hit.point = Eigen::Vector3f(ray.org_x[i], ray.org_y[i], ray.org_z[i]) + ray.tfar[i] * direction;
	hit.normal = packet.normal(i).normalized();
	if (hit.normal.dot(direction) > 0) hit.normal = -hit.normal;
	hit.x = packet.pixels[i].x;
	hit.y = packet.pixels[i].y;
	return hit;
}

void requirePinhole(const mrpt::img::TCamera& camera)
{
	for (const double coefficient : camera.dist)
		if (coefficient != 0)
			throw InputError(
				"camera '" + camera.cameraName +
				"': the simulation knows no lens distortion; set dist to zeros");
}
}  // namespace

struct SceneRenderer::Impl
{
	explicit Impl(const Scene& scene) : geometry(scene), shading(scene, geometry) {}
	void renderTile(
		const CameraRays& camera, cv::Point corner, RenderedView& view, std::vector<Hit>& hits,
		std::vector<cv::Vec3f>& colors) const;

	EmbreeScene geometry;
	Shading shading;
};

void SceneRenderer::Impl::renderTile(
	const CameraRays& camera, cv::Point corner, RenderedView& view, std::vector<Hit>& hits,
	std::vector<cv::Vec3f>& colors) const
{
	Packet packet;
	for (int y = corner.y; y < std::min(corner.y + kTileHeight, camera.height); ++y)
		for (int x = corner.x; x < std::min(corner.x + kTileWidth, camera.width); ++x)
			packet.add(camera, x, y);
	packet.cast(geometry.all());

	hits.clear();
	for (unsigned i = 0; i < packet.size; ++i)
	{
		if (!packet.hit(i)) continue;
		const auto& [x, y] = packet.pixels[i];
		view.depth.ptr<float>(y)[x] = packet.rays.ray.tfar[i];
		view.cosine.ptr<float>(y)[x] = packet.cosine(i);
		view.object.ptr<uint16_t>(y)[x] = uint16_t(packet.rays.hit.geomID[i]);
		if (!view.color.empty()) hits.push_back(hitOf(packet, i));
	}
	if (hits.empty()) return;
	shading.shade(hits, colors);
	for (std::size_t i = 0; i < hits.size(); ++i)
		view.color.ptr<cv::Vec3f>(hits[i].y)[hits[i].x] = colors[i];
}

SceneRenderer::SceneRenderer(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
SceneRenderer::~SceneRenderer() = default;

RenderedView SceneRenderer::render(
	const mrpt::img::TCamera& camera, const mrpt::poses::CPose3D& T_world_camera, bool color) const
{
	requirePinhole(camera);
	const CameraRays rays(camera, T_world_camera);
	const cv::Size size(rays.width, rays.height);
	RenderedView view;
	view.camera = camera;
	view.T_world_camera = T_world_camera;
	view.depth = cv::Mat::zeros(size, CV_32FC1);
	view.cosine = cv::Mat::zeros(size, CV_32FC1);
	view.object = cv::Mat::zeros(size, CV_16UC1);
	if (color) view.color = cv::Mat::zeros(size, CV_32FC3);

	std::vector<Hit> hits;
	std::vector<cv::Vec3f> colors;
	for (int y = 0; y < size.height; y += kTileHeight)
		for (int x = 0; x < size.width; x += kTileWidth)
			impl_->renderTile(rays, {x, y}, view, hits, colors);
	return view;
}

std::vector<float> SceneRenderer::hiddenShares(const RenderedView& view) const
{
	const CameraRays camera(view.camera, view.T_world_camera);
	const auto& geometry = impl_->geometry;
	std::vector<float> hidden(geometry.size(), 0.0F);
	for (uint32_t object = 1; object < geometry.size(); ++object)
	{
		const cv::Rect box = camera.projectedBox(geometry.corners(object));
		int covered = 0, seen = 0;
		Packet packet;
		const auto count = [&]
		{
			if (packet.size == 0) return;
			packet.cast(geometry.only(object));
			for (unsigned i = 0; i < packet.size; ++i)
			{
				if (!packet.hit(i)) continue;
				++covered;
				seen += view.object.at<uint16_t>(packet.pixels[i]) == object;
			}
			packet = Packet();
		};
		for (int y = box.y; y < box.y + box.height; y += kHiddenStep)
			for (int x = box.x; x < box.x + box.width; x += kHiddenStep)
			{
				packet.add(camera, x, y);
				if (packet.size == kPacket) count();
			}
		count();
		if (covered > 0) hidden[object] = 1.0F - float(seen) / float(covered);
	}
	return hidden;
}

}  // namespace semloop

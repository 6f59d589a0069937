#include <semloop/config/Error.h>
#include <semloop/observations/Rectifier.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace semloop
{
namespace
{
using mrpt::img::DistortionModel;
using mrpt::img::TCamera;

constexpr uint32_t kLargestSide = 32767;  // the maps are of 16 bits, as OpenCV's are
constexpr int kBlock = 16;  // pixels; a finer grid finds tighter regions and costs more to search
const cv::Vec4i kNothing{INT_MAX, INT_MAX, INT_MIN, INT_MIN};  // left, top, right, bottom

cv::Size sizeOf(const TCamera& camera)
{
	return {int(camera.ncols), int(camera.nrows)};
}

cv::Matx33d matrixOf(const TCamera& camera)
{
	return {camera.fx(), 0, camera.cx(), 0, camera.fy(), camera.cy(), 0, 0, 1};
}

TCamera pinhole(TCamera camera)
{
	camera.distortion = DistortionModel::none;
	camera.dist.fill(0);
	return camera;
}

/** For each pixel of the pinhole camera, where it is in the distorted image. */
void computeMaps(const TCamera& camera, int type, cv::Mat& map1, cv::Mat& map2)
{
	const cv::Matx33d K = matrixOf(camera);
	const cv::Matx33d noTurn = cv::Matx33d::eye();
	if (camera.distortion == DistortionModel::kannala_brandt)
	{
		const cv::Vec4d d(camera.k1(), camera.k2(), camera.k3(), camera.k4());
		cv::fisheye::initUndistortRectifyMap(K, d, noTurn, K, sizeOf(camera), type, map1, map2);
		return;
	}
	const cv::Mat d(1, 8, CV_64F, const_cast<double*>(camera.dist.data()));
	cv::initUndistortRectifyMap(K, d, noTurn, K, sizeOf(camera), type, map1, map2);
}

/** Rounds the maps; (-1, -1) outside the source image. */
cv::Mat nearestSource(const cv::Mat& x, const cv::Mat& y)
{
	cv::Mat nearest(x.size(), CV_16SC2, cv::Scalar(-1, -1));
	const auto width = float(x.cols), height = float(x.rows);
	for (int v = 0; v < x.rows; v++)
		for (int u = 0; u < x.cols; u++)
		{
			const float sx = std::floor(x.at<float>(v, u) + 0.5f);
			const float sy = std::floor(y.at<float>(v, u) + 0.5f);
			if (sx >= 0 && sy >= 0 && sx < width && sy < height)
				nearest.at<cv::Vec2s>(v, u) = {short(sx), short(sy)};
		}
	return nearest;
}

/** The box of all rectified pixels that come from a block of source pixels, block by block. */
cv::Mat regionsOfBlocks(const cv::Mat& nearest)
{
	const auto blocks = [](int pixels) { return (pixels + kBlock - 1) / kBlock; };
	cv::Mat regions(
		blocks(nearest.rows), blocks(nearest.cols), CV_32SC4,
		cv::Scalar(kNothing[0], kNothing[1], kNothing[2], kNothing[3]));
	for (int v = 0; v < nearest.rows; v++)
		for (int u = 0; u < nearest.cols; u++)
		{
			const auto source = nearest.at<cv::Vec2s>(v, u);
			if (source[0] < 0) continue;
			auto& r = regions.at<cv::Vec4i>(source[1] / kBlock, source[0] / kBlock);
			r = {
				std::min(r[0], u), std::min(r[1], v), std::max(r[2], u + 1), std::max(r[3], v + 1)};
		}
	return regions;
}

/** Rectified pixel by rectified pixel of a region: copies the value of the source pixel, where that
 *  lies in the source box; 0 elsewhere. */
template <typename T>
cv::Mat warp(
	const cv::Mat& source, const cv::Rect& sourceBox, const cv::Mat& nearest,
	const cv::Rect& region)
{
	cv::Mat out(region.size(), source.type(), cv::Scalar(0));
	for (int v = 0; v < region.height; v++)
	{
		const auto* const from = nearest.ptr<cv::Vec2s>(region.y + v) + region.x;
		T* const to = out.ptr<T>(v);
		for (int u = 0; u < region.width; u++)
		{
			const int x = from[u][0] - sourceBox.x, y = from[u][1] - sourceBox.y;
			const bool inside = unsigned(x) < unsigned(sourceBox.width) &&
								unsigned(y) < unsigned(sourceBox.height) && from[u][0] >= 0;
			if (inside) to[u] = source.ptr<T>(y)[x];
		}
	}
	return out;
}

bool anyFrom(const cv::Rect& sourceBox, const cv::Mat& nearest, const cv::Rect& region)
{
	for (int v = region.y; v < region.br().y; v++)
		for (int u = region.x; u < region.br().x; u++)
		{
			const auto source = nearest.at<cv::Vec2s>(v, u);
			if (sourceBox.contains({source[0], source[1]})) return true;
		}
	return false;
}

/** Cuts from a region the outer rows and columns without a pixel that comes from the source box. */
cv::Rect shrinkTo(const cv::Rect& sourceBox, const cv::Mat& nearest, cv::Rect r)
{
	const auto hit = [&](int x, int y, int width, int height) {
		return anyFrom(sourceBox, nearest, {x, y, width, height});
	};
	for (; r.height > 0 && !hit(r.x, r.y, r.width, 1); r.height--) r.y++;
	while (r.height > 0 && !hit(r.x, r.br().y - 1, r.width, 1)) r.height--;
	if (r.height == 0) return {};
	for (; !hit(r.x, r.y, 1, r.height); r.width--) r.x++;
	while (!hit(r.br().x - 1, r.y, 1, r.height)) r.width--;
	return r;
}

}  // namespace

bool hasDistortion(const TCamera& camera)
{
	return camera.distortion != DistortionModel::none &&
		   std::any_of(camera.dist.begin(), camera.dist.end(), [](double k) { return k != 0; });
}

void Rectifier::prepare(const TCamera& camera)
{
	if (!nearest_.empty() && camera == camera_) return;
	if (std::max(camera.ncols, camera.nrows) > kLargestSide)
		throw InputError("images of more than 32767 pixels a side cannot be rectified");
	cv::Mat x, y;
	computeMaps(camera, CV_32FC1, x, y);
	cv::convertMaps(x, y, map1_, map2_, CV_16SC2);
	nearest_ = nearestSource(x, y);
	regions_ = regionsOfBlocks(nearest_);
	camera_ = camera;
}

RgbdFrame Rectifier::rectify(const RgbdFrame& frame)
{
	const cv::Size size = sizeOf(frame.camera);
	if (frame.color.size() != size || frame.depth.size() != size)
		throw InputError("images to rectify are not of the camera's size");
	if (!hasDistortion(frame.camera)) return frame;

	prepare(frame.camera);
	RgbdFrame out;
	out.time = frame.time;
	out.camera = pinhole(frame.camera);
	out.T_robot_camera = frame.T_robot_camera;
	cv::remap(frame.color, out.color, map1_, map2_, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
	const cv::Rect all({0, 0}, size);
	out.depth = warp<float>(frame.depth, all, nearest_, all);
	return out;
}

cv::Rect Rectifier::rectifiedRegion(const cv::Rect& region) const
{
	cv::Vec4i all = kNothing;
	if (region.empty()) return {};
	for (int v = region.y / kBlock; v <= (region.br().y - 1) / kBlock; v++)
		for (int u = region.x / kBlock; u <= (region.br().x - 1) / kBlock; u++)
		{
			const auto& r = regions_.at<cv::Vec4i>(v, u);
			all = {
				std::min(all[0], r[0]), std::min(all[1], r[1]), std::max(all[2], r[2]),
				std::max(all[3], r[3])};
		}
	return all[2] > all[0] ? cv::Rect({all[0], all[1]}, cv::Point(all[2], all[3])) : cv::Rect();
}

std::optional<Instance> Rectifier::rectify(const Instance& instance) const
{
	const cv::Rect maskBox = instance.mask.boundingBox();
	const cv::Rect maskRegion = rectifiedRegion(maskBox);
	Instance out;
	out.mask = InstanceMask::encode(
		warp<uint8_t>(instance.mask.decode(maskBox), maskBox, nearest_, maskRegion),
		maskRegion.tl(), nearest_.size());

	out.box = shrinkTo(instance.box, nearest_, rectifiedRegion(instance.box));
	if (out.mask.empty() || out.box.empty()) return std::nullopt;

	out.labelScores = instance.labelScores;
	out.confidence = instance.confidence;
	out.embedding = instance.embedding;
	out.trueObject = instance.trueObject;
	if (instance.depth)
		out.depth = DepthCrop{
			warp<uint16_t>(instance.depth->depth, instance.box, nearest_, out.box),
			instance.depth->unit};
	return out;
}

CObservationInstances::Ptr Rectifier::rectify(const CObservationInstances& observation)
{
	observation.validate();
	if (!hasDistortion(observation.camera)) return CObservationInstances::Create(observation);

	prepare(observation.camera);
	auto out = CObservationInstances::Create();
	out->timestamp = observation.timestamp;
	out->sensorLabel = observation.sensorLabel;
	out->camera = pinhole(observation.camera);
	out->sensorPose = observation.sensorPose;
	out->labels = observation.labels;
	for (const Instance& instance : observation.instances)
		if (auto rectified = rectify(instance)) out->instances.push_back(std::move(*rectified));
	return out;
}

}  // namespace semloop

#include <semloop/config/Error.h>
#include <semloop/object_map/CObjectMap.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ObjectEvidence.h"

namespace semloop
{
namespace
{
using mrpt::img::TCamera;
using mrpt::math::TPoint3D;
using mrpt::poses::CPose3D;

constexpr double kNearest = 0.1;          // surfaces nearer than this are not predicted [m]
constexpr double kSmallestMargin = 0.03;  // [m]
// Rays a side: contours are interpolated between them, so more of them change little.
constexpr int kSamples = 36;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/** Depths within this of each other are one surface [m]. */
float occlusionMargin(const Object& object)
{
	return float(std::max(object.volume->options().truncation, kSmallestMargin));
}

/** Where a box lies in the image. */
struct BoxInView
{
	cv::Rect pixels;     //!< inside the image
	double nearest = 0;  //!< [m] along the axis
};

/** Empty when the box is outside of the view. Boxes that reach behind the camera cover the image. */
std::optional<BoxInView> project(
	const mrpt::math::TBoundingBox& box, double margin, const CPose3D& T_camera_object,
	const TCamera& camera)
{
	const cv::Rect image(0, 0, int(camera.ncols), int(camera.nrows));
	double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
	double left = nearest, right = -nearest, top = nearest, bottom = -nearest;
	for (int corner = 0; corner < 8; ++corner)
	{
		const TPoint3D p = T_camera_object.composePoint(TPoint3D(
			(corner & 1) ? box.max.x + margin : box.min.x - margin,
			(corner & 2) ? box.max.y + margin : box.min.y - margin,
			(corner & 4) ? box.max.z + margin : box.min.z - margin));
		nearest = std::min(nearest, p.z);
		farthest = std::max(farthest, p.z);
		if (p.z < kNearest) continue;
		const double u = camera.fx() * p.x / p.z + camera.cx();
		const double v = camera.fy() * p.y / p.z + camera.cy();
		left = std::min(left, u);
		right = std::max(right, u);
		top = std::min(top, v);
		bottom = std::max(bottom, v);
	}
	if (farthest < kNearest) return {};
	if (nearest < kNearest) return BoxInView{image, kNearest};
	if (right < 0 || bottom < 0 || left > image.width - 1 || top > image.height - 1) return {};
	const cv::Point first(int(std::max(0.0, left)), int(std::max(0.0, top)));
	const cv::Point last(
		int(std::min(right, image.width - 1.0)), int(std::min(bottom, image.height - 1.0)));
	return BoxInView{cv::Rect(first, last + cv::Point(1, 1)), nearest};
}

/** True when every one of a grid of measured depths is in front of the whole box. */
bool isHidden(const BoxInView& box, float margin, const cv::Mat& depth)
{
	if (depth.empty()) return false;
	constexpr int kGrid = 8;
	for (int row = 0; row <= kGrid; ++row)
		for (int column = 0; column <= kGrid; ++column)
		{
			const int v = box.pixels.y + row * (box.pixels.height - 1) / kGrid;
			const int u = box.pixels.x + column * (box.pixels.width - 1) / kGrid;
			const float z = depth.at<float>(v, u);
			if (!(z > 0) || double(z + margin) >= box.nearest) return false;
		}
	return true;
}

/** A prediction's depth at full resolution: that of the nearest cast pixel. */
class PredictedDepth
{
public:
	explicit PredictedDepth(const ObjectPrediction& prediction) : prediction_(prediction)
	{
		double sum = 0;
		int count = 0;
		for (int v = 0; v < prediction.depth.rows; ++v)
			for (int u = 0; u < prediction.depth.cols; ++u)
				if (const float z = prediction.depth.at<float>(v, u); z > 0) sum += z, ++count;
		mean_ = count > 0 ? float(sum / count) : 0.f;
	}

	/** Of the mask's pixels; the mean where the nearest cast pixel missed. */
	float at(int u, int v) const
	{
		const float z = prediction_.depth.at<float>(
			sample(v - prediction_.box.y, prediction_.depth.rows),
			sample(u - prediction_.box.x, prediction_.depth.cols));
		return z > 0 ? z : mean_;
	}

private:
	int sample(int offset, int count) const
	{
		return std::clamp((offset + prediction_.stride / 2) / prediction_.stride, 0, count - 1);
	}

	const ObjectPrediction& prediction_;
	float mean_ = 0;
};

void drawInto(cv::Mat& zBuffer, const ObjectPrediction& prediction)
{
	const PredictedDepth predicted(prediction);
	for (const auto& run : prediction.mask.runs())
	{
		auto* row = zBuffer.ptr<float>(run.row);
		for (int u = run.begin; u < run.end; ++u)
			row[u] = std::min(row[u], predicted.at(u, run.row));
	}
}

/** Takes away what lies behind the buffer; returns the share of the pixels that is left. */
double removeHidden(ObjectPrediction& prediction, const cv::Mat& zBuffer, float margin)
{
	const PredictedDepth predicted(prediction);
	std::vector<InstanceMask::Run> visible;
	for (const auto& run : prediction.mask.runs())
	{
		const auto* row = zBuffer.ptr<float>(run.row);
		bool open = false;
		for (int u = run.begin; u < run.end; ++u)
		{
			const bool seen = predicted.at(u, run.row) <= row[u] + margin;
			if (seen && !open) visible.push_back({run.row, uint16_t(u), 0});
			if (seen) visible.back().end = uint16_t(u + 1);
			open = seen;
		}
	}
	const auto before = double(prediction.mask.area());
	prediction.mask = InstanceMask(prediction.mask.imageSize(), std::move(visible));
	for (int v = 0; v < prediction.depth.rows; ++v)
		for (int u = 0; u < prediction.depth.cols; ++u)
		{
			float& z = prediction.depth.at<float>(v, u);
			const int x = prediction.box.x + u * prediction.stride;
			const int y = prediction.box.y + v * prediction.stride;
			if (z > zBuffer.at<float>(y, x) + margin) z = 0;
		}
	return before > 0 ? double(prediction.mask.area()) / before : 0;
}
}  // namespace

std::vector<PredictedObject> CObjectMap::predict(
	const TCamera& camera, const CPose3D& T_world_camera, const cv::Mat& depth,
	const std::optional<std::set<ObjectId>>& among) const
{
	if (!depth.empty() && (depth.type() != CV_32FC1 || depth.cols != int(camera.ncols) ||
						   depth.rows != int(camera.nrows)))
		throw InputError(
			"depth image of " + std::to_string(depth.cols) + " x " + std::to_string(depth.rows) +
			" pixels for a camera of " + std::to_string(camera.ncols) + " x " +
			std::to_string(camera.nrows) + ": give the camera's own depth in metres");
	struct Candidate
	{
		double distance = 0;
		PredictedObject object;
	};
	std::vector<Candidate> candidates;
	for (const auto& [id, object] : objects_)
	{
		if (among && among->count(id) == 0) continue;
		const auto box = object.volume->boundingBox();
		if (!box) continue;
		const CPose3D T_camera_object = object.T_world_object - T_world_camera;
		const auto inView =
			project(*box, object.volume->options().truncation, T_camera_object, camera);
		if (!inView || isHidden(*inView, occlusionMargin(object), depth)) continue;
		auto prediction = object.volume->raycast(camera, T_camera_object, kSamples);
		if (!prediction) continue;
		const double distance = T_camera_object.composePoint((box->min + box->max) * 0.5).z;
		candidates.push_back({distance, {id, std::move(*prediction), 1.0}});
	}

	cv::Mat zBuffer(int(camera.nrows), int(camera.ncols), CV_32FC1, cv::Scalar::all(kInfinity));
	if (!depth.empty()) depth.copyTo(zBuffer, depth > 0);
	for (const auto& candidate : candidates) drawInto(zBuffer, candidate.object.prediction);
	for (auto& [distance, object] : candidates)
		object.visibleShare =
			removeHidden(object.prediction, zBuffer, occlusionMargin(objects_.at(object.id)));

	std::stable_sort(
		candidates.begin(), candidates.end(),
		[](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
	std::vector<PredictedObject> predicted;
	for (auto& candidate : candidates)
		if (!candidate.object.prediction.mask.empty())
			predicted.push_back(std::move(candidate.object));
	return predicted;
}

std::vector<AssociationItem> CObjectMap::landmarks(
	const std::vector<PredictedObject>& predicted, const TCamera& camera) const
{
	std::vector<AssociationItem> result;
	for (const PredictedObject& p : predicted)
	{
		const Object& o = object(p.id);
		result.push_back(
			{&p.prediction.mask, &o.labelScores, &o.embeddings, p.prediction.extent(camera)});
	}
	return result;
}

void CObjectMap::updateExistence(
	const std::vector<PredictedObject>& predicted, const RgbdFrame& frame,
	const std::set<ObjectId>& associated)
{
	constexpr int kFewestSamples = 8;
	for (const ObjectId id : associated)
		if (const auto found = objects_.find(id); found != objects_.end())
			found->second.existence = updatedExistence(found->second.existence, kHitLogOdds);

	for (const auto& [id, prediction, visibleShare] : predicted)
	{
		const auto found = objects_.find(id);
		if (found == objects_.end() || associated.count(id) != 0) continue;
		if (prediction.mask.imageSize() != frame.depth.size())
			throw InputError("existence: the depth image is not of the predictions' camera");
		Object& object = found->second;
		const float margin = occlusionMargin(object);
		int measured = 0, behind = 0;
		for (int v = 0; v < prediction.depth.rows; ++v)
			for (int u = 0; u < prediction.depth.cols; ++u)
			{
				const float z = prediction.depth.at<float>(v, u);
				const float seen = frame.depth.at<float>(
					prediction.box.y + v * prediction.stride,
					prediction.box.x + u * prediction.stride);
				if (!(z > 0) || !(seen > 0)) continue;
				++measured;
				// The sensor's own depth error grows with the square of the depth.
				if (seen > z + margin + 0.01f * z * z) ++behind;
			}
		if (measured < kFewestSamples || 2 * behind <= measured) continue;
		++object.timesSeenThrough;
		object.existence =
			updatedExistence(object.existence, kSeenThroughLogOdds * behind / measured);
	}
}

}  // namespace semloop

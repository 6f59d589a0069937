#include <semloop/association/Assignment.h>
#include <semloop/association/ConfusionMatrix.h>
#include <semloop/association/MatchingCost.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/CObjectMap.h>
#include <semloop/object_map/ObservationLikelihood.h>

#include <algorithm>
#include <cmath>

#include "MapConfusion.h"
#include "MaskTrimming.h"
#include "SegmentedFrame.h"

namespace semloop
{
namespace
{
using mrpt::poses::CPose3D;

constexpr std::size_t kPoints = 12;  // of a detection's surface
constexpr int kFewestPixels = 16;    // with depth, else a detection counts as one without
constexpr double kKnown = 0.95;      // of the truncation: a larger distance only says "far"
constexpr double kNearest = 0.1;     // of a corner that is projected [m]

Eigen::Isometry3d isometry(const CPose3D& pose)
{
	Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
	result.linear() = pose.getRotationMatrix().asEigen();
	result.translation() = Eigen::Vector3d(pose.x(), pose.y(), pose.z());
	return result;
}

/** Some points of the visible surface, evenly over the mask; none where there is too little depth. */
std::vector<Eigen::Vector3d> pointsOf(
	const Instance& instance, const RgbdFrame& frame, double maxDepth)
{
	std::vector<Eigen::Vector3d> points;
	if (!instance.depth) return points;
	const auto trimmed =
		trimMask(instance.mask, frame.depth, frame.camera, kFewestPixels, maxDepth);
	if (!trimmed || trimmed->points.empty()) return points;
	const std::size_t count = std::min(kPoints, trimmed->points.size());
	for (std::size_t i = 0; i < count; ++i)
	{
		const auto& p = trimmed->points[(2 * i + 1) * trimmed->points.size() / (2 * count)];
		points.emplace_back(p.x, p.y, p.z);
	}
	return points;
}

/** From the box's faces, inside or outside [m]. */
double distanceFromFaces(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& p)
{
	if (!box.contains(p)) return box.exteriorDistance(p);
	return std::min((p - box.min()).minCoeff(), (box.max() - p).minCoeff());
}

/** From an object's surface [m]: what the TSDF says where it knows, else the box. */
double distanceFromSurface(
	const Eigen::AlignedBox3d& box, const TsdfVolume* volume, const Eigen::Vector3d& p)
{
	const double d = distanceFromFaces(box, p);
	if (!volume || box.exteriorDistance(p) > volume->options().truncation) return d;
	const double truncation = volume->options().truncation;
	const double known = std::abs(volume->distance({p.x(), p.y(), p.z()}).value_or(truncation));
	return known < kKnown * truncation ? known : std::max(d, truncation);
}

/** IoU of an instance's box and the image of an object's box. */
double overlap(
	const cv::Rect& seen, const mrpt::img::TCamera& camera,
	const Eigen::Isometry3d& T_camera_object, const Eigen::AlignedBox3d& box)
{
	Eigen::AlignedBox2d image;
	for (int corner = 0; corner < 8; ++corner)
	{
		const Eigen::Vector3d p =
			T_camera_object * box.corner(Eigen::AlignedBox3d::CornerType(corner));
		if (p.z() < kNearest) return 0;
		image.extend(Eigen::Vector2d(
			camera.fx() * p.x() / p.z() + camera.cx(), camera.fy() * p.y() / p.z() + camera.cy()));
	}
	const Eigen::AlignedBox2d whole(
		Eigen::Vector2d(0, 0), Eigen::Vector2d(camera.ncols, camera.nrows));
	image = image.intersection(whole);
	const Eigen::AlignedBox2d other(
		Eigen::Vector2d(seen.x, seen.y), Eigen::Vector2d(seen.br().x, seen.br().y));
	const auto both = image.intersection(other);
	if (image.isEmpty() || both.isEmpty()) return 0;
	return both.volume() / (image.volume() + other.volume() - both.volume());
}
}  // namespace

void ObjectMapLikelihoodOptions::describe(OptionFields& fields)
{
	fields.number(
		"unexplained", unexplained, 0.001, 0.999,
		"share of detections that a good map does not explain");
	fields.number(
		"position_scale", positionScale, 0.01, 10,
		"a detection this far from its object agrees with it by half [m]");
	fields.number("max_depth", maxDepth, 0.1, 100, "farther measurements are not looked at [m]");
}

ObservationLikelihood::ObservationLikelihood(
	const CObjectMap& map, const CObservationInstances& observation,
	const ObjectMapLikelihoodOptions& options)
	: options_(options)
{
	if (!map.isEmpty() && !(map.labels() == observation.labels))
		throw InputError(
			"instances of " + std::to_string(observation.labels.size()) +
			" labels for a map with another set of " + std::to_string(map.labels().size()) +
			": use the segmentation network that made the map");
	const SegmentedFrame cropped = SegmentedFrame::fromCrops(observation);
	camera_ = cropped.frame.camera;
	T_robot_camera_ = cropped.frame.T_robot_camera;

	std::vector<const Object*> objects;
	for (const auto& [id, object] : map.objects())
		if (const auto box = object.volume->boundingBox())
		{
			objects.push_back(&object);
			landmarks_.push_back(
				{isometry(object.T_world_object).inverse(),
				 {Eigen::Vector3d(box->min.x, box->min.y, box->min.z),
				  Eigen::Vector3d(box->max.x, box->max.y, box->max.z)},
				 object.volume});
		}
	for (const auto& instance : cropped.instances)
		detections_.push_back({instance.box, pointsOf(instance, cropped.frame, options.maxDepth)});

	const ConfusionMatrix confusion = mapConfusion(map.labels());
	appearance_.resize(Eigen::Index(detections_.size()), Eigen::Index(objects.size()));
	for (std::size_t k = 0; k < detections_.size(); ++k)
		for (std::size_t j = 0; j < objects.size(); ++j)
		{
			const Instance& instance = cropped.instances[k];
			const auto d_f = embeddingSimilarity(objects[j]->embeddings, {instance.embedding});
			appearance_(Eigen::Index(k), Eigen::Index(j)) =
				labelAgreement(confusion, instance.labelScores, objects[j]->labelScores) *
				std::clamp(d_f.value_or(1.0), 0.0, 1.0);
		}
}

double ObservationLikelihood::agreement(
	const Detection& detection, const Landmark& landmark, const TsdfVolume* volume,
	const std::vector<Eigen::Vector3d>& p_world, const Eigen::Isometry3d& T_world_camera) const
{
	if (p_world.empty())
		return overlap(
			detection.box, camera_, (landmark.T_object_world * T_world_camera).inverse(),
			landmark.box);
	double sum = 0;
	for (const auto& p : p_world)
		sum += distanceFromSurface(landmark.box, volume, landmark.T_object_world * p);
	const double d = sum / double(p_world.size());
	return 1 / (1 + std::pow(d / options_.positionScale, 2));
}

double ObservationLikelihood::log(const CPose3D& T_world_robot) const
{
	const Eigen::Isometry3d T_world_camera = isometry(T_world_robot + T_robot_camera_);
	const double q = options_.unexplained, nothing = -std::log(q);
	CostMatrix cost(appearance_.rows(), appearance_.cols());
	std::vector<std::shared_ptr<const TsdfVolume>> volumes;
	for (const auto& landmark : landmarks_) volumes.push_back(landmark.volume.lock());
	std::vector<Eigen::Vector3d> p_world;
	for (Eigen::Index k = 0; k < cost.rows(); ++k)
	{
		const Detection& detection = detections_[std::size_t(k)];
		p_world.clear();
		for (const auto& p : detection.points) p_world.push_back(T_world_camera * p);
		for (Eigen::Index j = 0; j < cost.cols(); ++j)
		{
			const double g = agreement(
				detection, landmarks_[std::size_t(j)], volumes[std::size_t(j)].get(), p_world,
				T_world_camera);
			cost(k, j) = -std::log(q + (1 - q) * appearance_(k, j) * g);
		}
	}
	// An assignment leaves open what is no better than nothing; the log of 1 is 0.
	double sum = nothing * double(cost.rows());
	for (const auto& [k, j] : solveAssignment(cost, nothing).matches)
		sum += cost(Eigen::Index(k), Eigen::Index(j)) - nothing;
	return -sum;
}

}  // namespace semloop

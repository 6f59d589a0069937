#include <semloop/config/Error.h>
#include <semloop/object_map/CObjectMap.h>

#include <algorithm>

#include "Coarsening.h"
#include "MaskTrimming.h"
#include "ObjectEvidence.h"

namespace semloop
{
namespace
{
using mrpt::math::TPoint3D;
using mrpt::poses::CPose3D;

/** Range of the p-th to the (1 - p)-th quantile of the values; they must not be empty. */
std::pair<double, double> robustRange(std::vector<double> values, double p)
{
	const auto rank = std::ptrdiff_t(p * double(values.size() - 1));
	std::nth_element(values.begin(), values.begin() + rank, values.end());
	const double low = values[std::size_t(rank)];
	std::nth_element(values.begin(), values.end() - 1 - rank, values.end());
	return {low, *(values.end() - 1 - rank)};
}

/** Of an object that the image's edge cuts it is not known what was seen. */
void markSeenSides(
	Object& object, const RgbdFrame& frame, const Instance& instance, const CPose3D& T_world_camera)
{
	const cv::Rect inside(1, 1, frame.color.cols - 2, frame.color.rows - 2);
	const cv::Rect seen = instance.mask.boundingBox();
	if ((seen & inside) != seen) return;
	const auto box = object.volume->boundingBox();
	if (!box) return;
	const auto camera =
		object.T_world_object.inverseComposePoint(TPoint3D(T_world_camera.translation()));
	object.seenSides.seenFrom(camera - (box->min + box->max) * 0.5);
}

struct Extent
{
	TPoint3D centre;
	double largestSide = 0;
};

/** Of the points' robust box in the world's axes. */
Extent extentInWorld(const std::vector<TPoint3D>& p_camera, const CPose3D& T_world_camera)
{
	std::array<std::vector<double>, 3> coordinates;
	for (const auto& p : p_camera)
	{
		const TPoint3D p_world = T_world_camera.composePoint(p);
		for (int axis = 0; axis < 3; ++axis)
			coordinates[std::size_t(axis)].push_back(p_world[axis]);
	}
	Extent extent;
	for (int axis = 0; axis < 3; ++axis)
	{
		const auto [low, high] = robustRange(std::move(coordinates[std::size_t(axis)]), 0.02);
		extent.centre[axis] = 0.5 * (low + high);
		extent.largestSide = std::max(extent.largestSide, high - low);
	}
	return extent;
}

TsdfOptions volumeOptions(const ObjectMapInsertionOptions& options, double size)
{
	TsdfOptions result;
	result.voxelSize = std::clamp(
		size / options.voxelsPerSide, options.minVoxelSize,
		std::max(options.minVoxelSize, options.maxVoxelSize));
	result.truncation = options.truncationVoxels * result.voxelSize;
	return result;
}

void integrate(
	TsdfVolume& volume, RgbdFrame frame, const TrimmedMask& trimmed, const CPose3D& T_object_camera)
{
	frame.depth = trimmed.certainDepth(frame.depth);
	volume.integrate(frame, trimmed.mask, T_object_camera);
}
}  // namespace

void ObjectMapInsertionOptions::describe(OptionFields& fields)
{
	fields.number(
		"voxels_per_side", voxelsPerSide, 4, 512,
		"voxel size = size of the object when first seen / this");
	fields.number("min_voxel_size", minVoxelSize, 0.001, 1, "smallest voxel [m]");
	fields.number("max_voxel_size", maxVoxelSize, 0.001, 1, "largest voxel [m]");
	fields.number(
		"truncation_voxels", truncationVoxels, 1, 32,
		"half width of the band round the surface, in voxels");
	fields.number("max_depth", maxDepth, 0.1, 20, "further measurements are not fused [m]");
	fields.integer(
		"min_pixels", minPixels, 1, 1000000,
		"a mask needs this many pixels of valid depth on the object");
	fields.integer("max_embeddings", maxEmbeddings, 1, 1000, "|E_j| at most, Eq. (3)");
	fields.number(
		"gate", gate, 0, 1, "largest matching cost when the map itself associates, Eq. (3)");
}

void ObjectMapMaintenanceOptions::describe(OptionFields& fields)
{
	fields.number("min_existence", minExistence, 0, 1, "below: the object is removed");
	fields.number(
		"merge_iou", mergeIou, 0, 1,
		"boxes of two objects of compatible label that overlap more are one object; of other "
		"labels "
		"when the surfaces do, too");
	fields.number(
		"merge_surface_overlap", mergeSurfaceOverlap, 0, 1,
		"same, for the share of the smaller one's surface that lies on the larger one's");
	fields.number(
		"merge_label_overlap", mergeLabelOverlap, 0, 1,
		"labels are compatible when the best ones agree or the distributions share more than this");
}

const Object& CObjectMap::object(ObjectId id) const
{
	return objects_.at(id);
}

const std::string& CObjectMap::labelName(const Object& object) const
{
	return labels_.name(object.label());
}

TsdfVolume& CObjectMap::writableVolume(Object& object)
{
	if (object.volume.use_count() > 1) object.volume = std::make_shared<TsdfVolume>(*object.volume);
	return *object.volume;
}

void CObjectMap::requireUsable(const RgbdFrame& frame, const Instance& instance) const
{
	const auto size = [](cv::Size s)
	{ return std::to_string(s.width) + " x " + std::to_string(s.height); };
	if (instance.mask.imageSize() != frame.depth.size() || frame.depth.type() != CV_32FC1)
		throw InputError(
			"instance mask of " + size(instance.mask.imageSize()) + " pixels in a frame of " +
			size(frame.depth.size()) + ": segment the same image that is mapped");
	if (instance.labelScores.empty())
		throw InputError("instance without a label: give it at least one label score");
	for (const auto& score : instance.labelScores)
		if (score.label >= labels_.size())
			throw InputError(
				"label " + std::to_string(score.label) + " is not among the map's " +
				std::to_string(labels_.size()) + " labels: set the network's labels first");
}

std::optional<ObjectId> CObjectMap::addObject(
	const RgbdFrame& frame, const Instance& instance, const CPose3D& T_world_camera)
{
	requireUsable(frame, instance);
	const auto trimmed = trimMask(
		instance.mask, frame.depth, frame.camera, insertionOptions.minPixels,
		insertionOptions.maxDepth);
	if (!trimmed) return {};
	const Extent extent = extentInWorld(trimmed->points, T_world_camera);

	Object object;
	object.volume =
		std::make_shared<TsdfVolume>(volumeOptions(insertionOptions, extent.largestSide));
	object.T_world_object = CPose3D::FromTranslation(extent.centre);
	integrate(*object.volume, frame, *trimmed, T_world_camera - object.T_world_object);
	if (!object.volume->boundingBox()) return {};
	object.id = nextId_++;
	object.labelScores = averageLabels(instance.labelScores, 1, {}, 0);
	addEmbeddings(object.embeddings, {instance.embedding}, insertionOptions.maxEmbeddings);
	object.observations = 1;
	markSeenSides(object, frame, instance, T_world_camera);
	object.firstSeen = object.lastSeen = frame.time;
	const ObjectId id = object.id;
	objects_.emplace(id, std::move(object));
	return id;
}

bool CObjectMap::fuse(
	ObjectId id, const RgbdFrame& frame, const Instance& instance, const CPose3D& T_world_camera)
{
	Object& object = objects_.at(id);
	requireUsable(frame, instance);
	if (!instance.embedding.empty() && !object.embeddings.empty() &&
		instance.embedding.size() != object.embeddings.front().size())
		throw InputError(
			"embedding of " + std::to_string(instance.embedding.size()) + " numbers for object " +
			std::to_string(id) + ", which has " + std::to_string(object.embeddings.front().size()) +
			": use one embedding network a map");
	const auto trimmed = trimMask(
		instance.mask, frame.depth, frame.camera, insertionOptions.minPixels,
		insertionOptions.maxDepth);
	if (!trimmed) return false;

	integrate(writableVolume(object), frame, *trimmed, T_world_camera - object.T_world_object);
	if (isFull(*object.volume)) object.volume = coarsened(*object.volume);
	object.labelScores =
		averageLabels(object.labelScores, object.observations, instance.labelScores, 1);
	addEmbeddings(object.embeddings, {instance.embedding}, insertionOptions.maxEmbeddings);
	++object.observations;
	markSeenSides(object, frame, instance, T_world_camera);
	object.existence = updatedExistence(object.existence, kHitLogOdds);
	object.lastSeen = frame.time;
	return true;
}

void CObjectMap::markCovisible(const std::set<ObjectId>& objects)
{
	for (const ObjectId id : objects) objects_.at(id);  // throws before anything is changed
	for (const ObjectId a : objects)
		for (const ObjectId b : objects)
			if (a != b) ++objects_.at(a).covisible[b];
}

std::vector<ObjectId> CObjectMap::removeUnsupported()
{
	std::vector<ObjectId> removed;
	for (const auto& [id, object] : objects_)
		if (object.existence < maintenanceOptions.minExistence) removed.push_back(id);
	for (const ObjectId id : removed) objects_.erase(id);
	for (auto& [id, object] : objects_)
		for (const ObjectId gone : removed) object.covisible.erase(gone);
	return removed;
}

void CObjectMap::internal_clear()
{
	objects_.clear();
	nextId_ = 0;
	unpaired_ = {};
}

}  // namespace semloop

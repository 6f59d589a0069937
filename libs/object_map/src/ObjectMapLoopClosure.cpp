#include <semloop/object_map/CObjectMap.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "Coarsening.h"
#include "ObjectEvidence.h"

namespace semloop
{
namespace
{
using mrpt::math::TBoundingBox;
using mrpt::math::TPoint3D;
using mrpt::poses::CPose3D;

/** What decides about duplicates. */
struct Candidate
{
	const Object* object = nullptr;
	TBoundingBox box;  //!< axis-aligned in the world
};

TBoundingBox worldBox(const TBoundingBox& box, const CPose3D& T_world_object)
{
	auto result = TBoundingBox::PlusMinusInfinity();
	for (int corner = 0; corner < 8; ++corner)
		result.updateWithPoint(T_world_object.composePoint(TPoint3D(
			(corner & 1) ? box.max.x : box.min.x, (corner & 2) ? box.max.y : box.min.y,
			(corner & 4) ? box.max.z : box.min.z)));
	return result;
}

TBoundingBox inflated(const Candidate& candidate)
{
	// Thin objects, as sheets and keyboards, miss each other by less than a voxel.
	const double margin = candidate.object->volume->options().voxelSize;
	const TPoint3D m(margin, margin, margin);
	return {candidate.box.min - m, candidate.box.max + m};
}

double intersectionOverUnion(const TBoundingBox& a, const TBoundingBox& b)
{
	const auto both = a.intersection(b);
	if (!both) return 0;
	const double intersection = both->volume();
	return intersection > 0 ? intersection / (a.volume() + b.volume() - intersection) : 0;
}

/** Share of a's surface that lies on b's, [0, 1]. */
double surfaceOverlap(const Object& a, const Object& b)
{
	constexpr std::size_t kSamples = 400;
	const auto surface = a.volume->surface();
	const std::size_t step = std::max<std::size_t>(1, surface.size() / kSamples);
	const CPose3D T_b_a = a.T_world_object - b.T_world_object;
	const double near = 2 * std::max(a.volume->options().voxelSize, b.volume->options().voxelSize);
	std::size_t samples = 0, onSurface = 0;
	for (std::size_t i = 0; i < surface.size(); i += step, ++samples)
	{
		const auto distance = b.volume->distance(T_b_a.composePoint(TPoint3D(surface[i].position)));
		onSurface += distance && std::abs(*distance) < near;
	}
	return samples > 0 ? double(onSurface) / double(samples) : 0;
}

/** How much two objects are one, larger = merge first; 0 = they are not. */
double sameness(const Candidate& a, const Candidate& b, const ObjectMapMaintenanceOptions& options)
{
	const LabelScores &labelsA = a.object->labelScores, &labelsB = b.object->labelScores;
	const bool compatible = labelsA.front().label == labelsB.front().label ||
							labelOverlap(labelsA, labelsB) > options.mergeLabelOverlap;
	if (!inflated(a).intersection(inflated(b))) return 0;
	const double iou = std::max(
		intersectionOverUnion(a.box, b.box), intersectionOverUnion(inflated(a), inflated(b)));
	if (!compatible && iou <= options.mergeIou) return 0;
	const bool aIsSmaller = inflated(a).volume() < inflated(b).volume();
	const double onSurface =
		aIsSmaller ? surfaceOverlap(*a.object, *b.object) : surfaceOverlap(*b.object, *a.object);
	const bool boxes = iou > options.mergeIou, surfaces = onSurface > options.mergeSurfaceOverlap;
	const bool one = compatible ? boxes || surfaces : boxes && surfaces;
	return one ? iou + onSurface : 0;
}

std::shared_ptr<TsdfVolume> mergedVolume(
	const TsdfVolume& kept, const TsdfVolume& absorbed, const CPose3D& T_kept_absorbed)
{
	auto merged = std::make_shared<TsdfVolume>(kept);
	merged->merge(absorbed, T_kept_absorbed);
	if (!isFull(*merged)) return merged;
	merged = coarsened(kept);
	merged->merge(absorbed, T_kept_absorbed);
	return merged;
}
}  // namespace

void CObjectMap::moveObjects(const std::map<ObjectId, CPose3D>& poses)
{
	for (const auto& [id, pose] : poses) objects_.at(id);  // throws before anything is changed
	for (const auto& [id, pose] : poses) objects_.at(id).T_world_object = pose;
}

void CObjectMap::mergeObjects(ObjectId kept, ObjectId absorbed)
{
	Object& target = objects_.at(kept);
	const Object source = objects_.at(absorbed);
	if (kept == absorbed)
		throw std::invalid_argument("an object cannot absorb itself: " + std::to_string(kept));

	target.volume =
		mergedVolume(*target.volume, *source.volume, source.T_world_object - target.T_world_object);
	target.labelScores = averageLabels(
		target.labelScores, target.observations, source.labelScores, source.observations);
	addEmbeddings(target.embeddings, source.embeddings, insertionOptions.maxEmbeddings);
	target.observations += source.observations;
	target.seenSides.add(source.seenSides, source.T_world_object - target.T_world_object);
	target.timesSeenThrough += source.timesSeenThrough;
	target.existence = std::max(target.existence, source.existence);
	target.firstSeen = std::min(target.firstSeen, source.firstSeen);
	target.lastSeen = std::max(target.lastSeen, source.lastSeen);

	for (const auto& [id, count] : source.covisible)
	{
		objects_.at(id).covisible.erase(absorbed);
		if (id == kept) continue;
		target.covisible[id] += count;
		objects_.at(id).covisible[kept] += count;
	}
	objects_.erase(absorbed);
}

std::vector<std::pair<ObjectId, ObjectId>> CObjectMap::findDuplicates(
	const std::optional<std::set<ObjectId>>& among) const
{
	std::vector<Candidate> candidates;
	for (const auto& [id, object] : objects_)
	{
		if (among && among->count(id) == 0) continue;
		if (const auto box = object.volume->boundingBox())
			candidates.push_back({&object, worldBox(*box, object.T_world_object)});
	}

	struct Pair
	{
		double sameness = 0;
		ObjectId kept = 0, absorbed = 0;
	};
	std::vector<Pair> pairs;
	for (std::size_t i = 0; i < candidates.size(); ++i)
		for (std::size_t j = i + 1; j < candidates.size(); ++j)
			if (const double s = sameness(candidates[i], candidates[j], maintenanceOptions); s > 0)
				pairs.push_back({s, candidates[i].object->id, candidates[j].object->id});
	std::stable_sort(
		pairs.begin(), pairs.end(),
		[](const Pair& a, const Pair& b) { return a.sameness > b.sameness; });

	// What became one may not be like a third any more: each object once, then ask again.
	std::vector<std::pair<ObjectId, ObjectId>> duplicates;
	std::set<ObjectId> taken;
	for (const Pair& pair : pairs)
	{
		if (taken.count(pair.kept) || taken.count(pair.absorbed)) continue;
		taken.insert({pair.kept, pair.absorbed});
		duplicates.emplace_back(pair.kept, pair.absorbed);
	}
	return duplicates;
}

}  // namespace semloop

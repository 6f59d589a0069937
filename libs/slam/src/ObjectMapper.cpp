#include <semloop/association/MaskedSurface.h>
#include <semloop/slam/ObjectMapper.h>

#include <utility>

namespace semloop
{
namespace
{
using Embeddings = std::vector<std::vector<float>>;

// A pose that is known better leaves nearly all of an object's pixels before their depth [m, rad].
constexpr double kCertain = 0.01;

/** The detections as Eq. (3) wants them; owns what the items point to. */
struct Detections
{
	std::vector<Embeddings> embeddings;
	std::vector<AssociationItem> items;
};

Detections detectionsOf(
	const RgbdFrame& frame, const CObservationInstances& observation,
	const std::vector<TrackedInstance>& confirmed)
{
	Detections result;
	result.embeddings.reserve(confirmed.size());
	for (const TrackedInstance& tracked : confirmed)
	{
		const Instance& instance = observation.instances[tracked.instance];
		auto& embeddings = result.embeddings.emplace_back();
		if (!instance.embedding.empty()) embeddings.push_back(instance.embedding);
		const MaskedSurface surface(instance.mask, frame.depth, frame.camera);
		result.items.push_back(
			{&instance.mask, &instance.labelScores, &embeddings, surface.extent()});
	}
	return result;
}
}  // namespace

ObjectMapper::ObjectMapper(
	CObjectMap::Ptr map, std::shared_ptr<const Associator> associator, StageTimings& timings,
	FrameRegistrationOptions registration)
	: map_(std::move(map)),
	  associator_(std::move(associator)),
	  timings_(timings),
	  registrationOptions_(std::move(registration))
{
}

std::vector<ObjectObservation> ObjectMapper::update(
	const RgbdFrame& frame, const CObservationInstances& observation,
	const std::vector<TrackedInstance>& tracked, const mrpt::poses::CPose3D& T_world_expected,
	const LocalMap& localMap, const PoseSigma& sigma)
{
	std::vector<TrackedInstance> confirmed;
	for (const auto& t : tracked)
		if (t.confirmed) confirmed.push_back(t);

	// Measured depth hides what a camera that is off would put behind it: not before it is registered.
	const bool isUncertain = sigma.translation > kCertain || sigma.rotation > kCertain;
	auto predicted =
		predict(frame, T_world_expected, isUncertain ? cv::Mat() : frame.depth, localMap);
	Detections detections;
	{
		const StageTimings::Scope timing(timings_, "registration");
		detections = detectionsOf(frame, observation, confirmed);
		registered_ = registerFrame(
			map_->landmarks(predicted, frame.camera), detections.items, sigma,
			registrationOptions_);
	}
	const auto T_world_camera = T_world_expected + (-registered_.T_seen_expected);
	if (isUncertain || registered_.T_seen_expected != mrpt::poses::CPose3D())
		predicted = predict(frame, T_world_camera, frame.depth, localMap);

	std::vector<std::optional<ObjectId>> objects(confirmed.size());
	{
		const StageTimings::Scope timing(timings_, "association");
		const auto landmarks = map_->landmarks(predicted, frame.camera);
		for (const auto& [j, k] : associator_->associate(landmarks, detections.items).matches)
			objects[k] = predicted[j].id;
	}

	const StageTimings::Scope timing(timings_, "fusion");
	std::vector<ObjectObservation> seen;
	std::set<ObjectId> associated;
	for (std::size_t k = 0; k < confirmed.size(); ++k)
	{
		const Instance& instance = observation.instances[confirmed[k].instance];
		const auto observed =
			fuse(frame, instance, confirmed[k], objects[k], T_world_camera, localMap);
		if (!observed) continue;
		associated.insert(observed->object);
		seen.push_back(*observed);
	}
	map_->updateExistence(predicted, frame, associated);
	return seen;
}

std::vector<PredictedObject> ObjectMapper::predict(
	const RgbdFrame& frame, const mrpt::poses::CPose3D& T_world_camera, const cv::Mat& depth,
	const LocalMap& localMap) const
{
	const StageTimings::Scope timing(timings_, "prediction");
	return map_->predict(frame.camera, T_world_camera, depth, localMap.objects());
}

std::optional<ObjectObservation> ObjectMapper::fuse(
	const RgbdFrame& frame, const Instance& instance, const TrackedInstance& tracked,
	std::optional<ObjectId> object, const mrpt::poses::CPose3D& T_world_camera,
	const LocalMap& localMap)
{
	ObjectObservation result;
	result.instance = tracked.instance;
	result.track = tracked.track;
	if (object)
	{
		if (!map_->fuse(*object, frame, instance, T_world_camera)) return std::nullopt;
		result.object = *object;
	}
	else
	{
		// A track whose object was not recognised in this frame is no second object.
		const auto known = objectOfTrack_.find(tracked.track);
		result.fused = known == objectOfTrack_.end() || !localMap.contains(known->second);
		const auto id =
			result.fused ? map_->addObject(frame, instance, T_world_camera) : known->second;
		if (!id) return std::nullopt;
		result.object = *id;
	}
	objectOfTrack_[tracked.track] = result.object;
	return result;
}

void ObjectMapper::merge(ObjectId kept, ObjectId absorbed)
{
	for (auto& entry : objectOfTrack_)
		if (entry.second == absorbed) entry.second = kept;
	absorbedBy_[absorbed] = kept;
}

ObjectId ObjectMapper::mergedInto(ObjectId id) const
{
	for (auto it = absorbedBy_.find(id); it != absorbedBy_.end(); it = absorbedBy_.find(id))
		id = it->second;
	return id;
}

void ObjectMapper::remove(ObjectId id)
{
	for (auto it = objectOfTrack_.begin(); it != objectOfTrack_.end();)
		it = it->second == id ? objectOfTrack_.erase(it) : std::next(it);
}

}  // namespace semloop

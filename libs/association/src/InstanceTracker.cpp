#include <semloop/association/InstanceTracker.h>
#include <semloop/association/ObjectAssociator.h>
#include <semloop/config/Error.h>

#include <algorithm>
#include <iterator>
#include <string>

namespace semloop
{
namespace
{
std::string text(cv::Size size)
{
	return std::to_string(size.width) + " x " + std::to_string(size.height);
}

void requireOneImageSize(const RgbdFrame& frame, const CObservationInstances& observation)
{
	const cv::Size size(int(frame.camera.ncols), int(frame.camera.nrows));
	const auto require = [&](cv::Size other, const std::string& what)
	{
		if (other != size)
			throw InputError(
				"tracking: " + what + " of " + text(other) + " pixels in a frame of " + text(size) +
				"; rectify both to one size");
	};
	if (!frame.depth.empty()) require(frame.depth.size(), "a depth image");
	for (std::size_t i = 0; i < observation.instances.size(); ++i)
		require(observation.instances[i].mask.imageSize(), "instance " + std::to_string(i));
}
}  // namespace

void InstanceTrackerOptions::describe(OptionFields& fields)
{
	fields.integer(
		"min_tracked_frames", minTrackedFrames, 1, 1000,
		"A track counts from this many observations on");
	fields.integer(
		"max_missed_frames", maxMissedFrames, 0, 1000,
		"Segmented frames that a track survives unseen");
	fields.number("gate", gate, 0, 1, "Largest matching cost of an association, Eq. (1)");
	fields.number("min_confidence", minConfidence, 0, 1, "Weaker detections are not looked at");
}

AssociationItem InstanceTracker::Track::item() const
{
	return {&mask, &labelScores, &embeddings, surface.extent()};
}

InstanceTracker::InstanceTracker(
	InstanceTrackerOptions options, std::shared_ptr<const MatchingCost> cost,
	FrameRegistrationOptions registration)
	: options_(std::move(options)),
	  cost_(std::move(cost)),
	  registrationOptions_(std::move(registration))
{
	if (!cost_) throw UsageError("InstanceTracker: no matching cost; give one");
}

std::vector<TrackedInstance> InstanceTracker::track(
	const RgbdFrame& frame, const CObservationInstances& observation,
	const mrpt::poses::CPose3D& T_previous_camera, const PoseSigma& sigma)
{
	requireOneImageSize(frame, observation);
	moveTracks(frame.camera, -T_previous_camera);

	std::vector<Track> seen;
	std::vector<TrackedInstance> result;
	for (std::size_t i = 0; i < observation.instances.size(); ++i)
	{
		if (observation.instances[i].confidence < options_.minConfidence) continue;
		seen.push_back(trackFrom(observation.instances[i], frame));
		result.emplace_back().instance = i;
	}

	std::vector<AssociationItem> known, detections;
	for (const auto& track : tracks_) known.push_back(track.item());
	for (const auto& track : seen) detections.push_back(track.item());
	registered_ = registerFrame(known, detections, sigma, registrationOptions_);
	if (registered_.T_seen_expected != mrpt::poses::CPose3D())
	{
		moveTracks(frame.camera, registered_.T_seen_expected);
		known.clear();
		for (const auto& track : tracks_) known.push_back(track.item());
	}
	const auto matches =
		solveAssignment(matchingCosts(*cost_, known, detections), options_.gate).matches;

	for (auto& track : tracks_) ++track.missed;
	std::vector<Track*> trackOf(seen.size(), nullptr);
	for (const auto& [track, detection] : matches) trackOf[detection] = &tracks_[track];
	std::vector<Track> born;
	for (std::size_t k = 0; k < seen.size(); ++k)
	{
		Track& track = trackOf[k] ? *trackOf[k] : born.emplace_back();
		if (!trackOf[k]) track.id = nextId_++;
		update(track, std::move(seen[k]));
		result[k].track = track.id;
		result[k].observations = track.observations;
		result[k].confirmed = track.observations >= options_.minTrackedFrames;
	}
	const auto dead = [&](const Track& track) { return track.missed > options_.maxMissedFrames; };
	tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(), dead), tracks_.end());
	std::move(born.begin(), born.end(), std::back_inserter(tracks_));
	return result;
}

void InstanceTracker::moveTracks(
	const mrpt::img::TCamera& camera, const mrpt::poses::CPose3D& T_camera_previous)
{
	for (auto& track : tracks_)
	{
		if (track.surface.empty()) continue;
		track.surface.transform(T_camera_previous);
		track.mask = track.surface.project(camera);
	}
}

InstanceTracker::Track InstanceTracker::trackFrom(const Instance& instance, const RgbdFrame& frame)
{
	Track track;
	track.mask = instance.mask;
	track.surface = MaskedSurface(instance.mask, frame.depth, frame.camera);
	track.labelScores = instance.labelScores;
	if (!instance.embedding.empty()) track.embeddings.push_back(instance.embedding);
	return track;
}

void InstanceTracker::update(Track& track, Track seen)
{
	++track.observations;
	track.missed = 0;
	track.mask = std::move(seen.mask);
	track.surface = std::move(seen.surface);
	track.labelScores = std::move(seen.labelScores);
	if (!seen.embeddings.empty()) track.embeddings = std::move(seen.embeddings);
}

}  // namespace semloop

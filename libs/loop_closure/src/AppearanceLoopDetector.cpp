#include <mrpt/core/format.h>
#include <mrpt/core/initializer.h>
#include <semloop/config/Error.h>
#include <semloop/config/ModuleFactory.h>
#include <semloop/loop_closure/AppearanceLoopDetector.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(AppearanceLoopDetector, LoopDetector, semloop)
IMPLEMENTS_MRPT_OBJECT(BagOfWordsLoopDetector, AppearanceLoopDetector, semloop)
IMPLEMENTS_MRPT_OBJECT(OrbLoopDetector, AppearanceLoopDetector, semloop)

MRPT_INITIALIZER(registerAppearanceLoopDetectors)
{
	mrpt::rtti::registerClass(CLASS_ID(semloop::BagOfWordsLoopDetector));
	mrpt::rtti::registerClass(CLASS_ID(semloop::OrbLoopDetector));
}

namespace semloop
{
namespace
{
constexpr const char* kSection = "appearance";
}

void AppearanceOptions::describe(OptionFields& fields)
{
	fields.integer("features", features, 10, 100000, "ORB features of a key frame");
	fields.integer("key_frame_every", keyFrameEvery, 1, 1000000, "segmented frames");
	fields.integer(
		"min_frames_apart", minFramesApart, 1, 100000000, "of the two key frames of a loop");
	fields.integer(
		"max_queries", maxQueries, 1, 1000000,
		"key frames of the local map that are looked for at a time, the latest");
	verification.describe(fields);
}

void BagOfWordsLoopDetectorOptions::describe(OptionFields& fields)
{
	fields.text("vocabulary", vocabulary, "file of rawlog-train-vocabulary");
	fields.number(
		"min_similarity", minSimilarity, 0, 1,
		"of a candidate, as a share of the similarity with the key frame before");
	fields.integer(
		"max_candidates", maxCandidates, 1, 1000000, "that are verified for each key frame");
	AppearanceOptions::describe(fields);
}

void AppearanceLoopDetector::addFrame(std::size_t frame, const RgbdFrame& images)
{
	if (offered_++ % std::size_t(appearance().keyFrameEvery) != 0) return;
	keyFrames_.push_back({frame, extractOrb(images, appearance().features)});
	remember(keyFrames_.back().features);
}

LoopVerdict AppearanceLoopDetector::detect(const LoopQuery& query)
{
	if (!query.T_world_camera)
		throw std::invalid_argument("loop detector: cameras are compared, their poses are missing");
	const AppearanceOptions& options = appearance();
	LoopVerdict verdict;
	verdict.queryObjects = query.query.size();
	const auto frameOf = [](const KeyFrame& keyFrame, std::size_t frame)
	{ return keyFrame.frame < frame; };
	const auto firstOf = [&](std::size_t frame)
	{
		return std::size_t(
			std::lower_bound(keyFrames_.begin(), keyFrames_.end(), frame, frameOf) -
			keyFrames_.begin());
	};
	std::size_t first = std::max(asked_, firstOf(query.firstFrame));
	if (keyFrames_.size() > std::size_t(options.maxQueries))
		first = std::max(first, keyFrames_.size() - std::size_t(options.maxQueries));
	asked_ = keyFrames_.size();

	std::size_t compared = 0, matches = 0;
	for (std::size_t q = first; q < keyFrames_.size(); ++q)
	{
		const std::size_t frame = keyFrames_[q].frame;
		const auto apart = std::size_t(options.minFramesApart);
		if (frame < apart) continue;
		const std::size_t end = firstOf(std::min(query.firstFrame, frame - apart + 1));
		for (const std::size_t t : candidates(q, end))
		{
			++compared;
			const auto found = compareCameras(
				keyFrames_[q].features, keyFrames_[t].features, options.verification);
			matches = std::max(matches, found.matches);
			if (!found.pose) continue;
			if (!verdict.cameras.empty() && verdict.cameras[0].inliers >= found.pose->inliers)
				continue;
			verdict.cameras = {
				{frame, keyFrames_[t].frame, found.pose->T_target_query, found.pose->information,
				 found.pose->inliers}};
		}
	}
	verdict.reason =
		mrpt::format("%zu pairs of %zu key frames look alike", compared, keyFrames_.size() - first);
	if (verdict.cameras.empty())
	{
		verdict.reason += mrpt::format(
			", the best has %zu matches; needed are %d that one pose explains", matches,
			options.verification.minInliers);
		return verdict;
	}
	const CameraMatch& best = verdict.cameras[0];
	verdict.decision = LoopVerdict::Decision::Accepted;
	verdict.graphsMatch = true;
	verdict.hasPose = true;
	verdict.T_target_query = query.T_world_camera(best.target) + best.T_target_query +
							 (-query.T_world_camera(best.query));
	verdict.reason += mrpt::format(
		"; frame %zu sees what frame %zu saw: %zu features agree", best.query, best.target,
		best.inliers);
	return verdict;
}

void BagOfWordsLoopDetector::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& /*section*/)
{
	options.loadFromConfigFile(config, kSection);
	if (options.vocabulary.empty())
		throw UsageError(
			configFileName(config) + ": [" + kSection +
			"] vocabulary: name a file; rawlog-train-vocabulary makes one");
	vocabulary_ = OrbVocabulary::load(options.vocabulary);
}

void BagOfWordsLoopDetector::remember(const OrbFeatures& features)
{
	bags_.push_back(vocabulary_.describe(features.descriptors));
	index_.add(bags_.back());
}

std::vector<std::size_t> BagOfWordsLoopDetector::candidates(
	std::size_t keyFrame, std::size_t end) const
{
	const double usual = keyFrame == 0 ? 0 : similarity(bags_[keyFrame], bags_[keyFrame - 1]);
	std::vector<std::size_t> result;
	for (const auto& [similarity, other] : index_.query(bags_[keyFrame], end))
	{
		if (similarity < options.minSimilarity * usual ||
			int(result.size()) >= options.maxCandidates)
			break;
		result.push_back(other);
	}
	return result;
}

void OrbLoopDetector::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& /*section*/)
{
	options.loadFromConfigFile(config, kSection);
}

void OrbLoopDetector::remember(const OrbFeatures&) {}

std::vector<std::size_t> OrbLoopDetector::candidates(std::size_t, std::size_t end) const
{
	std::vector<std::size_t> all(end);
	std::iota(all.begin(), all.end(), std::size_t(0));
	return all;
}

}  // namespace semloop

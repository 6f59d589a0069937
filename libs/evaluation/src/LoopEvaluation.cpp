#include <semloop/evaluation/AssociationAccuracy.h>
#include <semloop/evaluation/LoopEvaluation.h>

#include <algorithm>
#include <map>
#include <set>

namespace semloop
{
namespace
{
using TrueIds = std::set<uint32_t>;

bool shareMoreThan(std::size_t least, const TrueIds& a, const TrueIds& b)
{
	std::size_t common = 0;
	for (const auto id : a)
		if (b.count(id) > 0 && ++common > least) return true;
	return false;
}

/** What every frame observes. */
class Observed
{
public:
	Observed(const std::vector<RunFrame>& frames, const LoopRule& rule) : rule_(rule)
	{
		for (const RunFrame& frame : frames)
		{
			frames_.push_back({frame.frame, {}});
			for (const TrueBox& box : frame.truth)
				if (box.pixels >= rule.minimumPixels) frames_.back().second.insert(box.object);
		}
	}

	/** Of the frames in [first, last]. */
	TrueIds between(std::size_t first, std::size_t last) const
	{
		TrueIds all;
		for (const auto& [frame, ids] : frames_)
			if (frame >= first && frame <= last) all.insert(ids.begin(), ids.end());
		return all;
	}

	/** Whether a frame far enough before `frame`, and before `since`, observes enough of the ids. */
	bool wasSeenBefore(const TrueIds& ids, std::size_t frame, std::size_t since) const
	{
		if (ids.size() <= rule_.commonObjects) return false;
		for (const auto& [earlier, theirs] : frames_)
		{
			if (earlier + rule_.framesApart >= frame || earlier >= since) return false;
			if (shareMoreThan(rule_.commonObjects, ids, theirs)) return true;
		}
		return false;
	}

	/** These two frames are a loop. */
	bool isLoop(std::size_t frame, std::size_t earlier) const
	{
		return earlier + rule_.framesApart < frame &&
			   shareMoreThan(rule_.commonObjects, between(frame, frame), between(earlier, earlier));
	}

	/** First and last frame of every maximal run of frames that are a loop with an earlier one. */
	std::vector<std::pair<std::size_t, std::size_t>> places(std::size_t& loopFrames) const
	{
		std::vector<std::pair<std::size_t, std::size_t>> runs;
		bool inside = false;
		for (const auto& [frame, ids] : frames_)
		{
			const bool isLoop = wasSeenBefore(ids, frame, frame);
			if (isLoop && !inside) runs.emplace_back(frame, frame);
			if (isLoop) runs.back().second = frame;
			inside = isLoop;
			loopFrames += isLoop;
		}
		return runs;
	}

private:
	LoopRule rule_;
	std::vector<std::pair<std::size_t, TrueIds>> frames_;
};

/** Which real object an object of the map is, by the detections that it was made of. */
class Identities
{
public:
	explicit Identities(const std::vector<RunFrame>& frames)
	{
		for (const RunFrame& frame : frames)
			for (const auto& [j, k] : pairBoxes(frame.truth, frame.estimate))
				votes_[frame.estimate[k].firstObject].emplace_back(
					frame.frame, frame.truth[j].object);
	}

	std::optional<uint32_t> of(ObjectId object, std::size_t untilFrame) const
	{
		const auto votes = votes_.find(object);
		if (votes == votes_.end()) return std::nullopt;
		std::map<uint32_t, std::size_t> counts;
		for (const auto& [frame, truth] : votes->second)
			if (frame <= untilFrame) counts[truth]++;
		if (counts.empty()) return std::nullopt;
		const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
		return std::max_element(counts.begin(), counts.end(), fewer)->first;
	}

	bool mostAreRight(const LoopAttempt::IdPairs& pairs, std::size_t frame) const
	{
		std::size_t right = 0;
		for (const auto& [query, target] : pairs)
		{
			const auto truth = of(query, frame);
			right += truth && truth == of(target, frame);
		}
		return 2 * right > pairs.size();
	}

private:
	std::map<ObjectId, std::vector<std::pair<std::size_t, uint32_t>>> votes_;
};

void count(bool isTrue, LoopCount& counts)
{
	counts.detections++;
	(isTrue ? counts.truePositives : counts.falsePositives)++;
	counts.precision = double(counts.truePositives) / double(counts.detections);
}
}  // namespace

LoopEvaluation evaluateLoops(
	const std::vector<LoopAttempt>& attempts, const std::vector<RunFrame>& frames,
	const LoopRule& rule)
{
	const Observed observed(frames, rule);
	const Identities identities(frames);
	LoopEvaluation result;
	result.attempts = attempts.size();
	const auto places = observed.places(result.loopFrames);
	std::vector<char> found(places.size(), 0);
	const auto verify = [&](bool isTrue, const LoopAttempt& attempt)
	{
		count(isTrue, result.verified);
		for (std::size_t i = 0; isTrue && i < places.size(); i++)
			if (places[i].first <= attempt.frame && places[i].second >= attempt.localMapSince)
				found[i] = 1;
	};
	for (const LoopAttempt& attempt : attempts)
	{
		if (!attempt.detected && !attempt.accepted) continue;
		if (!attempt.cameras.empty())
		{
			const bool isTrue = std::all_of(
				attempt.cameras.begin(), attempt.cameras.end(),
				[&](const auto& pair) { return observed.isLoop(pair.first, pair.second); });
			count(isTrue, result.detected);
			if (attempt.accepted) verify(isTrue, attempt);
			continue;
		}
		const bool wasHere = observed.wasSeenBefore(
			observed.between(attempt.localMapSince, attempt.frame), attempt.frame,
			attempt.localMapSince);
		// Another detector may tell its result only.
		const auto& candidates = attempt.candidates.empty() ? attempt.matches : attempt.candidates;
		count(wasHere && identities.mostAreRight(candidates, attempt.frame), result.detected);
		if (!attempt.accepted) continue;
		verify(wasHere && identities.mostAreRight(attempt.matches, attempt.frame), attempt);
	}
	result.places = places.size();
	result.placesFound = std::size_t(std::count(found.begin(), found.end(), 1));
	if (!places.empty()) result.recall = double(result.placesFound) / double(result.places);
	return result;
}

}  // namespace semloop

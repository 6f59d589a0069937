#pragma once

#include <semloop/evaluation/LoopAttempts.h>
#include <semloop/evaluation/TrueFrames.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace semloop
{
/** Sec. IV-B: two frames are a loop when they observe more than commonObjects objects in common and
 *  are more than framesApart frames apart. */
struct LoopRule
{
	std::size_t commonObjects = 2;
	std::size_t framesApart = 500;
	std::size_t minimumPixels = 0;  //!< objects with a smaller mask are not observed
};

/** Loops that were claimed. */
struct LoopCount
{
	std::size_t detections = 0;
	std::size_t truePositives = 0;
	std::size_t falsePositives = 0;
	std::optional<double> precision;  //!< true positives / detections; empty without any
};

struct LoopEvaluation
{
	std::size_t attempts = 0;
	LoopCount detected;          //!< what the graph matcher found, by its candidates
	LoopCount verified;          //!< of these, what passed the verification, by its matches
	std::size_t loopFrames = 0;  //!< frames that are a loop with an earlier one
	/** Maximal runs of consecutive such frames: the camera is back where it was. */
	std::size_t places = 0;
	std::size_t placesFound = 0;   //!< with a frame of the local map of a verified true positive
	std::optional<double> recall;  //!< placesFound / places; empty without any
};

/** A claim is a true positive when
 *  (a) some frame, more than framesApart before the claim's and before the local map begins, observes
 *      more than commonObjects of the objects that the frames of the local map observe: the rule above,
 *      with the local map for the later frame, as it is the local map that is matched; and
 *  (b) more than half of the matched pairs are one real object. Which real object an object of the map
 *      was at the time is told by most of the detections that had founded or joined it until then; the
 *      smallest id when there are equally many, none when none of them is of a real object.
 *
 *  A claim by images, which names a pair of frames, is one when these two frames are a loop by that rule.
 *
 *  Frames in order, as joinWithTruth() gives them. */
LoopEvaluation evaluateLoops(
	const std::vector<LoopAttempt>& attempts, const std::vector<RunFrame>& frames,
	const LoopRule& rule = {});

}  // namespace semloop

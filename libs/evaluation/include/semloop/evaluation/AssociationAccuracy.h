#pragma once

#include <semloop/evaluation/TrueFrames.h>

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace semloop
{
/** Pairs (truth, estimate) of indices of boxes that overlap by at least minimumIou, one to one: as many
 *  as possible, and of these choices the one with the largest sum of overlaps. By truth. */
std::vector<std::pair<std::size_t, std::size_t>> pairBoxes(
	const std::vector<TrueBox>& truth, const std::vector<AssociationRecord>& estimate,
	double minimumIou = 0.5);

/** A true object and the object of the map that is taken for it. */
struct IdentityMatch
{
	uint32_t truth = 0;
	ObjectId estimate = 0;
	std::size_t sharedBoxes = 0;
};

/** How many detections went into the object that stands for the real one (Sec. IV-A, after Qian et al.,
 *  2021): the one-to-one assignment of true to estimated ids with the largest number of shared boxes. */
struct AssociationAccuracy
{
	std::size_t frames = 0;
	std::size_t trueBoxes = 0;
	std::size_t detectedBoxes = 0;             //!< of these, with a box of the estimate
	std::size_t correct = 0;                   //!< sum of the matches' shared boxes
	std::optional<double> accuracy;            //!< correct / trueBoxes; empty without any
	std::optional<double> accuracyOfDetected;  //!< correct / detectedBoxes; empty without any
	std::vector<IdentityMatch> matches;        //!< by true id
};

/** True boxes whose mask has fewer than minimumPixels are paired like the others, but do not count. */
AssociationAccuracy associationAccuracy(
	const std::vector<RunFrame>& frames, std::size_t minimumPixels = 0);

}  // namespace semloop

#pragma once

#include <semloop/association/ConfusionMatrix.h>

namespace semloop
{
/** p(l_k | l_j) of a map that takes observations by itself: no configuration of a run reaches it. */
inline ConfusionMatrix mapConfusion(const LabelSet& labels)
{
	constexpr double kCorrect = 0.8;
	return {labels, kCorrect};
}

}  // namespace semloop

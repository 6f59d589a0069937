#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/poses/CPose3D.h>
#include <semloop/object_map/SeenSides.h>
#include <semloop/object_map/TsdfVolume.h>
#include <semloop/observations/LabelSet.h>

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

namespace semloop
{
using ObjectId = uint64_t;

/** o_j = (V_j, T_wo_j, l_j, m_j, E_j) of the paper, Sec. III-B; m_j is computed when asked for
 *  (CObjectMap::predict). */
struct Object
{
	ObjectId id = 0;
	/** V_j. Shared between copies of a map until one of them writes (CObjectMap copies it then). */
	std::shared_ptr<TsdfVolume> volume;
	mrpt::poses::CPose3D T_world_object;  //!< centre; axes parallel to the world's when created
	LabelScores labelScores;              //!< l_j: mean of the matched detections' distributions
	std::vector<std::vector<float>> embeddings;  //!< E_j: bounded, the most different ones are kept
	int observations = 0;                        //!< frames fused
	SeenSides seenSides;                         //!< of its box
	int timesSeenThrough = 0;  //!< frames that looked at its place and saw something behind it
	/** p(the object is there), from hits and misses [0, 1] */
	double existence = 0.5;
	std::map<ObjectId, int> covisible;  //!< how often seen in the same local map
	mrpt::Clock::time_point firstSeen, lastSeen;

	uint32_t label() const { return labelScores.front().label; }
	/** Centre of the surface's box in the world; the object's origin while there is no surface. */
	mrpt::math::TPoint3D centre() const;
	/** Size of the surface's box along the object's axes [m]; zero while there is no surface. */
	mrpt::math::TVector3D extent() const;
};

}  // namespace semloop

#pragma once

#include <semloop/object_map/Object.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace semloop
{
/** A line of loops.jsonl, as far as it can be right or wrong. Ids are those of the time. */
struct LoopAttempt
{
	using IdPairs = std::vector<std::pair<ObjectId, ObjectId>>;

	std::size_t frame = 0;          //!< camera node
	std::size_t localMapSince = 0;  //!< camera node at which the local map begins
	bool detected = false;          //!< by the graph matcher, to be verified
	bool accepted = false;          //!< after the verification
	IdPairs candidates;             //!< (query, target) of the graph matcher
	IdPairs matches;                //!< those that the verification left
	std::vector<std::pair<std::size_t, std::size_t>>
		cameras;  //!< (query, target) frames, of images
};

/** Throws InputError naming file, line and what is wrong there. An empty file is a run that never
 *  tried. */
std::vector<LoopAttempt> readLoopAttempts(const std::string& path);

}  // namespace semloop

#pragma once

#include <semloop/evaluation/TrueFrames.h>

#include <cstddef>
#include <opencv2/core/types.hpp>
#include <utility>
#include <vector>

namespace semloop::fixtures
{
inline mrpt::Clock::time_point at(double seconds)
{
	return mrpt::Clock::fromDouble(1000 + seconds);
}

/** Ten boxes of 10 x 10 pixels beside each other. */
inline cv::Rect slot(int i)
{
	return {20 * i, 0, 10, 10};
}

inline AssociationRecord record(std::size_t frame, const cv::Rect& box, ObjectId object)
{
	AssociationRecord r;
	r.frame = frame;
	r.box = box;
	r.object = r.firstObject = object;
	return r;
}

/** Real object i in slot i, each seen with so many pixels. */
inline std::vector<TrueBox> trueBoxes(
	const std::vector<uint32_t>& objects, std::size_t pixels = 100)
{
	std::vector<TrueBox> boxes;
	for (const auto object : objects) boxes.push_back({object, slot(int(object)), pixels});
	return boxes;
}

/** A frame with these (real object, object of the map) pairs, each pair of boxes identical. */
inline RunFrame frameWith(
	std::size_t frame, const std::vector<std::pair<uint32_t, ObjectId>>& pairs)
{
	RunFrame result;
	result.frame = frame;
	for (const auto& [truth, estimate] : pairs)
	{
		result.truth.push_back({truth, slot(int(truth)), 100});
		result.estimate.push_back(record(frame, slot(int(truth)), estimate));
	}
	return result;
}

}  // namespace semloop::fixtures

#pragma once

#include <semloop/loop_closure/OrbVocabulary.h>

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace semloop
{
/** Which images have a word: similarities to all images take the time of the words in common. */
class InvertedIndex
{
public:
	/** Images are numbered in the order in which they come. */
	void add(const BagOfWords& image);
	std::size_t size() const { return images_; }

	/** (similarity, image) of those before `end` that have a word in common, most similar first. */
	std::vector<std::pair<double, std::size_t>> query(
		const BagOfWords& image, std::size_t end) const;

private:
	std::map<std::uint32_t, std::vector<std::pair<std::size_t, float>>> imagesWith_;
	std::size_t images_ = 0;
};

}  // namespace semloop

#include <semloop/loop_closure/InvertedIndex.h>

#include <algorithm>

namespace semloop
{
void InvertedIndex::add(const BagOfWords& image)
{
	for (const auto& [word, weight] : image) imagesWith_[word].emplace_back(images_, weight);
	++images_;
}

std::vector<std::pair<double, std::size_t>> InvertedIndex::query(
	const BagOfWords& image, std::size_t end) const
{
	std::vector<double> sums(std::min(end, images_), 0.0);
	for (const auto& [word, weight] : image)
	{
		const auto found = imagesWith_.find(word);
		if (found == imagesWith_.end()) continue;
		for (const auto& [other, theirs] : found->second)
		{
			if (other >= sums.size()) break;
			sums[other] += double(std::min(weight, theirs));
		}
	}
	std::vector<std::pair<double, std::size_t>> result;
	for (std::size_t i = 0; i < sums.size(); ++i)
		if (sums[i] > 0) result.emplace_back(sums[i], i);
	std::stable_sort(
		result.begin(), result.end(),
		[](const auto& a, const auto& b) { return a.first > b.first; });
	return result;
}

}  // namespace semloop

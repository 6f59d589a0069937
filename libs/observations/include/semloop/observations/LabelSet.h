#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace semloop
{
/** The classes that a network knows, in its order of outputs. */
class LabelSet
{
public:
	LabelSet() = default;
	/** Throws InputError on an empty or repeated name. */
	explicit LabelSet(std::vector<std::string> names);

	/** The 80 classes of Microsoft COCO (Lin et al., ECCV 2014) in the order of its detection task. */
	static LabelSet coco();
	/** One name a line; blank lines and lines beginning with # are passed over. */
	static LabelSet fromFile(const std::string& path);

	std::size_t size() const { return names_.size(); }
	const std::vector<std::string>& names() const { return names_; }
	/** Throws std::out_of_range. */
	const std::string& name(std::size_t label) const { return names_.at(label); }
	std::optional<std::size_t> find(const std::string& name) const;

	bool operator==(const LabelSet& o) const { return names_ == o.names_; }

private:
	std::vector<std::string> names_;
};

/** How probable a label is; a distribution is a vector of these with positive scores, each label
 *  at most once, highest first; the rest up to 1 is "anything else". */
struct LabelScore
{
	uint32_t label = 0;  //!< index in a LabelSet
	float score = 0;     //!< in [0, 1]
	bool operator==(const LabelScore& o) const { return label == o.label && score == o.score; }
};
using LabelScores = std::vector<LabelScore>;

}  // namespace semloop

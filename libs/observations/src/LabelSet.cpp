#include <semloop/config/Error.h>
#include <semloop/observations/LabelSet.h>

#include <algorithm>
#include <fstream>
#include <unordered_map>

namespace semloop
{
namespace
{
std::string trimmed(const std::string& line)
{
	const char* const blank = " \t\r\n";
	const auto first = line.find_first_not_of(blank);
	if (first == std::string::npos) return {};
	return line.substr(first, line.find_last_not_of(blank) - first + 1);
}
}  // namespace

LabelSet::LabelSet(std::vector<std::string> names) : names_(std::move(names))
{
	std::unordered_map<std::string, std::size_t> seen;
	for (std::size_t i = 0; i < names_.size(); i++)
	{
		if (names_[i].empty()) throw InputError("label " + std::to_string(i) + " has no name");
		const auto [other, isNew] = seen.emplace(names_[i], i);
		if (!isNew)
			throw InputError(
				"labels " + std::to_string(other->second) + " and " + std::to_string(i) +
				" are both named '" + names_[i] + "'");
	}
}

LabelSet LabelSet::coco()
{
	return LabelSet({"person",        "bicycle",      "car",
					 "motorcycle",    "airplane",     "bus",
					 "train",         "truck",        "boat",
					 "traffic light", "fire hydrant", "stop sign",
					 "parking meter", "bench",        "bird",
					 "cat",           "dog",          "horse",
					 "sheep",         "cow",          "elephant",
					 "bear",          "zebra",        "giraffe",
					 "backpack",      "umbrella",     "handbag",
					 "tie",           "suitcase",     "frisbee",
					 "skis",          "snowboard",    "sports ball",
					 "kite",          "baseball bat", "baseball glove",
					 "skateboard",    "surfboard",    "tennis racket",
					 "bottle",        "wine glass",   "cup",
					 "fork",          "knife",        "spoon",
					 "bowl",          "banana",       "apple",
					 "sandwich",      "orange",       "broccoli",
					 "carrot",        "hot dog",      "pizza",
					 "donut",         "cake",         "chair",
					 "couch",         "potted plant", "bed",
					 "dining table",  "toilet",       "tv",
					 "laptop",        "mouse",        "remote",
					 "keyboard",      "cell phone",   "microwave",
					 "oven",          "toaster",      "sink",
					 "refrigerator",  "book",         "clock",
					 "vase",          "scissors",     "teddy bear",
					 "hair drier",    "toothbrush"});
}

LabelSet LabelSet::fromFile(const std::string& path)
{
	std::ifstream in(path);
	if (!in) throw InputError(path + ": cannot be read: give a text file with one label a line");

	std::vector<std::string> names;
	for (std::string line; std::getline(in, line);)
	{
		const std::string name = trimmed(line);
		if (!name.empty() && name.front() != '#') names.push_back(name);
	}
	if (in.bad() || names.empty())
		throw InputError(path + ": holds no label: write one name a line");
	try
	{
		return LabelSet(std::move(names));
	}
	catch (const InputError& e)
	{
		throw InputError(path + ": " + e.what());
	}
}

std::optional<std::size_t> LabelSet::find(const std::string& name) const
{
	const auto it = std::find(names_.begin(), names_.end(), name);
	if (it == names_.end()) return std::nullopt;
	return std::size_t(it - names_.begin());
}

}  // namespace semloop

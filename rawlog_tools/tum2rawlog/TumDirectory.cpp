#include "TumDirectory.h"

#include <semloop/config/Error.h>
#include <semloop/observations/UnixTime.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <tuple>

namespace semloop
{
namespace
{
namespace fs = std::filesystem;
using Words = std::vector<std::string>;

Words split(const std::string& line)
{
	std::istringstream in(line);
	Words words;
	for (std::string word; in >> word;) words.push_back(word);
	return words;
}

/** Calls use(words) for each line that is not a comment; what it throws gets file and line. */
void forEachLine(
	const std::string& path, std::size_t columns, const std::function<void(const Words&)>& use)
{
	std::ifstream in(path);
	if (!in) throw InputError(path + ": cannot be read");
	std::size_t number = 0;
	for (std::string line; std::getline(in, line);)
	{
		number++;
		const Words words = split(line);
		if (words.empty() || words.front().front() == '#') continue;
		try
		{
			if (words.size() != columns)
				throw InputError(
					std::to_string(words.size()) + " columns where " + std::to_string(columns) +
					" are needed");
			use(words);
		}
		catch (const InputError& e)
		{
			throw InputError(path + ":" + std::to_string(number) + ": " + e.what());
		}
	}
}

mrpt::Clock::time_point requireTime(const std::string& text)
{
	const auto time = parseUnixTime(text);
	if (!time) throw InputError("'" + text + "' is not a time in seconds");
	return *time;
}

double requireNumber(const std::string& text)
{
	double value = 0;
	const char* const last = text.data() + text.size();
	const auto [end, error] = std::from_chars(text.data(), last, value);
	if (error != std::errc() || end != last || !std::isfinite(value))
		throw InputError("'" + text + "' is not a number");
	return value;
}

template <typename T>
void sortByTime(std::vector<T>& items)
{
	std::stable_sort(
		items.begin(), items.end(), [](const T& a, const T& b) { return a.time < b.time; });
}

std::vector<TumImage> readImageList(const fs::path& folder, const std::string& name)
{
	const std::string path = (folder / name).string();
	if (!fs::is_regular_file(path))
		throw InputError(
			path +
			": not there: give the folder of an unpacked TUM RGB-D sequence, with rgb.txt "
			"and depth.txt");
	std::vector<TumImage> images;
	forEachLine(
		path, 2,
		[&](const Words& words) {
			images.push_back({requireTime(words[0]), (folder / words[1]).string()});
		});
	if (images.empty()) throw InputError(path + ": lists no image");
	sortByTime(images);
	return images;
}

std::vector<TumAcceleration> readAccelerations(const std::string& path)
{
	std::vector<TumAcceleration> all;
	forEachLine(
		path, 4,
		[&](const Words& words)
		{
			all.push_back(
				{requireTime(words[0]),
				 {requireNumber(words[1]), requireNumber(words[2]), requireNumber(words[3])}});
		});
	sortByTime(all);
	return all;
}

}  // namespace

TumDirectory readTumDirectory(const std::string& path)
{
	const fs::path folder(path);
	if (!fs::is_directory(folder))
		throw InputError(path + ": no such folder: give that of a TUM RGB-D sequence");
	TumDirectory directory;
	directory.color = readImageList(folder, "rgb.txt");
	directory.depth = readImageList(folder, "depth.txt");
	const std::string accelerometer = (folder / "accelerometer.txt").string();
	if (fs::exists(accelerometer)) directory.accelerations = readAccelerations(accelerometer);
	const std::string groundTruth = (folder / "groundtruth.txt").string();
	if (fs::exists(groundTruth)) directory.groundTruthPath = groundTruth;
	return directory;
}

std::vector<TumPair> pairByTime(
	const std::vector<TumImage>& color, const std::vector<TumImage>& depth, double maxDifference)
{
	const auto reach =
		mrpt::Clock::duration(std::llround(maxDifference * double(mrpt::Clock::period::den)));
	struct Candidate
	{
		mrpt::Clock::duration difference;
		TumPair pair;
	};
	std::vector<Candidate> candidates;
	for (std::size_t c = 0; c < color.size(); c++)
	{
		const auto first = std::lower_bound(
			depth.begin(), depth.end(), color[c].time - reach,
			[](const TumImage& image, mrpt::Clock::time_point t) { return image.time < t; });
		for (auto d = first; d != depth.end() && d->time <= color[c].time + reach; ++d)
			candidates.push_back(
				{std::chrono::abs(d->time - color[c].time), {c, std::size_t(d - depth.begin())}});
	}
	std::sort(
		candidates.begin(), candidates.end(),
		[](const Candidate& a, const Candidate& b)
		{
			return std::tie(a.difference, a.pair.color, a.pair.depth) <
				   std::tie(b.difference, b.pair.color, b.pair.depth);
		});

	std::vector<bool> colorTaken(color.size()), depthTaken(depth.size());
	std::vector<TumPair> pairs;
	for (const Candidate& candidate : candidates)
	{
		const auto [c, d] = candidate.pair;
		if (colorTaken[c] || depthTaken[d]) continue;
		colorTaken[c] = depthTaken[d] = true;
		pairs.push_back(candidate.pair);
	}
	std::sort(
		pairs.begin(), pairs.end(),
		[](const TumPair& a, const TumPair& b) { return a.color < b.color; });
	return pairs;
}

}  // namespace semloop

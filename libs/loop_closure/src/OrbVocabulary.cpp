#include <mrpt/core/bits_math.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/serialization/CArchive.h>
#include <semloop/config/Error.h>
#include <semloop/loop_closure/OrbVocabulary.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <random>
#include <stdexcept>

namespace semloop
{
namespace
{
constexpr int kBytes = 32;
constexpr const char* kMagic = "semloop.orb-vocabulary/1";
constexpr std::uint32_t kMostNodes = 100'000'000;

int distance(const std::uint8_t* a, const std::uint8_t* b)
{
	int bits = 0;
	for (int i = 0; i < kBytes; i += 8)
	{
		std::uint64_t x, y;
		std::memcpy(&x, a + i, 8);
		std::memcpy(&y, b + i, 8);
		bits += __builtin_popcountll(x ^ y);
	}
	return bits;
}

using Descriptor = std::array<std::uint8_t, kBytes>;
using Descriptors = std::vector<const std::uint8_t*>;

Descriptor majority(const Descriptors& members)
{
	std::array<std::size_t, 8 * kBytes> counts{};
	for (const auto* member : members)
		for (std::size_t bit = 0; bit < counts.size(); ++bit)
			counts[bit] += (member[bit / 8] >> (bit % 8)) & 1;
	Descriptor result{};
	for (std::size_t bit = 0; bit < counts.size(); ++bit)
		if (2 * counts[bit] > members.size())
			result[bit / 8] = std::uint8_t(result[bit / 8] | (1 << (bit % 8)));
	return result;
}

std::size_t nearest(const std::vector<Descriptor>& centres, const std::uint8_t* descriptor)
{
	std::size_t best = 0;
	int least = 8 * kBytes + 1;
	for (std::size_t c = 0; c < centres.size(); ++c)
		if (const int d = distance(centres[c].data(), descriptor); d < least) least = d, best = c;
	return best;
}

/** k-means++: each next centre with a probability proportional to the squared distance from those chosen. */
std::vector<Descriptor> seeds(const Descriptors& all, int count, std::mt19937& random)
{
	std::vector<Descriptor> centres;
	std::vector<std::int64_t> least(all.size(), std::int64_t(mrpt::square(8 * kBytes + 1)));
	const auto take = [&](std::size_t chosen)
	{
		auto& centre = centres.emplace_back();
		std::copy_n(all[chosen], kBytes, centre.begin());
		for (std::size_t i = 0; i < all.size(); ++i)
			least[i] = std::min<std::int64_t>(
				least[i], mrpt::square(std::int64_t(distance(all[i], centre.data()))));
	};
	take(random() % all.size());
	while (int(centres.size()) < count)
	{
		std::int64_t sum = 0;
		for (const auto value : least) sum += value;
		if (sum == 0) break;  // all are the same as some centre
		// Not std::uniform_int_distribution: libraries differ in it.
		const std::uint64_t high = random(), low = random();
		auto left = std::int64_t(((high << 32) | low) % std::uint64_t(sum));
		std::size_t chosen = 0;
		while (left >= least[chosen]) left -= least[chosen++];
		take(chosen);
	}
	return centres;
}

struct Cluster
{
	Descriptor centre;
	Descriptors members;
};

std::vector<Cluster> cluster(
	const Descriptors& all, const OrbVocabularyOptions& options, std::mt19937& random)
{
	auto centres = seeds(all, options.branching, random);
	std::vector<std::size_t> of(all.size(), centres.size());
	std::vector<Cluster> clusters;
	for (int iteration = 0; iteration < options.iterations; ++iteration)
	{
		bool changed = false;
		clusters.assign(centres.size(), {});
		for (std::size_t i = 0; i < all.size(); ++i)
		{
			const std::size_t now = nearest(centres, all[i]);
			changed = changed || now != of[i];
			of[i] = now;
			clusters[now].members.push_back(all[i]);
		}
		for (std::size_t c = 0; c < centres.size(); ++c)
		{
			if (!clusters[c].members.empty()) centres[c] = majority(clusters[c].members);
			clusters[c].centre = centres[c];
		}
		if (!changed) break;
	}
	clusters.erase(
		std::remove_if(
			clusters.begin(), clusters.end(), [](const auto& c) { return c.members.empty(); }),
		clusters.end());
	return clusters;
}

void requireDescriptors(const cv::Mat& descriptors)
{
	if (!descriptors.empty() && (descriptors.type() != CV_8UC1 || descriptors.cols != kBytes))
		throw std::invalid_argument("ORB vocabulary: descriptors are 32 bytes each");
}
}  // namespace

OrbVocabulary OrbVocabulary::train(
	const std::vector<cv::Mat>& images, const OrbVocabularyOptions& options)
{
	if (options.branching < 2 || options.branching > 100 || options.levels < 1 ||
		options.levels > 8 || options.iterations < 1)
		throw std::invalid_argument("ORB vocabulary: branching, levels or iterations out of range");
	Descriptors all;
	for (const cv::Mat& image : images)
	{
		requireDescriptors(image);
		for (int row = 0; row < image.rows; ++row) all.push_back(image.ptr(row));
	}
	if (images.size() < 2 || int(all.size()) < options.branching)
		throw InputError(
			std::to_string(all.size()) + " descriptors in " + std::to_string(images.size()) +
			" images are too few for a vocabulary of branching " +
			std::to_string(options.branching) + "; give more images, or images with texture");

	OrbVocabulary result;
	std::mt19937 random(options.seed);
	std::vector<Descriptor> centres{Descriptor{}};
	result.nodes_.emplace_back();
	std::vector<std::pair<std::size_t, Descriptors>> level{{0, std::move(all)}};
	for (int depth = 0; depth < options.levels; ++depth)
	{
		decltype(level) next;
		for (auto& [node, members] : level)
		{
			if (members.size() < 2) continue;
			auto clusters = cluster(members, options, random);
			if (clusters.size() < 2) continue;
			result.nodes_[node].firstChild = std::uint32_t(result.nodes_.size());
			result.nodes_[node].children = std::uint32_t(clusters.size());
			for (auto& c : clusters)
			{
				next.emplace_back(result.nodes_.size(), std::move(c.members));
				result.nodes_.emplace_back();
				centres.push_back(c.centre);
			}
		}
		level = std::move(next);
	}
	result.centres_.create(int(centres.size()), kBytes, CV_8UC1);
	for (std::size_t i = 0; i < centres.size(); ++i)
		std::copy(centres[i].begin(), centres[i].end(), result.centres_.ptr(int(i)));
	result.numberWords();

	std::vector<std::size_t> imagesWith(result.words_, 0);
	for (const cv::Mat& image : images)
	{
		std::vector<std::uint32_t> words;
		for (int row = 0; row < image.rows; ++row) words.push_back(result.word(image.ptr(row)));
		std::sort(words.begin(), words.end());
		words.erase(std::unique(words.begin(), words.end()), words.end());
		for (const auto word : words) ++imagesWith[word];
	}
	for (const std::size_t count : imagesWith)
		result.idf_.push_back(
			float(std::log(double(images.size()) / double(std::max<std::size_t>(1, count)))));
	return result;
}

void OrbVocabulary::numberWords()
{
	words_ = 0;
	for (Node& node : nodes_)
		if (node.children == 0) node.word = std::uint32_t(words_++);
}

std::uint32_t OrbVocabulary::word(const std::uint8_t* descriptor) const
{
	std::size_t at = 0;
	while (nodes_[at].children > 0)
	{
		std::size_t best = 0;
		int least = 8 * kBytes + 1;
		for (std::size_t child = nodes_[at].firstChild;
			 child < nodes_[at].firstChild + nodes_[at].children; ++child)
			if (const int d = distance(centres_.ptr(int(child)), descriptor); d < least)
				least = d, best = child;
		at = best;
	}
	return nodes_[at].word;
}

BagOfWords OrbVocabulary::describe(const cv::Mat& descriptors) const
{
	requireDescriptors(descriptors);
	std::map<std::uint32_t, double> weights;
	double sum = 0;
	for (int row = 0; row < descriptors.rows; ++row)
	{
		const std::uint32_t w = word(descriptors.ptr(row));
		if (idf_[w] <= 0) continue;
		weights[w] += double(idf_[w]);
		sum += double(idf_[w]);
	}
	BagOfWords result;
	for (const auto& [w, weight] : weights) result.emplace_back(w, float(weight / sum));
	return result;
}

double similarity(const BagOfWords& v, const BagOfWords& w)
{
	double sum = 0;
	for (auto a = v.begin(), b = w.begin(); a != v.end() && b != w.end();)
	{
		if (a->first == b->first)
			sum += double(std::min((a++)->second, (b++)->second));
		else
			a->first < b->first ? ++a : ++b;
	}
	return sum;
}

void OrbVocabulary::save(const std::string& path) const
{
	const std::string partial = path + ".part";
	const auto fail = [&]() -> void
	{
		std::error_code ignored;
		std::filesystem::remove(partial, ignored);
		throw InputError(path + ": cannot be written; check folder, rights and free space");
	};
	try
	{
		mrpt::io::CFileGZOutputStream file;
		if (!file.open(partial)) fail();
		auto archive = mrpt::serialization::archiveFrom(file);
		archive << std::string(kMagic) << std::uint32_t(nodes_.size());
		for (const Node& node : nodes_) archive << node.firstChild << node.children;
		archive.WriteBuffer(centres_.data, centres_.total());
		for (const float value : idf_) archive << value;
	}
	catch (const std::exception&)
	{
		fail();
	}
	std::error_code error;
	std::filesystem::rename(partial, path, error);
	if (error) fail();
}

OrbVocabulary OrbVocabulary::load(const std::string& path)
{
	const auto fail = [&](const std::string& what) -> void
	{ throw InputError(path + ": " + what + "; make one with rawlog-train-vocabulary"); };
	mrpt::io::CFileGZInputStream file;
	if (!std::filesystem::is_regular_file(path) || !file.open(path)) fail("cannot be read");
	OrbVocabulary result;
	try
	{
		auto archive = mrpt::serialization::archiveFrom(file);
		// Its length comes first; what is no vocabulary may claim any.
		std::uint32_t length = 0;
		archive >> length;
		std::string magic(length == std::strlen(kMagic) ? length : 0, ' ');
		archive.ReadBuffer(magic.data(), magic.size());
		if (magic != kMagic) fail("is not an ORB vocabulary");
		std::uint32_t count = 0;
		archive >> count;
		if (count < 3 || count > kMostNodes) fail("is damaged");
		for (std::uint32_t i = 0, next = 1; i < count; ++i)
		{
			Node node;
			archive >> node.firstChild >> node.children;
			if (node.children > 0 &&
				(node.firstChild != next || node.children < 2 || node.children > count - next))
				fail("is damaged");
			next += node.children;
			if (i + 1 == count && next != count) fail("is damaged");
			result.nodes_.push_back(node);
		}
		result.numberWords();
		result.centres_.create(int(count), kBytes, CV_8UC1);
		archive.ReadBuffer(result.centres_.data, result.centres_.total());
		for (std::size_t i = 0; i < result.words_; ++i)
		{
			float value = 0;
			archive >> value;
			if (!std::isfinite(value) || value < 0) fail("is damaged");
			result.idf_.push_back(value);
		}
	}
	catch (const InputError&)
	{
		throw;
	}
	catch (const std::exception&)
	{
		fail("was cut or is damaged");
	}
	return result;
}

}  // namespace semloop

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/loop_closure/InvertedIndex.h>
#include <semloop/loop_closure/OrbVocabulary.h>

#include <bitset>
#include <cmath>
#include <fstream>
#include <random>

#include "TemporaryFolder.h"

namespace
{
using namespace semloop;
using testing::HasSubstr;

/** Rows of 32 equal bytes. */
cv::Mat descriptors(const std::vector<int>& bytes)
{
	cv::Mat result(int(bytes.size()), 32, CV_8UC1);
	for (int row = 0; row < result.rows; ++row) result.row(row).setTo(bytes[std::size_t(row)]);
	return result;
}

/** Round `centres` random descriptors, a twentieth of the bits changed. */
std::vector<cv::Mat> randomImages(int images, int features, int centres)
{
	std::mt19937 random(7);
	cv::Mat places(centres, 32, CV_8UC1);
	for (int i = 0; i < centres * 32; ++i) places.data[i] = std::uint8_t(random());
	std::vector<cv::Mat> result;
	for (int image = 0; image < images; ++image)
	{
		cv::Mat rows(features, 32, CV_8UC1);
		for (int row = 0; row < features; ++row)
		{
			// Of each image other centres, some common to all.
			const int centre =
				int(random() % 2 ? (unsigned(image) * 3 + random() % 5) : random()) % centres;
			places.row(std::abs(centre)).copyTo(rows.row(row));
			for (int flip = 0; flip < 12; ++flip)
			{
				const auto bit = random() % 256;
				rows.at<std::uint8_t>(row, int(bit / 8)) ^= std::uint8_t(1 << (bit % 8));
			}
		}
		result.push_back(rows);
	}
	return result;
}

int hamming(const std::uint8_t* a, const std::uint8_t* b)
{
	int bits = 0;
	for (int i = 0; i < 32; ++i) bits += int(std::bitset<8>(a[i] ^ b[i]).count());
	return bits;
}

OrbVocabularyOptions smallTree(int branching, int levels)
{
	OrbVocabularyOptions options;
	options.branching = branching;
	options.levels = levels;
	return options;
}

TEST(OrbVocabulary, WeighsWordsByFrequencyAndRarity)
{
	// Three words: 0x00 is in all four images, 0x0f in two, 0xff in one.
	const std::vector<cv::Mat> images{
		descriptors({0, 0, 0x0f}), descriptors({0, 0x0f}), descriptors({0, 0xff, 0xff}),
		descriptors({0})};
	const auto vocabulary = OrbVocabulary::train(images, smallTree(3, 1));
	ASSERT_EQ(vocabulary.words(), 3u);
	const auto wordOf = [&](int byte) { return vocabulary.word(descriptors({byte}).data); };
	EXPECT_NEAR(vocabulary.idf(wordOf(0)), 0, 1e-6);
	EXPECT_NEAR(vocabulary.idf(wordOf(0x0f)), std::log(2.0), 1e-6);
	EXPECT_NEAR(vocabulary.idf(wordOf(0xff)), std::log(4.0), 1e-6);
	// A word with a changed bit is still that word.
	auto changed = descriptors({0xff});
	changed.at<std::uint8_t>(0, 5) = 0xfe;
	EXPECT_EQ(vocabulary.word(changed.data), wordOf(0xff));

	// 2 ln 2 : 1 ln 4 are equal halves.
	const auto bag = vocabulary.describe(descriptors({0, 0x0f, 0x0f, 0xff}));
	ASSERT_EQ(bag.size(), 2u);
	EXPECT_NEAR(bag[0].second, 0.5, 1e-6);
	EXPECT_NEAR(bag[1].second, 0.5, 1e-6);
	EXPECT_TRUE(vocabulary.describe(descriptors({0, 0})).empty()) << "what all images have";
	EXPECT_TRUE(vocabulary.describe({}).empty());

	const auto one = vocabulary.describe(descriptors({0x0f}));
	EXPECT_NEAR(similarity(bag, one), 0.5, 1e-6);
	EXPECT_NEAR(similarity(bag, bag), 1, 1e-6);
	EXPECT_EQ(similarity(bag, {}), 0);
}

TEST(OrbVocabulary, TheTreeFindsNearlyTheNearestCentre)
{
	const auto images = randomImages(20, 100, 30);
	const auto vocabulary = OrbVocabulary::train(images, smallTree(4, 4));
	EXPECT_GE(vocabulary.words(), 30u);
	// Descriptors of one centre differ in at most 24 bits, those of two in about 128: hardly a word has two.
	std::size_t pairs = 0, sameWord = 0, mixed = 0;
	for (const cv::Mat& a : images)
		for (const cv::Mat& b : images)
			for (int row = 0; row < 20; ++row)
			{
				const bool sameCentre = hamming(a.ptr(row), b.ptr(row)) < 64;
				const bool oneWord = vocabulary.word(a.ptr(row)) == vocabulary.word(b.ptr(row));
				mixed += oneWord && !sameCentre;
				pairs += sameCentre;
				sameWord += oneWord && sameCentre;
			}
	EXPECT_EQ(mixed, 0u);
	EXPECT_GT(double(sameWord), 0.3 * double(pairs));
}

TEST(OrbVocabulary, TheSameImagesGiveTheSameFile)
{
	const TemporaryFolder folder;
	const auto images = randomImages(10, 60, 20);
	OrbVocabulary::train(images, smallTree(5, 3)).save(folder.file("a"));
	OrbVocabulary::train(images, smallTree(5, 3)).save(folder.file("b"));
	EXPECT_EQ(readBytes(folder.file("a")), readBytes(folder.file("b")));

	const auto trained = OrbVocabulary::train(images, smallTree(5, 3));
	const auto loaded = OrbVocabulary::load(folder.file("a"));
	ASSERT_EQ(loaded.words(), trained.words());
	for (const auto& image : images) EXPECT_EQ(loaded.describe(image), trained.describe(image));
}

TEST(OrbVocabulary, RefusesFilesThatAreNone)
{
	const TemporaryFolder folder;
	const auto message = [&](const std::string& path)
	{ return messageOf<InputError>([&] { OrbVocabulary::load(path); }); };
	EXPECT_THAT(message(folder.file("none")), HasSubstr("none: cannot be read"));
	EXPECT_THAT(message(folder.path().string()), HasSubstr("cannot be read"));

	std::ofstream(folder.file("text")) << "not a vocabulary, but long enough to be read as one";
	EXPECT_THAT(message(folder.file("text")), HasSubstr("is not an ORB vocabulary"));
	OrbVocabulary::train(randomImages(10, 60, 20), smallTree(5, 3)).save(folder.file("good"));
	const auto bytes = readBytes(folder.file("good"));
	for (const double share : {0.01, 0.3, 0.9})
	{
		std::ofstream(folder.file("cut"), std::ios::binary)
			<< bytes.substr(0, std::size_t(double(bytes.size()) * share));
		EXPECT_THAT(message(folder.file("cut")), HasSubstr("rawlog-train-vocabulary"));
	}
	EXPECT_THROW(OrbVocabulary::load(folder.file("cut")), InputError);
	EXPECT_THROW(
		OrbVocabulary::train(randomImages(2, 5, 3), smallTree(10, 2)).save("/nowhere/at/all"),
		InputError);
}

TEST(OrbVocabulary, TooLittleToLearnFromIsAnError)
{
	EXPECT_THAT(
		messageOf<InputError>(
			[] {
				OrbVocabulary::train({descriptors({1, 2})}, smallTree(10, 2));
			}),
		HasSubstr("2 descriptors in 1 images"));
	EXPECT_THROW(
		OrbVocabulary::train(randomImages(3, 20, 5), smallTree(1, 2)), std::invalid_argument);
	// All descriptors alike: one word, in every image.
	const std::vector<cv::Mat> same(5, descriptors({3, 3, 3}));
	EXPECT_TRUE(OrbVocabulary::train(same, smallTree(2, 2)).describe(same[0]).empty());
}

TEST(InvertedIndex, SaysWhatComparingAllSays)
{
	const auto images = randomImages(40, 60, 50);
	const auto vocabulary = OrbVocabulary::train(images, smallTree(5, 4));
	InvertedIndex index;
	std::vector<BagOfWords> bags;
	for (const auto& image : images)
	{
		bags.push_back(vocabulary.describe(image));
		index.add(bags.back());
	}
	for (std::size_t q = 0; q < bags.size(); ++q)
	{
		const std::size_t end = 25;
		std::map<std::size_t, double> expected;
		for (std::size_t other = 0; other < end; ++other)
			if (const double s = similarity(bags[q], bags[other]); s > 0) expected[other] = s;
		const auto found = index.query(bags[q], end);
		ASSERT_EQ(found.size(), expected.size());
		for (std::size_t i = 0; i < found.size(); ++i)
		{
			EXPECT_NEAR(found[i].first, expected.at(found[i].second), 1e-6);
			EXPECT_GE(found[i == 0 ? 0 : i - 1].first, found[i].first);
		}
	}
	EXPECT_EQ(index.query(bags[7], bags.size())[0].second, 7u);
}
}  // namespace

#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/rtti/CObject.h>
#include <mrpt/serialization/CArchive.h>
#include <semloop/config/Error.h>
#include <semloop/observations/CObservationInstances.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <random>
#include <sstream>

#include "TemporaryFolder.h"

using mrpt::io::CMemoryStream;
using semloop::CObservationInstances;
using semloop::InputError;
using semloop::Instance;
using semloop::InstanceMask;
using semloop::LabelSet;

namespace
{
std::vector<float> unitVector(std::mt19937& random, std::size_t size)
{
	std::normal_distribution<float> normal;
	std::vector<float> v(size);
	for (auto& x : v) x = normal(random);
	const double norm = cv::norm(v);
	for (auto& x : v) x = float(x / norm);
	return v;
}

Instance randomInstance(std::mt19937& random, cv::Size image)
{
	std::uniform_int_distribution<int> x(0, image.width - 30), y(0, image.height - 20);
	Instance instance;
	instance.box = {x(random), y(random), 30, 20};
	cv::Mat mask(instance.box.size(), CV_8UC1);
	cv::Mat depth(instance.box.size(), CV_16UC1);
	cv::RNG fill(random());
	fill.fill(mask, cv::RNG::UNIFORM, 0, 2);
	fill.fill(depth, cv::RNG::UNIFORM, 0, 65536);
	instance.mask = InstanceMask::encode(mask, instance.box.tl(), image);
	instance.labelScores = {{56, 0.75f}, {57, 0.2f}};
	instance.confidence = 0.875f;
	instance.embedding = unitVector(random, 1024);
	instance.depth = semloop::DepthCrop{depth, 0.0002f};
	return instance;
}

CObservationInstances example(int count = 3)
{
	CObservationInstances o;
	o.timestamp = mrpt::Clock::fromDouble(1305031453.374112);
	o.sensorLabel = "RGBD";
	o.camera.ncols = 160;
	o.camera.nrows = 120;
	o.camera.setIntrinsicParamsFromValues(130, 131, 80, 60);
	o.camera.setDistortionPlumbBob(0.1, -0.2, 0.003, 0.004, 0.5);
	o.sensorPose = mrpt::poses::CPose3D::FromXYZYawPitchRoll(1, 2, 3, 0.1, 0.2, 0.3);
	o.labels = LabelSet::coco();
	std::mt19937 random(7);
	for (int i = 0; i < count; i++) o.instances.push_back(randomInstance(random, o.imageSize()));
	return o;
}

std::string bytesOf(const CObservationInstances& o)
{
	CMemoryStream stream;
	mrpt::serialization::archiveFrom(stream).WriteObject(&o);
	return {
		static_cast<const char*>(stream.getRawBufferData()),
		std::size_t(stream.getTotalBytesCount())};
}

CObservationInstances::Ptr fromBytes(const std::string& bytes)
{
	CMemoryStream stream;
	stream.Write(bytes.data(), bytes.size());
	stream.Seek(0);
	return std::dynamic_pointer_cast<CObservationInstances>(
		mrpt::serialization::archiveFrom(stream).ReadObject());
}

std::string errorAfter(const std::function<void(CObservationInstances&)>& damage)
{
	auto o = example();
	damage(o);
	return semloop::messageOf<InputError>([&] { o.validate(); });
}

}  // namespace

TEST(CObservationInstances, ComesBackAsItWasWritten)
{
	const auto written = example();
	const auto read = fromBytes(bytesOf(written));
	ASSERT_TRUE(read);
	EXPECT_EQ(read->timestamp, written.timestamp);
	EXPECT_EQ(read->sensorLabel, written.sensorLabel);
	EXPECT_TRUE(read->camera == written.camera);
	EXPECT_EQ(read->sensorPose, written.sensorPose);
	EXPECT_EQ(read->labels, written.labels);
	ASSERT_EQ(read->instances.size(), written.instances.size());
	for (std::size_t i = 0; i < written.instances.size(); i++)
	{
		const Instance &r = read->instances[i], &w = written.instances[i];
		EXPECT_EQ(r.box, w.box);
		EXPECT_EQ(r.mask, w.mask);
		EXPECT_EQ(r.labelScores, w.labelScores);
		EXPECT_EQ(r.confidence, w.confidence);
		ASSERT_TRUE(r.depth.has_value());
		EXPECT_EQ(r.depth->unit, w.depth->unit);
		EXPECT_EQ(cv::countNonZero(r.depth->depth != w.depth->depth), 0);
	}
}

TEST(CObservationInstances, EmbeddingsLoseOnlyWhatHalfFloatsLose)
{
	const auto written = example();
	const auto read = fromBytes(bytesOf(written));
	for (std::size_t i = 0; i < written.instances.size(); i++)
	{
		const auto &r = read->instances[i].embedding, &w = written.instances[i].embedding;
		ASSERT_EQ(r.size(), w.size());
		// A half float has 11 significant bits: each number is within 2^-11 of itself.
		EXPECT_LT(cv::norm(r, w), std::ldexp(1.0, -11));
		EXPECT_NEAR(cv::norm(r), 1.0, std::ldexp(1.0, -11));
	}
}

TEST(CObservationInstances, WritingWhatWasReadGivesTheSameBytes)
{
	const auto bytes = bytesOf(example());
	EXPECT_EQ(bytesOf(*fromBytes(bytes)), bytes);
}

TEST(CObservationInstances, ANonContiguousDepthCropIsWrittenRightly)
{
	auto o = example(1);
	const cv::Mat whole(120, 160, CV_16UC1, cv::Scalar(7));
	cv::Mat part = whole(o.instances[0].box);
	part.at<uint16_t>(1, 0) = 9;
	o.instances[0].depth->depth = part;
	const auto read = fromBytes(bytesOf(o));
	EXPECT_EQ(cv::countNonZero(read->instances[0].depth->depth != part), 0);
}

TEST(CObservationInstances, AnObservationWithNothingInItRoundTrips)
{
	const auto read = fromBytes(bytesOf(CObservationInstances()));
	EXPECT_TRUE(read->instances.empty());
	EXPECT_EQ(read->labels.size(), 0u);
}

TEST(CObservationInstances, AnInstanceNeedsNeitherEmbeddingNorDepth)
{
	auto o = example(1);
	o.instances[0].embedding.clear();
	o.instances[0].depth.reset();
	const auto read = fromBytes(bytesOf(o));
	EXPECT_TRUE(read->instances[0].embedding.empty());
	EXPECT_FALSE(read->instances[0].depth.has_value());
}

TEST(CObservationInstances, KeepsTheTrueObjectOfThoseThatHaveOne)
{
	auto o = example(3);
	o.instances[0].trueObject = 0;
	o.instances[2].trueObject = 4'000'000'000u;
	const auto read = fromBytes(bytesOf(o));
	EXPECT_EQ(read->instances[0].trueObject, std::optional<uint32_t>(0));
	EXPECT_FALSE(read->instances[1].trueObject.has_value());
	EXPECT_EQ(read->instances[2].trueObject, std::optional<uint32_t>(4'000'000'000u));
}

TEST(CObservationInstances, VersionZeroIsReadAsWithoutTrueObjects)
{
	// Version 1 ends with a flag for each instance; the object itself ends with a mark of one byte.
	auto bytes = bytesOf(example(1));
	const std::string name = "semloop::CObservationInstances";
	const std::size_t version = bytes.find(name) + name.size();
	ASSERT_EQ(bytes[version], 1);
	bytes[version] = 0;
	bytes.erase(bytes.size() - 2, 1);
	const auto read = fromBytes(bytes);
	ASSERT_TRUE(read);
	ASSERT_EQ(read->instances.size(), 1u);
	EXPECT_EQ(read->instances[0].mask, example(1).instances[0].mask);
	EXPECT_FALSE(read->instances[0].trueObject.has_value());
}

TEST(CObservationInstances, IsKnownToMrptsClassRegistry)
{
	const auto made = mrpt::rtti::classFactory("semloop::CObservationInstances");
	EXPECT_TRUE(std::dynamic_pointer_cast<CObservationInstances>(made));
}

TEST(CObservationInstances, DamagedBytesNeverGiveAnInvalidObservation)
{
	const auto good = bytesOf(example(2));
	std::mt19937 random(3);
	std::uniform_int_distribution<std::size_t> place(0, good.size() - 1);
	std::uniform_int_distribution<int> value(0, 255);
	for (int i = 0; i < 3000; i++)
	{
		auto bytes = good;
		// Half of them where the counts and sizes are: in the beginning.
		const std::size_t at = i % 2 ? place(random) : place(random) % 3000;
		bytes[at] = char(value(random));
		try
		{
			const auto read = fromBytes(bytes);
			if (read) read->validate();
		}
		catch (const InputError& e)
		{
			ADD_FAILURE() << "byte " << at << ": " << e.what();  // MRPT wraps what reading throws
		}
		catch (const std::exception&)
		{
		}
	}
}

TEST(CObservationInstances, ValidateNamesTheInstanceThatIsWrong)
{
	const auto error = errorAfter([](auto& o) { o.instances[1].box.x = 150; });
	EXPECT_EQ(error.find("instance 1: box"), 0u) << error;
}

TEST(CObservationInstances, ValidateRefusesWhatCannotBe)
{
	const float nan = std::numeric_limits<float>::quiet_NaN();
	EXPECT_EQ(errorAfter([](auto&) {}), "");
	const std::vector<std::function<void(CObservationInstances&)>> damages = {
		[](auto& o) { o.instances[0].box = {}; },
		[](auto& o) { o.instances[0].box.y = -1; },
		[](auto& o) {
			o.instances[0].mask = InstanceMask({10, 10});
		},
		[](auto& o) { o.instances[0].labelScores.clear(); },
		[](auto& o) { o.instances[0].labelScores[0].label = 80; },
		[](auto& o) { o.instances[0].labelScores[0].score = 1.5f; },
		[](auto& o) { o.instances[0].labelScores[1].score = 0.9f; },
		[](auto& o) { o.instances[0].labelScores[1].label = 56; },
		[nan](auto& o) { o.instances[0].labelScores[1].score = nan; },
		[](auto& o) { o.instances[0].confidence = -0.1f; },
		[nan](auto& o) { o.instances[0].confidence = nan; },
		[nan](auto& o) { o.instances[0].embedding[5] = nan; },
		[](auto& o) { o.instances[0].depth->depth = cv::Mat(3, 3, CV_16UC1); },
		[](auto& o) { o.instances[0].depth->depth.convertTo(o.instances[0].depth->depth, CV_32F); },
		[](auto& o) { o.instances[0].depth->unit = 0; },
		[](auto& o) { o.camera.ncols = 150; },
		[](auto& o) { o.camera.nrows = 4'000'000'000u; }};
	for (std::size_t i = 0; i < damages.size(); i++) EXPECT_NE(errorAfter(damages[i]), "") << i;
}

TEST(CObservationInstances, RefusesToWriteWhatItCouldNotRead)
{
	auto o = example();
	o.instances[2].confidence = 2;
	EXPECT_THROW(bytesOf(o), std::exception);
}

TEST(CObservationInstances, DescribesItselfAfterWhatEveryObservationSays)
{
	const auto o = example();
	std::ostringstream text, base;
	o.getDescriptionAsText(text);
	o.mrpt::obs::CObservation::getDescriptionAsText(base);
	EXPECT_EQ(text.str().find(base.str()), 0u);
	EXPECT_NE(text.str().find("chair"), std::string::npos);
	EXPECT_EQ(text.str().find("truly"), std::string::npos);
}

TEST(CObservationInstances, DescribesTheTrueObjectWhereThereIsOne)
{
	auto o = example(1);
	o.instances[0].trueObject = 17;
	std::ostringstream text;
	o.getDescriptionAsText(text);
	EXPECT_NE(text.str().find("truly object 17"), std::string::npos);
}

TEST(CObservationInstances, ExportsARowOfTextForEachInstance)
{
	auto o = example(2);
	o.instances[0].box = {10, 3, 6, 1};
	o.instances[0].labelScores = {{58, 0.5f}};  // potted plant
	o.instances[0].mask = InstanceMask(o.imageSize(), {{3, 10, 15}});
	o.instances[1] = o.instances[0];
	o.instances[1].labelScores = {{0, 1.0f}};
	EXPECT_TRUE(o.exportTxtSupported());
	EXPECT_EQ(
		o.exportTxtDataRow(),
		"0 potted_plant 0.5 0.875 10 3 6 1 5\n1305031453.374112 1 person 1 0.875 10 3 6 1 5");
	EXPECT_EQ(o.exportTxtHeader().find('\n'), std::string::npos);
	o.instances.clear();
	EXPECT_EQ(o.exportTxtDataRow(), "-1 - 0 0 0 0 0 0 0");
}

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semloop/config/Error.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RawlogWriter.h>

#include "EvaluationFixtures.h"
#include "TemporaryFolder.h"

namespace semloop
{
namespace
{
using namespace fixtures;
using ::testing::HasSubstr;

CObservationInstances observation(double seconds, const std::vector<int>& trueObjects)
{
	CObservationInstances o;
	o.timestamp = at(seconds);
	o.camera.ncols = 200;
	o.camera.nrows = 20;
	o.labels = LabelSet({"cup"});
	for (const int object : trueObjects)
	{
		Instance instance;
		instance.box = slot(std::abs(object));
		instance.mask = InstanceMask(
			o.imageSize(), {{3, uint16_t(instance.box.x), uint16_t(instance.box.x + 4)}});
		instance.labelScores = {{0, 1.0f}};
		if (object >= 0) instance.trueObject = uint32_t(object);
		o.instances.push_back(instance);
	}
	return o;
}

std::string writeRawlog(
	const TemporaryFolder& folder, const std::vector<CObservationInstances>& observations)
{
	RawlogWriter writer(folder.file("truth.rawlog"));
	for (const auto& o : observations) writer.write(o);
	writer.close();
	return folder.file("truth.rawlog");
}

TEST(TrueFrames, HaveTheInstancesThatAreARealObject)
{
	const TemporaryFolder folder;
	const auto frames =
		readTrueFrames(writeRawlog(folder, {observation(0, {3, -4}), observation(1, {})}));
	ASSERT_EQ(frames.size(), 2u);
	ASSERT_EQ(frames[0].boxes.size(), 1u);
	EXPECT_EQ(frames[0].boxes[0].object, 3u);
	EXPECT_EQ(frames[0].boxes[0].box, slot(3));
	EXPECT_EQ(frames[0].boxes[0].pixels, 4u);
	EXPECT_EQ(frames[1].time, at(1));
}

/** Depth was measured left of this column. */
std::string writeImages(
	const TemporaryFolder& folder, double seconds, const cv::Size& size, int columns)
{
	mrpt::obs::CObservation3DRangeScan scan;
	scan.timestamp = at(seconds);
	scan.hasRangeImage = scan.hasIntensityImage = scan.range_is_depth = true;
	scan.rangeUnits = 0.001f;
	scan.rangeImage_setSize(size.height, size.width);
	scan.rangeImage.setZero();
	for (int v = 0; v < size.height; ++v)
		for (int u = 0; u < columns; ++u) scan.rangeImage(v, u) = 1500;
	scan.intensityImage =
		mrpt::img::CImage(cv::Mat(size, CV_8UC3, cv::Scalar::all(90)), mrpt::img::DEEP_COPY);
	scan.cameraParams.ncols = uint32_t(size.width);
	scan.cameraParams.nrows = uint32_t(size.height);
	scan.cameraParams.setIntrinsicParamsFromValues(200, 200, 100, 10);
	scan.cameraParamsIntensity = scan.cameraParams;
	scan.relativePoseIntensityWRTDepth =
		mrpt::poses::CPose3D::FromYawPitchRoll(-M_PI / 2, 0, -M_PI / 2);
	RawlogWriter writer(folder.file("images.rawlog"));
	writer.write(scan);
	writer.close();
	return folder.file("images.rawlog");
}

TEST(TrueFrames, OfTheMaskCountOnlyPixelsWhoseDepthWasMeasured)
{
	const TemporaryFolder folder;
	const auto truth = writeRawlog(folder, {observation(0, {3}), observation(1, {3})});
	const auto images = writeImages(folder, 1, {200, 20}, slot(3).x + 1);
	const auto frames = readTrueFrames(truth, images);
	ASSERT_EQ(frames.size(), 1u) << "of the other there is no image";
	EXPECT_EQ(frames[0].time, at(1));
	EXPECT_EQ(frames[0].boxes.at(0).pixels, 1u);
}

TEST(TrueFrames, ADamagedImageIsLeftOut)
{
	const TemporaryFolder folder;
	const auto truth = writeRawlog(folder, {observation(0, {3}), observation(1, {3})});
	const auto images = writeImages(folder, 0, {200, 20}, 0);
	mrpt::obs::CObservation3DRangeScan damaged;
	damaged.timestamp = at(1);
	RawlogWriter writer(folder.file("two.rawlog"));
	writer.write(*RawlogReader(images).next());
	writer.write(damaged);
	writer.close();
	const auto frames = readTrueFrames(truth, folder.file("two.rawlog"));
	ASSERT_EQ(frames.size(), 1u);
	EXPECT_EQ(frames[0].time, at(0));
	EXPECT_EQ(frames[0].boxes.at(0).pixels, 0u);
}

TEST(TrueFrames, WhatAFileTellsTwiceCountsOnce)
{
	const TemporaryFolder folder;
	const auto frames =
		readTrueFrames(writeRawlog(folder, {observation(0, {3}), observation(0, {3})}));
	ASSERT_EQ(frames.size(), 1u);
	EXPECT_EQ(frames[0].boxes.size(), 1u);
}

TEST(TrueFrames, ImagesThatDoNotBelongToTheInstancesAreRefused)
{
	const TemporaryFolder folder;
	const auto truth = writeRawlog(folder, {observation(0, {3})});
	const auto other = writeImages(folder, 0, {100, 20}, 10);
	EXPECT_THAT(
		messageOf<InputError>([&] { readTrueFrames(truth, other); }), HasSubstr("differ in size"));
	const auto later = writeImages(folder, 5, {200, 20}, 10);
	EXPECT_THAT(
		messageOf<InputError>([&] { readTrueFrames(truth, later); }),
		HasSubstr("no image is of the time"));
}

TEST(TrueFrames, ARawlogWithoutAnyTrueObjectIsRefused)
{
	const TemporaryFolder folder;
	const auto rawlog = writeRawlog(folder, {observation(0, {-4})});
	EXPECT_THAT(
		messageOf<InputError>([&] { readTrueFrames(rawlog); }),
		HasSubstr("truth.rawlog: no instance in it says which real object it is"));
}

TEST(JoinWithTruth, KeepsTheFramesOfTheRunThatHaveATruth)
{
	const Trajectory run{{at(1), {}}, {at(2), {}}, {at(3), {}}};
	// The result's times are rounded to microseconds.
	const std::vector<TrueFrame> truth{
		{at(0), trueBoxes({1})}, {at(2.0000004), trueBoxes({2})}, {at(3), trueBoxes({3})}};
	const auto frames = joinWithTruth(run, {record(0, slot(1), 7), record(2, slot(3), 8)}, truth);
	ASSERT_EQ(frames.size(), 2u);
	EXPECT_EQ(frames[0].frame, 1u);
	EXPECT_EQ(frames[0].truth[0].object, 2u);
	EXPECT_TRUE(frames[0].estimate.empty());
	EXPECT_EQ(frames[1].frame, 2u);
	ASSERT_EQ(frames[1].estimate.size(), 1u);
	EXPECT_EQ(frames[1].estimate[0].object, 8u);
}

TEST(JoinWithTruth, RefusesWhatDoesNotOverlapInTimeWithBothSpans)
{
	const Trajectory run{{at(1), {}}, {at(2), {}}};
	const auto error = messageOf<InputError>(
		[&] {
			joinWithTruth(run, {}, {{at(5), trueBoxes({1})}, {at(6), {}}});
		});
	EXPECT_THAT(error, HasSubstr("1001.000000 to 1002.000000"));
	EXPECT_THAT(error, HasSubstr("1005.000000 to 1006.000000"));
	EXPECT_THAT(error, HasSubstr("give those of one rawlog"));
	EXPECT_THROW(joinWithTruth({}, {}, {{at(5), {}}}), InputError);
	EXPECT_THROW(joinWithTruth(run, {}, {}), InputError);
}
}  // namespace
}  // namespace semloop

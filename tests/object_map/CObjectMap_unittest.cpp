#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/CObjectMap.h>

#include "ObjectMapFixtures.h"

using namespace semloop;
using namespace semloop::synthetic;

namespace
{
/** The first view of the circle, with masks. */
View firstView()
{
	return renderView(ballAndBox(), testCamera(), onCircle(0, 8));
}
}  // namespace

TEST(CObjectMap, AddsAnObjectAtTheCentreOfWhatWasSeenWithTheWorldsAxes)
{
	CObjectMap map = emptyMap();
	View view = firstView();
	view.frame.time = mrpt::Clock::fromDouble(7);
	const auto id =
		map.addObject(view.frame, makeInstance(view.masks[1], kCup, 0.9f, {1, 0}), onCircle(0, 8));
	ASSERT_TRUE(id.has_value());
	const Object& object = map.object(*id);
	EXPECT_EQ(object.T_world_object.getRotationMatrix(), CPose3D().getRotationMatrix());
	// The camera at x = 1.3 m sees the half of the ball that is turned to it.
	EXPECT_GT(object.T_world_object.x(), 0.0);
	EXPECT_LT(object.T_world_object.x(), 0.12);
	EXPECT_NEAR(object.T_world_object.y(), 0.0, 0.01);
	EXPECT_EQ(object.labelScores, (LabelScores{{kCup, 0.9f}}));
	EXPECT_EQ(object.embeddings.size(), 1U);
	EXPECT_EQ(object.observations, 1);
	EXPECT_EQ(object.existence, 0.5);
	EXPECT_EQ(object.firstSeen, view.frame.time);
	EXPECT_EQ(map.labelName(object), "cup");
}

TEST(CObjectMap, TheVoxelSizeFollowsTheSizeOfTheObject)
{
	CObjectMap map = emptyMap();
	map.insertionOptions.voxelsPerSide = 30;
	const View view = firstView();
	const auto id = map.addObject(view.frame, makeInstance(view.masks[1], kCup), onCircle(0, 8));
	// 0.3 m / 30 = 1 cm; less what is cut from the ball's rim: 4 % of its disc is 16 % of its width.
	const auto& options = map.object(*id).volume->options();
	EXPECT_NEAR(options.voxelSize, 0.0085, 0.0015);
	EXPECT_DOUBLE_EQ(options.truncation, 4 * options.voxelSize);

	map.insertionOptions.maxVoxelSize = 0.006;
	const auto fine = map.addObject(view.frame, makeInstance(view.masks[1], kCup), onCircle(0, 8));
	EXPECT_DOUBLE_EQ(map.object(*fine).volume->options().voxelSize, 0.006);
}

TEST(CObjectMap, AnObjectFarLargerThanItsFirstViewGetsLargerVoxelsNotAnEnd)
{
	// A wall of 2.4 x 2.4 m whose first detection covered 0.3 m: 60 x 60 blocks of 4 cm are too many.
	Scene scene;
	scene.boxes.push_back({CPose3D(0, 0, 1.2, 0, 0, 0), {0.1, 2.4, 2.4}, {90, 90, 90}, 1, 0});
	const CPose3D T_world_camera = lookAt({2.9, 0, 1.2}, {0, 0, 1.2});
	const View view = renderView(scene, testCamera(), T_world_camera);
	cv::Mat part = cv::Mat::zeros(240, 320, CV_8UC1);
	part(cv::Rect(146, 106, 28, 28)).setTo(255);
	CObjectMap map = emptyMap();
	ASSERT_TRUE(
		map.addObject(view.frame, makeInstance(InstanceMask::encode(part), kBook), T_world_camera));
	const double first = map.object(0).volume->options().voxelSize;
	for (int i = 0; i < 3; ++i)
		ASSERT_TRUE(map.fuse(0, view.frame, makeInstance(view.masks[1], kBook), T_world_camera));
	const TsdfVolume& volume = *map.object(0).volume;
	EXPECT_GE(volume.options().voxelSize, 2 * first);
	EXPECT_LT(volume.blockCount(), std::size_t(volume.options().maxBlocks));
	EXPECT_NEAR(map.object(0).extent().y, 2.4, 0.1);
	EXPECT_NEAR(map.object(0).extent().z, 2.4, 0.1);
	EXPECT_LT(map.object(0).centre().distanceTo({0.05, 0, 1.2}), 0.05);
}

TEST(CObjectMap, RejectsMasksWithTooLittleDepthAndChangesNothing)
{
	CObjectMap map = emptyMap();
	View view = firstView();
	ASSERT_TRUE(map.addObject(view.frame, makeInstance(view.masks[1], kCup), onCircle(0, 8)));
	const std::string before = bytesOf(map);

	View few = view;
	few.frame.depth = view.frame.depth.clone();
	few.frame.depth.setTo(0, view.ids == 1);
	few.frame.depth.at<float>(120, 160) = 1.2f;
	const cv::Mat small = cv::Mat::zeros(240, 320, CV_8UC1);
	small(cv::Rect(158, 118, 5, 5)).setTo(255);
	View far = view;
	far.frame.depth = view.frame.depth * 10;
	View notNumbers = view;
	notNumbers.frame.depth = view.frame.depth * std::nan("");

	const Instance ball = makeInstance(view.masks[1], kCup);
	const std::vector<std::pair<const RgbdFrame*, Instance>> unusable = {
		{&few.frame, ball},
		{&far.frame, ball},
		{&notNumbers.frame, ball},
		{&view.frame, makeInstance(InstanceMask::encode(small), kCup)},
		{&view.frame, makeInstance(InstanceMask(cv::Size(320, 240)), kCup)}};
	for (const auto& [frame, instance] : unusable)
	{
		EXPECT_FALSE(map.addObject(*frame, instance, onCircle(0, 8)).has_value());
		EXPECT_FALSE(map.fuse(0, *frame, instance, onCircle(0, 8)));
	}
	EXPECT_EQ(bytesOf(map), before);
}

TEST(CObjectMap, SaysWhatIsWrongWithAnInstanceThatDoesNotFit)
{
	CObjectMap map = emptyMap();
	const View view = firstView();
	const Instance ball = makeInstance(view.masks[1], kCup);
	ASSERT_TRUE(map.addObject(view.frame, makeInstance(view.masks[1], kCup, 1, {1, 0}), {}));

	Instance other = ball;
	other.mask = InstanceMask(cv::Size(64, 48), {{1, 1, 40}});
	EXPECT_THROW(map.addObject(view.frame, other, {}), InputError);
	other = ball;
	other.labelScores.clear();
	EXPECT_THROW(map.addObject(view.frame, other, {}), InputError);
	other.labelScores = {{3, 1.f}};
	EXPECT_THROW(map.fuse(0, view.frame, other, {}), InputError);
	other = ball;
	other.embedding = {1, 0, 0};
	EXPECT_THROW(map.fuse(0, view.frame, other, {}), InputError);
	EXPECT_THROW(map.fuse(1, view.frame, ball, {}), std::out_of_range);
	EXPECT_THROW(map.object(1), std::out_of_range);
	EXPECT_THROW(map.markCovisible({0, 1}), std::out_of_range);
}

TEST(CObjectMap, TrimsBackgroundThatLeaksIntoTheMask)
{
	Scene scene = ballAndBox();
	scene.planes.push_back({{1, 0, 0}, -2.0, {200, 200, 200}, 0, 0});
	const View view = renderView(scene, testCamera(), onCircle(0, 8));
	// A sloppy mask: the box round the ball, a fifth of it wall two metres behind, and table.
	const cv::Rect box = view.masks[1].boundingBox();
	cv::Mat sloppy = cv::Mat::zeros(240, 320, CV_8UC1);
	sloppy(box).setTo(255);
	sloppy.setTo(0, (view.ids == 0) & (view.frame.depth < 2));

	CObjectMap map = emptyMap();
	const auto id =
		map.addObject(view.frame, makeInstance(InstanceMask::encode(sloppy), kCup), onCircle(0, 8));
	ASSERT_TRUE(id.has_value());
	const Object& object = map.object(*id);
	EXPECT_LT(object.centre().distanceTo({0, 0, 0.85}), 0.12);
	EXPECT_LT(object.extent().norm(), 0.3 * std::sqrt(3.0) + 0.03);
}

TEST(CObjectMap, PrefersTheObjectToWhatIsSeenThroughIt)
{
	// A grille of bars in front of a wall: 40 % bars, 60 % wall, all of it in the mask.
	Scene scene;
	for (int bar = 0; bar < 5; ++bar)
		scene.boxes.push_back(
			{CPose3D(0, -0.4 + 0.2 * bar, 1, 0, 0, 0), {0.05, 0.08, 0.8}, {30, 30, 30}, 1, 0});
	scene.planes.push_back({{1, 0, 0}, -1.5, {200, 200, 200}, 0, 0});
	const CPose3D T_world_camera = lookAt({1.5, 0, 1}, {0, 0, 1});
	const View view = renderView(scene, testCamera(), T_world_camera);
	cv::Mat filled = cv::Mat::zeros(240, 320, CV_8UC1);
	filled(view.masks[1].boundingBox()).setTo(255);

	CObjectMap map = emptyMap();
	const auto id = map.addObject(
		view.frame, makeInstance(InstanceMask::encode(filled), kChair), T_world_camera);
	ASSERT_TRUE(id.has_value());
	EXPECT_NEAR(map.object(*id).centre().x, 0.025, 0.03);
}

TEST(CObjectMap, AveragesTheLabelDistributions)
{
	CObjectMap map = emptyMap();
	const View view = firstView();
	const CPose3D T_world_camera = onCircle(0, 8);
	Instance instance = makeInstance(view.masks[1], kCup, 0.6f);
	instance.labelScores = {{kCup, 0.6f}, {kBook, 0.4f}};
	map.addObject(view.frame, instance, T_world_camera);
	instance.labelScores = {{kBook, 0.9f}};
	map.fuse(0, view.frame, instance, T_world_camera);
	map.fuse(0, view.frame, instance, T_world_camera);
	// cup (0.6 + 0 + 0) / 3, book (0.4 + 0.9 + 0.9) / 3
	const LabelScores& scores = map.object(0).labelScores;
	ASSERT_EQ(scores.size(), 2U);
	EXPECT_EQ(scores[0].label, kBook);
	EXPECT_NEAR(scores[0].score, 2.2 / 3, 1e-6);
	EXPECT_EQ(scores[1].label, kCup);
	EXPECT_NEAR(scores[1].score, 0.2, 1e-6);
	EXPECT_EQ(map.object(0).observations, 3);
	EXPECT_GT(map.object(0).existence, 0.5);
}

TEST(CObjectMap, KeepsTheMostDifferentEmbeddings)
{
	CObjectMap map = emptyMap();
	map.insertionOptions.maxEmbeddings = 3;
	const View view = firstView();
	const auto embedding = [](double degrees)
	{
		const double angle = degrees * M_PI / 180;
		return std::vector<float>{float(std::cos(angle)), float(std::sin(angle))};
	};
	bool first = true;
	for (const double degrees : {0.0, 80.0, 40.0, 38.0, 1.0, 90.0})
	{
		const Instance ball = makeInstance(view.masks[1], kCup, 1, embedding(degrees));
		if (first)
			map.addObject(view.frame, ball, onCircle(0, 8));
		else
			map.fuse(0, view.frame, ball, onCircle(0, 8));
		first = false;
	}
	// 38 goes: beside 40, it is nearer to 0 than 40 to 80. 1 goes: nearer to 40 than 0. Last, 80 goes.
	EXPECT_EQ(
		map.object(0).embeddings,
		(std::vector<std::vector<float>>{embedding(0), embedding(40), embedding(90)}));
}

TEST(CObjectMap, RemembersHowOftenPairsWereSeenTogether)
{
	CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	map.markCovisible({0, 1});
	map.markCovisible({0, 1});
	map.markCovisible({0});
	map.markCovisible({});
	EXPECT_EQ(map.object(0).covisible, (std::map<ObjectId, int>{{1, 2}}));
	EXPECT_EQ(map.object(1).covisible, (std::map<ObjectId, int>{{0, 2}}));
}

TEST(CObjectMap, ObjectsSeenThroughAreRemovedAndSoonerWhenSeenOnce)
{
	CObjectMap often = mapOf(ballAndBox(), {kCup, kBook});
	CObjectMap once = emptyMap();
	const View view = firstView();
	once.addObject(view.frame, makeInstance(view.masks[1], kCup), onCircle(0, 8));
	once.addObject(view.frame, makeInstance(view.masks[2], kBook), onCircle(0, 8));
	once.markCovisible({0, 1});

	Scene without = ballAndBox();
	without.spheres.clear();
	const RgbdFrame frame = renderFrame(without, testCamera(), onCircle(0, 8));
	const auto framesUntilGone = [&](CObjectMap& map)
	{
		for (int count = 1; count < 50; ++count)
		{
			const auto predicted = map.predict(frame.camera, onCircle(0, 8), frame.depth);
			map.updateExistence(predicted, frame, {1});
			if (map.removeUnsupported() == std::vector<ObjectId>{0}) return count;
		}
		return 50;
	};
	EXPECT_LE(framesUntilGone(once), 3);
	const int many = framesUntilGone(often);
	EXPECT_GE(many, 4);
	EXPECT_LT(many, 20);
	EXPECT_EQ(once.objects().size(), 1U);
	EXPECT_TRUE(once.object(1).covisible.empty());
}

TEST(CObjectMap, AnObjectThatIsOnlyNotDetectedStays)
{
	CObjectMap map = emptyMap();
	const View view = firstView();
	map.addObject(view.frame, makeInstance(view.masks[1], kCup), onCircle(0, 8));
	const auto predicted = map.predict(view.frame.camera, onCircle(0, 8), view.frame.depth);
	ASSERT_EQ(predicted.size(), 1U);
	for (int i = 0; i < 100; ++i) map.updateExistence(predicted, view.frame, {});
	EXPECT_EQ(map.object(0).existence, 0.5);
	EXPECT_EQ(map.object(0).timesSeenThrough, 0);
	EXPECT_TRUE(map.removeUnsupported().empty());

	// Nor does a frame without any depth speak against it.
	RgbdFrame blind = view.frame;
	blind.depth = cv::Mat::zeros(view.frame.depth.size(), CV_32FC1);
	map.updateExistence(map.predict(blind.camera, onCircle(0, 8)), blind, {});
	EXPECT_EQ(map.object(0).existence, 0.5);

	map.updateExistence(predicted, view.frame, {0});
	EXPECT_GT(map.object(0).existence, 0.5);
}

TEST(CObjectMap, ChangingACopyLeavesTheOriginalAndItsVolumes)
{
	const CObjectMap original = mapOf(ballAndBox(), {kCup, kBook});
	const std::string before = bytesOf(original);
	CObjectMap copy = original;
	EXPECT_EQ(copy.object(0).volume, original.object(0).volume);

	const CPose3D T_world_camera = lookAt({0.5, 0.5, 2}, {0, 0, 0.8});
	const View view = renderView(ballAndBox(), testCamera(), T_world_camera);
	ASSERT_TRUE(copy.fuse(0, view.frame, makeInstance(view.masks[1], kChair), T_world_camera));
	EXPECT_NE(copy.object(0).volume, original.object(0).volume);
	EXPECT_EQ(copy.object(1).volume, original.object(1).volume);
	copy.mergeObjects(1, 0);
	EXPECT_EQ(bytesOf(original), before);
	EXPECT_NE(bytesOf(copy), before);
}

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <semloop/config/Error.h>
#include <semloop/loop_closure/AppearanceLoopDetector.h>

#include "GraphFixtures.h"
#include "SyntheticScene.h"
#include "TemporaryFolder.h"

namespace
{
using namespace semloop;
using namespace semloop::synthetic;
using semloop::fixtures::rotationAngle;
using semloop::fixtures::yawPose;
using testing::HasSubstr;
using Decision = LoopVerdict::Decision;

/** A room of textured walls and boxes; another cell, another room. */
Scene texturedRoom(double cell)
{
	Scene scene;
	scene.planes.push_back({{0, 0, 1}, 0, {150, 150, 150}, 0, cell});
	scene.planes.push_back({{1, 0, 0}, 3, {180, 160, 150}, 0, cell});
	scene.planes.push_back({{0, 1, 0}, 3, {150, 170, 180}, 0, cell});
	for (int i = 0; i < 5; ++i)
		scene.boxes.push_back(
			{CPose3D(1.0 + 0.3 * i, 0.4 * i - 0.6, 0.3 + 0.1 * i, 0.3 * i, 0, 0),
			 {0.4, 0.3, 0.5},
			 {200, 180, 160},
			 i + 1,
			 0.7 * cell});
	return scene;
}

RgbdFrame picture(const Scene& scene, const CPose3D& T_world_camera)
{
	return renderView(scene, makeCamera(320, 240, 260), T_world_camera).frame;
}

const CPose3D kThere = lookAt({-0.8, -0.6, 1.3}, {1.6, 0.6, 0.5});
const CPose3D kBack = lookAt({-0.6, -0.9, 1.2}, {1.6, 0.7, 0.5});
const CPose3D kElsewhere = lookAt({-0.8, -0.6, 1.3}, {-3, -2, 0.2});

TEST(CameraVerification, FindsThePoseBetweenTwoPictures)
{
	const Scene room = texturedRoom(0.06);
	const auto target = extractOrb(picture(room, kThere), 1000);
	const auto query = extractOrb(picture(room, kBack), 1000);
	const auto found = compareCameras(query, target, {});
	ASSERT_TRUE(found.pose);
	const CPose3D error = found.pose->T_target_query - (kBack - kThere);
	EXPECT_LT(error.norm(), 0.02);
	EXPECT_LT(rotationAngle(error), 0.01);
	EXPECT_GE(found.pose->inliers, 25u);
	EXPECT_LE(found.pose->inliers, found.matches);

	// No more certain than the floor of 1 cm and half a degree, and the error within three sigmas.
	const Eigen::Matrix<double, 6, 6> covariance = found.pose->information.inverse();
	for (int i = 0; i < 3; ++i)
	{
		EXPECT_GE(covariance(i, i), 0.999e-4);
		EXPECT_LT(std::abs(error[std::size_t(i)]), 3 * std::sqrt(covariance(i, i)));
		EXPECT_GE(covariance(3 + i, 3 + i), 0.999 * 0.0087 * 0.0087);
	}
	EXPECT_LT(covariance(0, 0), 0.05 * 0.05);
}

TEST(CameraVerification, OtherPlacesHaveNoPose)
{
	const auto here = extractOrb(picture(texturedRoom(0.06), kThere), 1000);
	EXPECT_FALSE(
		compareCameras(here, extractOrb(picture(texturedRoom(0.047), kThere), 1000), {}).pose);
	EXPECT_FALSE(
		compareCameras(extractOrb(picture(texturedRoom(0.06), kElsewhere), 1000), here, {}).pose);
}

TEST(CameraVerification, NoTextureAndNoDepthAreNoPose)
{
	auto frame = picture(texturedRoom(0.06), kThere);
	const auto good = extractOrb(frame, 1000);
	auto blank = frame;
	blank.color = cv::Mat(frame.color.size(), CV_8UC3, cv::Scalar(90, 90, 90));
	const auto none = extractOrb(blank, 1000);
	EXPECT_EQ(none.size(), 0u);
	EXPECT_FALSE(compareCameras(none, good, {}).pose);
	EXPECT_FALSE(compareCameras(good, none, {}).pose);
	frame.depth = cv::Mat::zeros(frame.depth.size(), CV_32FC1);
	EXPECT_FALSE(compareCameras(good, extractOrb(frame, 1000), {}).pose);
	// The query's depth is not needed.
	EXPECT_TRUE(compareCameras(extractOrb(frame, 1000), good, {}).pose);
	frame.color.release();
	EXPECT_THROW(extractOrb(frame, 1000), InputError);
}

TEST(CameraVerification, TheInformationIsThatOfTheCamerasMotion)
{
	// Sideways and forwards motions of a camera that looks at a far wall: depth is the weakest.
	Scene wall;
	wall.planes.push_back({{1, 0, 0}, 4, {180, 160, 150}, 0, 0.12});
	const auto features = extractOrb(picture(wall, lookAt({0, 0, 0}, {4, 0, 0})), 1000);
	CameraVerificationOptions options;
	options.pixelSigma = 30;  // far above the floor
	const auto found = compareCameras(features, features, options);
	ASSERT_TRUE(found.pose);
	EXPECT_LT(found.pose->T_target_query.norm(), 1e-3);
	const auto& H = found.pose->information;
	// A turn about y and a step along x move the picture the same way, to a great part.
	EXPECT_GT(std::abs(H(0, 4)), 0.9 * std::sqrt(H(0, 0) * H(4, 4)));
	EXPECT_GT(std::abs(H(1, 3)), 0.9 * std::sqrt(H(1, 1) * H(3, 3)));
	EXPECT_LT(std::abs(H(0, 3)), 0.2 * std::sqrt(H(0, 0) * H(3, 3)));
	EXPECT_LT(H(2, 2), H(0, 0));
}

/** Two pictures of one place, with others between; the world drifts between them. */
class AppearanceLoopDetection : public testing::Test
{
protected:
	template <class Detector>
	void configure(Detector& detector) const
	{
		detector.options.keyFrameEvery = 1;
		detector.options.minFramesApart = 3;
		detector.options.features = 800;
	}
	void show(AppearanceLoopDetector& detector, const CPose3D& last) const
	{
		const std::vector<CPose3D> walk{kThere, kElsewhere, kElsewhere, kElsewhere, last};
		for (std::size_t i = 0; i < walk.size(); ++i) detector.addFrame(i, picture(room, walk[i]));
	}
	LoopQuery ask(const CPose3D& last) const
	{
		LoopQuery query{map, {}, {}};
		query.firstFrame = 3;
		query.T_world_camera = [=](std::size_t frame) {
			return frame == 0 ? kThere : frame < 4 ? kElsewhere : drift + last;
		};
		return query;
	}
	static OrbVocabulary vocabulary()
	{
		std::vector<cv::Mat> images;
		for (int i = 0; i < 12; ++i)
			images.push_back(extractOrb(
								 picture(
									 texturedRoom(0.05 + 0.01 * (i % 3)),
									 lookAt({-0.8, 0.3 * i - 2, 1.2}, {2, 0.2 * i, 0.5})),
								 800)
								 .descriptors);
		OrbVocabularyOptions options;
		options.levels = 3;
		return OrbVocabulary::train(images, options);
	}
	void expectTheLoop(const LoopVerdict& verdict) const
	{
		ASSERT_EQ(verdict.decision, Decision::Accepted) << verdict.reason;
		ASSERT_EQ(verdict.cameras.size(), 1u);
		EXPECT_EQ(verdict.cameras[0].query, 4u);
		EXPECT_EQ(verdict.cameras[0].target, 0u);
		EXPECT_TRUE(verdict.matches.empty());
		// Takes the drift back.
		const CPose3D left = verdict.T_target_query + drift;
		EXPECT_LT(left.norm(), 0.03);
		EXPECT_LT(rotationAngle(left), 0.01);
		EXPECT_THAT(verdict.reason, HasSubstr("frame 4 sees what frame 0 saw"));
	}

	const Scene room = texturedRoom(0.06);
	const CPose3D drift = yawPose(0.5, -0.3, 0.05, 0.12);
	CObjectMap map;
};

TEST_F(AppearanceLoopDetection, OrbFeaturesMeasureTheDrift)
{
	OrbLoopDetector detector;
	configure(detector);
	show(detector, kBack);
	EXPECT_EQ(detector.keyFrames(), 5u);
	expectTheLoop(detector.detect(ask(kBack)));
	const auto again = detector.detect(ask(kBack));
	EXPECT_EQ(again.decision, Decision::Rejected) << "each key frame asks once";
	EXPECT_THAT(again.reason, HasSubstr("0 pairs of 0 key frames"));
	EXPECT_TRUE(again.cameras.empty());
}

TEST_F(AppearanceLoopDetection, BagsOfWordsMeasureTheDrift)
{
	BagOfWordsLoopDetector detector;
	configure(detector);
	detector.setVocabulary(vocabulary());
	show(detector, kBack);
	expectTheLoop(detector.detect(ask(kBack)));
}

TEST_F(AppearanceLoopDetection, AnotherPlaceIsNoLoop)
{
	// Never looked that way before.
	const CPose3D elsewhere = lookAt({0.5, 2.0, 1.2}, {-3, 0.5, 0.3});
	OrbLoopDetector plain;
	BagOfWordsLoopDetector words;
	configure(plain);
	configure(words);
	words.setVocabulary(vocabulary());
	show(plain, elsewhere);
	show(words, elsewhere);
	const auto verdict = plain.detect(ask(elsewhere));
	EXPECT_EQ(verdict.decision, Decision::Rejected);
	EXPECT_FALSE(verdict.graphsMatch);
	EXPECT_THAT(verdict.reason, HasSubstr("needed are 25"));
	EXPECT_EQ(words.detect(ask(elsewhere)).decision, Decision::Rejected);
}

TEST_F(AppearanceLoopDetection, FramesThatAreTooNearInTimeAreNoCandidates)
{
	OrbLoopDetector detector;
	configure(detector);
	detector.options.minFramesApart = 5;
	show(detector, kBack);
	const auto verdict = detector.detect(ask(kBack));
	EXPECT_EQ(verdict.decision, Decision::Rejected);
	EXPECT_THAT(verdict.reason, HasSubstr("0 pairs of 2 key frames"));
	LoopQuery blind{map, {}, {}};
	EXPECT_THROW(detector.detect(blind), std::invalid_argument);
}

TEST(BagOfWordsLoopDetector, NeedsAVocabulary)
{
	mrpt::config::CConfigFileMemory config;
	BagOfWordsLoopDetector detector;
	EXPECT_THAT(
		messageOf<UsageError>([&] { detector.configure(config, "loop_detection"); }),
		HasSubstr("rawlog-train-vocabulary"));
	config.write("appearance", "vocabulary", std::string("/nowhere"));
	EXPECT_THROW(detector.configure(config, "loop_detection"), InputError);
}
}  // namespace

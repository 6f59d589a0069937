#include <gtest/gtest.h>
#include <semloop/association/InstanceTracker.h>
#include <semloop/config/Error.h>

#include <memory>

using namespace semloop;

namespace
{
const cv::Size kImage(320, 240);
const mrpt::poses::CPose3D kStill;

RgbdFrame frameAt(float depth)
{
	RgbdFrame frame;
	frame.camera.ncols = kImage.width;
	frame.camera.nrows = kImage.height;
	frame.camera.setIntrinsicParamsFromValues(250, 250, 160, 120);
	frame.depth = cv::Mat(kImage, CV_32FC1, cv::Scalar(depth));
	return frame;
}

Instance instanceAt(const cv::Rect& box, uint32_t label = 0, float confidence = 0.9f)
{
	Instance instance;
	instance.box = box;
	instance.mask = InstanceMask::encode(cv::Mat(box.size(), CV_8UC1, 255), box.tl(), kImage);
	instance.labelScores = {{label, 1.0f}};
	instance.confidence = confidence;
	return instance;
}

CObservationInstances seen(std::vector<Instance> instances)
{
	CObservationInstances observation;
	observation.labels = LabelSet({"chair", "table"});
	observation.camera = frameAt(1).camera;
	observation.instances = std::move(instances);
	return observation;
}

class Tracking : public testing::Test
{
protected:
	static std::shared_ptr<SemanticMatchingCost> perfectNetwork()
	{
		auto cost = std::make_shared<SemanticMatchingCost>();
		cost->setConfusionMatrix(ConfusionMatrix(LabelSet({"chair", "table"}), 1.0));
		return cost;
	}

	std::vector<TrackedInstance> track(
		std::vector<Instance> instances, const mrpt::poses::CPose3D& T_previous_camera = kStill)
	{
		return tracker_.track(frame_, seen(std::move(instances)), T_previous_camera);
	}

	RgbdFrame frame_ = frameAt(2);
	InstanceTracker tracker_{{}, perfectNetwork()};
};

const cv::Rect kLeft(40, 60, 60, 80);
const cv::Rect kRight(200, 60, 60, 80);
}  // namespace

TEST_F(Tracking, ConfirmsATrackInItsThirdFrame)
{
	for (int i = 1; i <= 4; ++i)
	{
		const auto result = track({instanceAt(kLeft)});
		ASSERT_EQ(result.size(), 1u);
		EXPECT_EQ(result[0].track, 0u);
		EXPECT_EQ(result[0].instance, 0u);
		EXPECT_EQ(result[0].observations, i);
		EXPECT_EQ(result[0].confirmed, i >= 3);
	}
}

TEST_F(Tracking, NeverConfirmsWhatIsSeenOnce)
{
	for (int i = 0; i < 10; ++i)
	{
		// A table imagined in another place every time.
		const auto result = track({instanceAt(kLeft), instanceAt({110 + 20 * i, 10, 15, 15}, 1)});
		EXPECT_FALSE(result[1].confirmed);
		EXPECT_EQ(result[1].observations, 1);
	}
}

TEST_F(Tracking, FollowsTwoObjectsThatChangePlacesInTheList)
{
	const auto first = track({instanceAt(kLeft), instanceAt(kRight)});
	const auto second = track({instanceAt(kRight), instanceAt(kLeft)});
	EXPECT_EQ(second[0].track, first[1].track);
	EXPECT_EQ(second[1].track, first[0].track);
}

TEST_F(Tracking, DoesNotJoinDifferentLabels)
{
	const auto first = track({instanceAt(kLeft, 0)});
	const auto second = track({instanceAt(kLeft, 1)});
	EXPECT_NE(second[0].track, first[0].track);
	EXPECT_EQ(tracker_.trackCount(), 2u);
}

TEST_F(Tracking, MovesTheMaskByTheOdometry)
{
	// The camera goes 0.64 m to the right: the object goes 80 px to the left, clear of its old place.
	const auto first = track({instanceAt(kRight)});
	const mrpt::poses::CPose3D toTheRight(0.64, 0, 0, 0, 0, 0);
	const auto second = track({instanceAt(kRight - cv::Point(80, 0))}, toTheRight);
	EXPECT_EQ(second[0].track, first[0].track);
	EXPECT_EQ(second[0].observations, 2);
}

TEST_F(Tracking, AnErrorOfTheOdometryThatAllInstancesShareBreaksNoTrack)
{
	// 0.48 m to the right that never were would move all masks by 60 px: off themselves.
	const mrpt::poses::CPose3D imagined(0.48, 0, 0, 0, 0, 0);
	const std::vector<Instance> instances{
		instanceAt({90, 20, 50, 60}), instanceAt({200, 30, 50, 60}, 1),
		instanceAt({100, 150, 50, 60}, 1), instanceAt({220, 160, 50, 60})};
	const auto first = track(instances);
	const auto second =
		tracker_.track(frame_, seen(std::vector(instances)), imagined, PoseSigma{0.4, 0.05});
	for (std::size_t i = 0; i < instances.size(); ++i)
		EXPECT_EQ(second[i].track, first[i].track) << i;
	EXPECT_NEAR(tracker_.registration().T_seen_expected.x(), 0.48, 0.05);

	// An odometry that is sure of itself is believed.
	const auto third = tracker_.track(frame_, seen(std::vector(instances)), imagined, PoseSigma());
	for (std::size_t i = 0; i < instances.size(); ++i)
		EXPECT_NE(third[i].track, first[i].track) << i;
}

TEST_F(Tracking, GoesOnMovingATrackThatIsNotSeen)
{
	const auto first = track({instanceAt(kRight)});
	const mrpt::poses::CPose3D toTheRight(0.32, 0, 0, 0, 0, 0);
	track({}, toTheRight);
	track({}, toTheRight);
	const auto again = track({instanceAt(kRight - cv::Point(120, 0))}, toTheRight);
	EXPECT_EQ(again[0].track, first[0].track);
}

TEST_F(Tracking, LeavesAMaskWithoutDepthWhereItWas)
{
	frame_ = frameAt(0);
	const auto first = track({instanceAt(kRight)});
	const auto second = track({instanceAt(kRight)}, mrpt::poses::CPose3D(0.64, 0, 0, 0, 0, 0));
	EXPECT_EQ(second[0].track, first[0].track);
	frame_.depth = cv::Mat();
	EXPECT_EQ(track({instanceAt(kRight)})[0].track, first[0].track);
}

TEST_F(Tracking, KeepsAnUnseenTrackForFiveFramesAndNoMore)
{
	const auto first = track({instanceAt(kLeft)});
	for (int i = 0; i < 5; ++i) track({});
	EXPECT_EQ(tracker_.trackCount(), 1u);
	EXPECT_EQ(track({instanceAt(kLeft)})[0].track, first[0].track);
	for (int i = 0; i < 6; ++i) track({});
	EXPECT_EQ(tracker_.trackCount(), 0u);
}

TEST_F(Tracking, NeverUsesTheNumberOfADeadTrackAgain)
{
	const auto first = track({instanceAt(kLeft)});
	for (int i = 0; i < 6; ++i) track({});
	EXPECT_GT(track({instanceAt(kLeft)})[0].track, first[0].track);
}

TEST_F(Tracking, DoesNotLookAtWeakDetections)
{
	const auto result = track({instanceAt(kLeft, 0, 0.39f), instanceAt(kRight, 0, 0.41f)});
	ASSERT_EQ(result.size(), 1u);
	EXPECT_EQ(result[0].instance, 1u);
	EXPECT_EQ(tracker_.trackCount(), 1u);
}

TEST_F(Tracking, TellsOverlappingObjectsApartByTheirEmbeddings)
{
	auto a = instanceAt(kLeft), b = instanceAt(kLeft + cv::Point(30, 0));
	a.embedding = {1, 0};
	b.embedding = {0, 1};
	const auto first = track({a, b});
	// Both slipped by half their distance: the masks alone cannot tell.
	auto a2 = instanceAt(kLeft + cv::Point(15, 0)), b2 = a2;
	a2.embedding = {1, 0};
	b2.embedding = {0, 1};
	const auto second = track({b2, a2});
	EXPECT_EQ(second[0].track, first[1].track);
	EXPECT_EQ(second[1].track, first[0].track);
}

TEST_F(Tracking, OfNothingIsEmpty)
{
	EXPECT_TRUE(track({}).empty());
	EXPECT_EQ(tracker_.trackCount(), 0u);
}

TEST_F(Tracking, RefusesImagesOfDifferentSizes)
{
	auto small = instanceAt(kLeft);
	small.mask = InstanceMask(cv::Size(10, 10));
	EXPECT_THROW(track({small}), InputError);
	frame_.depth = cv::Mat(10, 10, CV_32FC1, cv::Scalar(1));
	EXPECT_THROW(track({instanceAt(kLeft)}), InputError);
	EXPECT_THROW(InstanceTracker({}, nullptr), UsageError);
}

#include "../../libs/odometry/src/DirectAlignment.h"

#include <limits>
#include <opencv2/imgproc.hpp>

#include "../../libs/odometry/src/PoseAlgebra.h"
#include "OdometryFixtures.h"

namespace semloop::test
{
namespace
{
AlignmentImage imageOf(const RgbdFrame& frame)
{
	cv::Mat gray;
	cv::cvtColor(frame.color, gray, cv::COLOR_BGR2GRAY);
	cv::GaussianBlur(gray, gray, {5, 5}, 1.0);  // the renderer does not antialias
	cv::Mat depth = frame.depth.clone();
	depth.setTo(std::numeric_limits<float>::quiet_NaN(), depth <= 0);
	auto image = makeAlignmentImage(gray, depth);
	image.fx = frame.camera.fx();
	image.fy = frame.camera.fy();
	image.cx = frame.camera.cx();
	image.cy = frame.camera.cy();
	return image;
}

const CPose3D& motion()
{
	static const CPose3D T_reference_current(0.02, -0.01, 0.03, 0.01, -0.015, 0.01);
	return T_reference_current;
}

DirectAlignmentResult alignMoved(const CPose3D& start, const DirectAlignmentOptions& options)
{
	const CPose3D T_world_reference = onPath(0);
	const auto reference = imageOf(frameAt(0, T_world_reference));
	const auto current = imageOf(frameAt(0, T_world_reference + motion()));
	return alignDirectly(
		selectAlignmentPoints(reference, 20000), current, toIsometry(-start), options);
}

TEST(DirectAlignment, FindsAKnownMotionToAFractionOfAPixel)
{
	const auto result =
		alignMoved(motion() + CPose3D(0.005, 0.005, -0.005, 0.003, 0.003, -0.003), {});
	ASSERT_TRUE(result.valid);
	expectPoseNear(toPose(result.T_current_reference.inverse()), motion(), 0.001, 0.0005);
	EXPECT_GT(result.overlap, 0.8);
}

TEST(DirectAlignment, EndsAtTheSamePoseFromDifferentStarts)
{
	DirectAlignmentOptions options;
	options.iterations = 30;
	const auto a = alignMoved(motion() + CPose3D(0.004, 0, 0, 0, 0.002, 0), options);
	const auto b = alignMoved(motion() + CPose3D(-0.004, 0, 0, 0, -0.002, 0), options);
	expectPoseNear(toPose(a.T_current_reference), toPose(b.T_current_reference), 5e-5, 5e-5);
}

TEST(DirectAlignment, IsNotMovedByAnotherExposure)
{
	const auto T = onPath(0);
	const auto reference = imageOf(frameAt(0, T));
	auto brighter = frameAt(0, T);
	brighter.color.convertTo(brighter.color, -1, 0.8, 15);
	const auto result = alignDirectly(
		selectAlignmentPoints(reference, 20000), imageOf(brighter), Eigen::Isometry3d::Identity(),
		{});
	ASSERT_TRUE(result.valid);
	expectPoseNear(toPose(result.T_current_reference), CPose3D(), 5e-4, 3e-4);
}

TEST(DirectAlignment, WithoutIterationsKeepsTheStartAndMeasuresItsInformation)
{
	DirectAlignmentOptions options;
	options.iterations = 0;
	const auto result = alignMoved(motion(), options);
	ASSERT_TRUE(result.valid);
	EXPECT_EQ(result.iterations, 0);
	expectPoseNear(toPose(result.T_current_reference), -motion(), 1e-9, 1e-9);
	const Eigen::SelfAdjointEigenSolver<Matrix6> solver(result.information);
	EXPECT_GT(solver.eigenvalues()(0), 0);
}

TEST(DirectAlignment, KnowsATurnBetterThanAShiftOfAsManyMetres)
{
	// A pixel flows by f per radian but by f / z per metre, and the room is more than 1 m away.
	const auto result = alignMoved(motion(), {});
	EXPECT_GT(result.information(4, 4), result.information(0, 0));
	EXPECT_GT(result.information(3, 3), result.information(1, 1));
}

TEST(DirectAlignment, IsInvalidWhenNothingIsSeenAgain)
{
	const auto result = alignMoved(CPose3D(0, 0, 0, 0, M_PI, 0), {});
	EXPECT_FALSE(result.valid);
}

TEST(DirectAlignment, SelectsNothingWithoutDepth)
{
	auto frame = frameAt(0, onPath(0));
	frame.depth.setTo(0);
	const auto image = imageOf(frame);
	EXPECT_TRUE(selectAlignmentPoints(image, 1000).empty());
	EXPECT_FALSE(alignDirectly({}, image, Eigen::Isometry3d::Identity(), {}).valid);
}

TEST(DirectAlignment, ThinsThePointsOutToTheNumberAskedFor)
{
	const auto image = imageOf(frameAt(0, onPath(0)));
	EXPECT_EQ(selectAlignmentPoints(image, 1000).size(), 1000u);
	EXPECT_GT(selectAlignmentPoints(image, 0).size(), 10000u);  // 0: all of them
}
}  // namespace
}  // namespace semloop::test

#include <mrpt/core/initializer.h>
#include <semloop/config/Error.h>
#include <semloop/odometry/OpenCvOdometry.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "CvOdometry.h"
#include "DirectAlignment.h"
#include "PoseAlgebra.h"

IMPLEMENTS_MRPT_OBJECT(OpenCvOdometry, Odometry, semloop)

MRPT_INITIALIZER(registerOpenCvOdometry)
{
	mrpt::rtti::registerClass(CLASS_ID(semloop::OpenCvOdometry));
}

namespace semloop
{
namespace
{
using mrpt::poses::CPose3D;

// What the normal equations do not know of: rolling shutter, colour and depth taken milliseconds
// apart, calibration. It grows with the motion.
constexpr double kFloorTranslation = 0.0005;  // [m]
constexpr double kFloorRotation = 0.0003;     // [rad]
constexpr double kShareOfMotion = 0.02;

constexpr char kOtherSize[] = "the image is of another size than those before";

/** Largest standard deviation in any direction of a 3x3 block. */
double largestSigma(const Eigen::Matrix3d& covariance)
{
	const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
	return std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff()));
}

/** scale * information^-1 + (floor + share of the motion)^2; empty when a direction is not measured
 *  at all. */
std::optional<Matrix6> covarianceFrom(
	const Matrix6& information, double scale, const CPose3D& T_keyframe_camera)
{
	const Eigen::LDLT<Matrix6> factor(information);
	if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 0)) return std::nullopt;
	const Matrix6 unmodelled = diagonalCovariance(
		kFloorTranslation + kShareOfMotion * T_keyframe_camera.norm(),
		kFloorRotation + kShareOfMotion * rotationAngle(T_keyframe_camera));
	const Matrix6 measured = factor.solve(Matrix6::Identity());
	const Matrix6 covariance = 0.5 * scale * (measured + measured.transpose()) + unmodelled;
	if (!covariance.allFinite()) return std::nullopt;
	return covariance;
}

std::string centimetres(double metres)
{
	return std::to_string(int(std::lround(metres * 100))) + " cm";
}

std::string degrees(double radians)
{
	return std::to_string(int(std::lround(mrpt::RAD2DEG(radians)))) + " degrees";
}
}  // namespace

/** A frame prepared for alignment; its caches are filled where they are needed. */
struct OpenCvOdometry::Frame
{
	mrpt::Clock::time_point time;
	mrpt::img::TCamera camera;
	cv::Ptr<cv::rgbd::OdometryFrame> cv;
	AlignmentImage image;
	std::vector<AlignmentPoint> points;
};

struct OpenCvOdometry::Alignment
{
	CPose3D T_keyframe_camera;
	Matrix6 covariance = Matrix6::Identity();
	double overlap = 0;
};

OpenCvOdometry::OpenCvOdometry(const OpenCvOdometryOptions& options) : options_(options)
{
	if (!(options_.minDepth < options_.maxDepth))
		throw UsageError(
			"odometry: min_depth " + std::to_string(options_.minDepth) + ", max_depth " +
			std::to_string(options_.maxDepth) + ": not allowed; use min_depth < max_depth");
}

void OpenCvOdometry::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	OpenCvOdometryOptions options;
	options.loadFromConfigFile(config, section);
	try
	{
		*this = OpenCvOdometry(options);
	}
	catch (const UsageError& e)
	{
		throw UsageError(configFileName(config) + ": [" + section + "]: " + e.what());
	}
}

std::string OpenCvOdometry::whyUnusable(const RgbdFrame& frame) const
{
	const cv::Size size = frame.depth.size();
	if (frame.color.type() != CV_8UC3 || frame.depth.type() != CV_32FC1 || size.empty())
		return "the frame has no colour or no depth image";
	if (frame.color.size() != size) return "colour and depth differ in size";
	const auto& camera = frame.camera;
	if (!(camera.fx() > 0) || !(camera.fy() > 0)) return "the camera has no focal length";

	if (keyframe_)
	{
		const cv::Size before = keyframe_->image.depth.size();
		if (size != before && lostFrames_ < options_.restartAfter) return kOtherSize;
	}
	const int valid =
		cv::countNonZero((frame.depth >= options_.minDepth) & (frame.depth <= options_.maxDepth));
	if (valid < options_.minValidDepth * size.area() || valid == 0)
		return "only " + std::to_string(valid) + " of " + std::to_string(size.area()) +
			   " pixels have depth in range";
	return {};
}

std::shared_ptr<const OpenCvOdometry::Frame> OpenCvOdometry::prepare(const RgbdFrame& frame) const
{
	auto result = std::make_shared<Frame>();
	result->time = frame.time;
	result->camera = frame.camera;
	cv::Mat gray;
	cv::cvtColor(frame.color, gray, cv::COLOR_BGR2GRAY);
	const cv::Mat depth = depthInRange(frame.depth, options_.minDepth, options_.maxDepth);
	result->cv = cv::rgbd::OdometryFrame::create(gray, depth);
	result->image = makeAlignmentImage(gray, depth);
	result->image.fx = frame.camera.fx();
	result->image.fy = frame.camera.fy();
	result->image.cx = frame.camera.cx();
	result->image.cy = frame.camera.cy();
	return result;
}

std::optional<OpenCvOdometry::Alignment> OpenCvOdometry::align(
	const Frame& frame, const std::string& method, const CPose3D& T_keyframe_camera,
	std::string& why) const
{
	const auto coarse = alignWithOpenCv(
		options_, method, frame.camera, keyframe_->cv, frame.cv, -T_keyframe_camera, why);
	if (!coarse) return std::nullopt;

	const DirectAlignmentOptions refinement{
		options_.refineIterations, options_.depthWeight, options_.maxDepthDifference};
	const auto refined =
		alignDirectly(keyframe_->points, frame.image, toIsometry(*coarse), refinement);
	if (!refined.valid || refined.overlap < options_.minOverlap)
	{
		why = "only " + std::to_string(int(100 * refined.overlap)) +
			  " % of the reference frame is seen again";
		return std::nullopt;
	}
	const CPose3D T_keyframe_refined = toPose(refined.T_current_reference.inverse());
	const auto covariance =
		covarianceFrom(refined.information, options_.covarianceScale, T_keyframe_refined);
	if (!covariance ||
		largestSigma(covariance->topLeftCorner<3, 3>()) > options_.maxSigmaTranslation ||
		largestSigma(covariance->bottomRightCorner<3, 3>()) > options_.maxSigmaRotation)
	{
		why = "too little texture and shape to measure the motion";
		return std::nullopt;
	}
	return Alignment{T_keyframe_refined, *covariance, refined.overlap};
}

std::optional<OpenCvOdometry::Alignment> OpenCvOdometry::alignFromSeveralStarts(
	const Frame& frame, const CPose3D& T_previous_camera, std::string& why) const
{
	// While lost the keyframe is the last good frame: the model may have run away from it.
	const CPose3D T_keyframe_previous = T_odom_previous_ - T_odom_keyframe_;
	const CPose3D T_keyframe_lastGood = lostFrames_ > 0 ? CPose3D() : T_keyframe_previous;
	const std::vector<CPose3D> starts{T_keyframe_previous + T_previous_camera, T_keyframe_lastGood};
	const double frames = lostFrames_ + 1;
	const std::vector<std::string> methods = options_.method == "automatic"
												 ? std::vector<std::string>{"rgbd", "rgbd_icp"}
												 : std::vector<std::string>{options_.method};
	for (const auto& method : methods)
		for (const auto& start : starts)
		{
			const auto alignment = align(frame, method, start, why);
			if (!alignment) continue;
			// More than the frames since the last good one allow: a wrong minimum.
			const CPose3D motion = alignment->T_keyframe_camera - T_keyframe_lastGood;
			const double angle = rotationAngle(motion);
			if (motion.norm() <= frames * options_.maxTranslation &&
				angle <= frames * options_.maxRotation)
				return alignment;
			why = "implausible motion of " + centimetres(motion.norm()) + " and " + degrees(angle);
		}
	return std::nullopt;
}

bool OpenCvOdometry::needsKeyframe(const Alignment& alignment) const
{
	return !options_.keyframes || lostFrames_ > 0 || alignment.overlap < options_.keyframeOverlap ||
		   alignment.T_keyframe_camera.norm() > options_.keyframeDistance ||
		   rotationAngle(alignment.T_keyframe_camera) > options_.keyframeAngle;
}

OdometryEstimate OpenCvOdometry::track(const RgbdFrame& frame)
{
	std::string why = whyUnusable(frame);
	if (!why.empty()) return lost(frame.time, why);

	const auto prepared = prepare(frame);
	if (keyframe_ && prepared->image.depth.size() != keyframe_->image.depth.size())
		why = kOtherSize;
	else if (keyframe_)
	{
		const auto alignment = alignFromSeveralStarts(*prepared, motion_.predict(frame.time), why);
		if (alignment) return tracked(prepared, *alignment);
	}
	return start(prepared, why);
}

OdometryEstimate OpenCvOdometry::tracked(
	const std::shared_ptr<const Frame>& frame, const Alignment& alignment)
{
	OdometryEstimate estimate;
	estimate.T_odom_camera = orthonormalized(T_odom_keyframe_ + alignment.T_keyframe_camera);
	estimate.T_previous_camera = orthonormalized(estimate.T_odom_camera - T_odom_previous_);
	estimate.covariance =
		alignment.covariance + covarianceSeenFrom(estimate.T_previous_camera, previousCovariance_);

	const bool renew = needsKeyframe(alignment);
	T_odom_previous_ = estimate.T_odom_camera;
	previousCovariance_ = alignment.covariance;
	// After a loss T_previous_camera mends the guesses: it is no velocity.
	if (lostFrames_ == 0)
		motion_.measured(frame->time, estimate.T_previous_camera);
	else
		motion_.stop(frame->time);
	lastGood_ = frame;
	lostFrames_ = 0;
	if (renew) makeKeyframe(frame);
	return estimate;
}

OdometryEstimate OpenCvOdometry::lost(mrpt::Clock::time_point time, const std::string& why)
{
	// The last good frame sees more of what comes back than an older keyframe.
	if (lostFrames_ == 0 && lastGood_) makeKeyframe(lastGood_);
	lostFrames_++;

	OdometryEstimate estimate;
	estimate.status = OdometryEstimate::Status::Lost;
	estimate.reason = why;
	estimate.T_previous_camera = motion_.predict(time);
	estimate.T_odom_camera = orthonormalized(T_odom_previous_ + estimate.T_previous_camera);
	estimate.covariance =
		diagonalCovariance(options_.lostSigmaTranslation, options_.lostSigmaRotation) +
		covarianceSeenFrom(estimate.T_previous_camera, previousCovariance_);

	T_odom_previous_ = estimate.T_odom_camera;
	previousCovariance_ = estimate.covariance;
	motion_.passed(time);
	return estimate;
}

OdometryEstimate OpenCvOdometry::start(
	const std::shared_ptr<const Frame>& frame, const std::string& why)
{
	OdometryEstimate estimate;
	if (keyframe_)
	{
		const bool renew = lostFrames_ >= options_.restartAfter;
		estimate = lost(frame->time, renew ? why + "; starting anew here" : why);
		if (!renew) return estimate;
	}
	else if (lostFrames_ > 0)
		estimate = lost(frame->time, "no frame before this one could be used; starting here");
	else
	{
		estimate.covariance = diagonalCovariance(kFloorTranslation, kFloorRotation);
		motion_.stop(frame->time);
	}
	lastGood_ = frame;
	lostFrames_ = 0;
	makeKeyframe(frame);
	return estimate;
}

void OpenCvOdometry::makeKeyframe(const std::shared_ptr<const Frame>& frame)
{
	auto keyframe = std::make_shared<Frame>(*frame);
	keyframe->points = selectAlignmentPoints(keyframe->image, options_.refinePoints);
	keyframe_ = keyframe;
	T_odom_keyframe_ = T_odom_previous_;
	previousCovariance_.setZero();
}
}  // namespace semloop

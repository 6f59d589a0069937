#pragma once

#include <mrpt/core/bits_math.h>
#include <semloop/config/Options.h>
#include <semloop/odometry/ConstantVelocity.h>
#include <semloop/odometry/Odometry.h>

#include <memory>
#include <optional>
#include <string>

namespace semloop
{
struct OpenCvOdometryOptions : Options
{
	std::string method = "automatic";
	int pyramidLevels = 4;
	int iterations = 7;
	double minDepth = 0.3;             //!< [m]
	double maxDepth = 4.0;             //!< [m]
	double maxDepthDifference = 0.07;  //!< [m]
	int refineIterations = 10;         //!< 0: OpenCV's result as it is
	int refinePoints = 12000;
	double depthWeight = 0.1;

	bool keyframes = true;
	double keyframeDistance = 0.15;              //!< [m]
	double keyframeAngle = mrpt::DEG2RAD(10.0);  //!< [rad]
	double keyframeOverlap = 0.6;

	double minValidDepth = 0.05;
	double minOverlap = 0.2;
	double maxTranslation = 0.3;                   //!< [m]
	double maxRotation = mrpt::DEG2RAD(20.0);      //!< [rad]
	double maxSigmaTranslation = 0.05;             //!< [m]
	double maxSigmaRotation = mrpt::DEG2RAD(3.0);  //!< [rad]
	int restartAfter = 30;

	double covarianceScale = 20;
	double lostSigmaTranslation = 0.05;             //!< [m]
	double lostSigmaRotation = mrpt::DEG2RAD(5.0);  //!< [rad]

protected:
	void describe(OptionFields& f) override;
};

/** Dense RGB-D odometry: OpenCV's (cv::rgbd: photometric after Steinbruecker et al., ICCV Workshops
 *  2011; point to plane after Newcombe et al., ISMAR 2011; or both), refined to a fraction of a pixel
 *  by a direct alignment (DVO: Kerl et al., ICRA and IROS 2013) that weighs brightness and point to
 *  plane. Where brightness alone finds no start, the method `automatic` takes both.
 *
 *  A frame is aligned with a keyframe, which is renewed when the camera has moved or turned away
 *  from it: between keyframes no drift adds up. Keyframes off: with the frame before.
 *
 *  Covariance: of the refinement's normal equations H, enlarged,
 *  C_keyframe,camera = covarianceScale * H^-1 + (floor + 2 % of the motion from the keyframe)^2; of
 *  two frames of one keyframe
 *  C = C_keyframe,camera + Ad(T_camera,previous) C_keyframe,previous Ad^T. Neighbouring frames share the
 *  keyframe's errors, so that a sum of such covariances over many frames is pessimistic; with
 *  keyframes off it is optimistic, as it takes the errors of neighbouring frames for independent.
 *
 *  Lost, and the constant-velocity model in its place, when: the frame cannot be used (no image,
 *  another size or camera, too little valid depth); OpenCV finds no solution; the motion against the
 *  model's last pose is larger than maxTranslation or maxRotation a frame; too little of the keyframe
 *  is seen again; or the scene leaves a motion open (covariance above maxSigma). The next frames are
 *  aligned with the last good one, starting from the model's pose and from the last good pose. After
 *  restartAfter lost frames the next usable frame becomes the new start, at the model's pose. */
class OpenCvOdometry : public Odometry
{
	DEFINE_MRPT_OBJECT(OpenCvOdometry, semloop)

public:
	OpenCvOdometry() = default;
	/** Throws UsageError when the options contradict each other. */
	explicit OpenCvOdometry(const OpenCvOdometryOptions& options);

	void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;

	OdometryEstimate track(const RgbdFrame& frame) override;

private:
	struct Frame;
	struct Alignment;
	using Matrix6 = Eigen::Matrix<double, 6, 6>;

	std::string whyUnusable(const RgbdFrame& frame) const;
	std::shared_ptr<const Frame> prepare(const RgbdFrame& frame) const;
	/** Empty, and why, when nothing plausible is found. */
	std::optional<Alignment> align(
		const Frame& frame, const std::string& method,
		const mrpt::poses::CPose3D& T_keyframe_camera, std::string& why) const;
	std::optional<Alignment> alignFromSeveralStarts(
		const Frame& frame, const mrpt::poses::CPose3D& T_previous_camera, std::string& why) const;
	bool needsKeyframe(const Alignment& alignment) const;

	OdometryEstimate tracked(const std::shared_ptr<const Frame>& frame, const Alignment& alignment);
	OdometryEstimate lost(mrpt::Clock::time_point time, const std::string& why);
	/** At a usable frame that could not be aligned: the first of all, or when lost for long. */
	OdometryEstimate start(const std::shared_ptr<const Frame>& frame, const std::string& why);
	void makeKeyframe(const std::shared_ptr<const Frame>& frame);

	OpenCvOdometryOptions options_;
	ConstantVelocity motion_;
	std::shared_ptr<const Frame> keyframe_;  //!< none before the first usable frame
	std::shared_ptr<const Frame> lastGood_;
	mrpt::poses::CPose3D T_odom_keyframe_;
	mrpt::poses::CPose3D T_odom_previous_;
	Matrix6 previousCovariance_ = Matrix6::Zero();  //!< of T_keyframe_previous
	int lostFrames_ = 0;
};

}  // namespace semloop

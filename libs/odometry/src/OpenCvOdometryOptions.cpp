#include <semloop/odometry/OpenCvOdometry.h>

namespace semloop
{
void OpenCvOdometryOptions::describe(OptionFields& f)
{
	f.choice(
		"method", method, {"automatic", "rgbd_icp", "rgbd", "icp"},
		"OpenCV's cost: rgbd = brightness, icp = point to plane, rgbd_icp = both; automatic = rgbd "
		"and, where that finds nothing, rgbd_icp");
	f.integer("pyramid_levels", pyramidLevels, 1, 6, "image sizes, each half the one before");
	f.integer("iterations", iterations, 1, 100, "Gauss-Newton iterations on each level");
	f.number("min_depth", minDepth, 0, 100, "nearer depth is not used [m]");
	f.number("max_depth", maxDepth, 0, 100, "farther depth is not used [m]");
	f.number(
		"max_depth_difference", maxDepthDifference, 1e-3, 10,
		"pixels whose depths differ by more are of different surfaces [m]");
	f.integer(
		"refine_iterations", refineIterations, 0, 100,
		"of the refinement to a fraction of a pixel; 0: OpenCV's result as it is");
	f.integer("refine_points", refinePoints, 500, 1000000, "pixels of the refinement");
	f.number(
		"depth_weight", depthWeight, 0, 10,
		"of the refinement's depth residuals; below 1 because their errors are not independent");
	f.flag("keyframes", keyframes, "align with a keyframe; false: with the frame before");
	f.number(
		"keyframe_distance", keyframeDistance, 0, 10,
		"from the keyframe at which the frame becomes the next one [m]");
	f.degrees("keyframe_angle_deg", keyframeAngle, 0, 180, "same, angle [deg]");
	f.number(
		"keyframe_overlap", keyframeOverlap, 0, 1,
		"share of the keyframe's pixels seen again below which the frame becomes the next one");
	f.number(
		"min_valid_depth", minValidDepth, 0, 1,
		"share of pixels with depth below which it is lost");
	f.number(
		"min_overlap", minOverlap, 0, 1,
		"share of the keyframe's pixels seen again below which it is lost");
	f.number(
		"max_translation", maxTranslation, 1e-3, 100, "between frames; more is implausible [m]");
	f.degrees(
		"max_rotation_deg", maxRotation, 0.1, 180, "between frames; more is implausible [deg]");
	f.number(
		"max_sigma_translation", maxSigmaTranslation, 1e-4, 100,
		"standard deviation in the worst direction above which it is lost [m]");
	f.degrees("max_sigma_rotation_deg", maxSigmaRotation, 1e-2, 180, "same, rotation [deg]");
	f.integer(
		"restart_after", restartAfter, 1, 1000000,
		"lost frames after which the next usable one becomes the new start");
	f.number(
		"covariance_scale", covarianceScale, 1, 1e6,
		"of the inverse normal equations: neighbouring pixels err together");
	f.number(
		"lost_sigma_translation", lostSigmaTranslation, 1e-4, 100,
		"standard deviation added by each lost frame [m]");
	f.degrees("lost_sigma_rotation_deg", lostSigmaRotation, 1e-2, 180, "same, rotation [deg]");
}
}  // namespace semloop

#include <semloop/slam/SlamOptions.h>

namespace semloop
{
void ModuleNames::describe(OptionFields& f)
{
	f.list("plugins", plugins, "shared objects with further modules, loaded first; paths with a /");
	f.text("segmenter", segmenter, "Segmenter: image -> instances");
	f.text("embedder", embedder, "Embedder: for instances that come without an embedding");
	f.text("odometry", odometry, "Odometry: frames -> relative poses");
	f.text("matching_cost", matchingCost, "MatchingCost: Eq. (3)");
	f.text("associator", associator, "Associator: detections -> objects, Eq. (1)");
	f.text("loop_detector", loopDetector, "LoopDetector: local map -> global map");
	f.text("pose_graph", poseGraph, "PoseGraph: back end, Eq. (7)");
}

void SlamOptions::describe(OptionFields& f)
{
	f.text(
		"confusion_matrix", confusionMatrix, "file of p(l_k given l_j); empty: identity smoothed");
	f.number("confusion_correct", confusionCorrect, 0.01, 1, "p(l given l) without a file");
	f.flag(
		"level", level, "use the accelerometer, when there is one, to make the world's z point up");
	f.integer(
		"frames_ahead", framesAhead, 0, 100,
		"frames read and segmented ahead in a thread of their own; 0: no thread");
	f.integer(
		"loop_every_frames", loopEveryFrames, 1, 100000,
		"segmented frames between two loop detections");
	f.integer(
		"maintain_every_frames", maintainEveryFrames, 1, 100000,
		"segmented frames between two clean-ups of the map");
	f.integer(
		"min_observations", minObservations, 1, 100000,
		"objects seen in fewer frames are left out of objects.json and objects/");
	f.number(
		"observation_sigma", observationSigma, 1e-4, 10,
		"of an object seen from a camera, e_oc [m]");
	f.degrees(
		"observation_sigma_deg", observationSigmaAngle, 0.01, 180,
		"of an object seen from a camera, e_oc");
	f.number(
		"max_drift_sigmas", maxDriftSigmas, 0, 1000,
		"a loop closure that corrects more than odometry can have drifted since its objects were "
		"seen, in standard deviations, is rejected; 0: no limit, and no prior for the detector");
	f.number(
		"key_pose_distance", keyPoseDistance, 0.01, 100,
		"a frame becomes a key pose of map.simplemap when no other is so near [m] ...");
	f.degrees(
		"key_pose_angle_deg", keyPoseAngle, 1, 180,
		"... and looks into a direction so near to its own");
	f.integer(
		"max_key_poses", maxKeyPoses, 2, 100000,
		"when there are more, every other one is dropped, and distance and angle are doubled");
	f.number(
		"scan_below", scanBelow, 0, 10,
		"the horizontal scan of a key pose, for maps that take no points, is of what is so far "
		"below "
		"the camera [m]");
	f.number("scan_above", scanAbove, 0, 10, "to so far above it [m]");
}

}  // namespace semloop

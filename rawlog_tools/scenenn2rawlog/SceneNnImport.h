#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/img/TCamera.h>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace semloop
{
struct SceneNnImport
{
	std::string oni;
	std::string rawlog;
	std::string trajectory;            //!< trajectory.log; empty: no ground truth
	std::string annotation;            //!< .xml; empty: no instances. Needs a trajectory.
	std::string mesh;                  //!< .ply; as the annotation
	std::vector<std::string> exclude;  //!< texts of the annotation that are no instances
	double tolerance = 0.05;           //!< of a pixel's point from the mesh [m]
	mrpt::Clock::time_point start;     //!< time of the first frame
	mrpt::img::TCamera camera;         //!< of colour and depth
	bool embed = false;                //!< images inside the rawlog
};

struct SceneNnReport
{
	std::size_t frames = 0;
	std::size_t unpairedColor = 0, unpairedDepth = 0;
	std::size_t poses = 0;                     //!< frames with a pose
	std::size_t objects = 0, objectsSeen = 0;  //!< of the annotation: in the mesh, in a frame
	std::size_t missingObjects = 0;            //!< of the annotation, but not in the mesh
	double shareOnMesh = 0;                    //!< of the depth pixels of frames with a pose
};

/** SceneNN's camera, an Asus Xtion Pro: 640x480 pixels, fx = fy = 544.47329, cx = 320, cy = 240, no
 *  distortion, depth registered to colour (README.md says from where). */
mrpt::img::TCamera sceneNnCamera();

/** Writes the recording as a rawlog of CObservation3DRangeScan ("RGBD"), images to <rawlog>_Images/ unless
 *  they are to be inside; X_groundtruth.tum, X_truth_instances.rawlog, X_objects.json and X_objects/ as
 *  rawlog-simulate does, as far as trajectory and annotation are there. Frame i has the i-th pose; frames
 *  without one are in the rawlog, but not in the truth.
 *
 *  Throws InputError on the first thing that is wrong, also when the files are not of one sequence: poses
 *  for more frames than there are or for less than half of them, or less than half of all depth pixels on
 *  the mesh. progress(frames, share) is called after each frame. */
SceneNnReport importSceneNn(
	const SceneNnImport& import, const std::function<void(std::size_t, double)>& progress);

}  // namespace semloop

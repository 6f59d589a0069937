#pragma once

#include <mrpt/core/bits_math.h>
#include <semloop/config/Options.h>

#include <string>
#include <vector>

namespace semloop
{
/** [modules]: which class does what. A name that is not registered stops with the list of those that
 *  are; plug-ins are loaded first. */
struct ModuleNames : Options
{
	std::vector<std::string> plugins;
	std::string segmenter = "semloop::RecordedSegmenter";
	std::string embedder = "semloop::ColorHistogramEmbedder";
	std::string odometry = "semloop::OpenCvOdometry";
	std::string matchingCost = "semloop::SemanticMatchingCost";
	std::string associator = "semloop::ObjectAssociator";
	std::string loopDetector = "semloop::SemanticLoopDetector";
	std::string poseGraph = "semloop::CeresPoseGraph";

protected:
	void describe(OptionFields& fields) override;
};

/** [slam]: what belongs to no single module. */
struct SlamOptions : Options
{
	std::string confusionMatrix;    //!< file; empty: identity smoothed
	double confusionCorrect = 0.9;  //!< p(l | l) without a file
	bool level = true;              //!< turn the world so that gravity points down -z
	int framesAhead = 4;  //!< frames read and segmented ahead in their own thread; 0: no thread
	int loopEveryFrames = 10;       //!< segmented frames between two loop detections
	int maintainEveryFrames = 30;   //!< segmented frames between two clean-ups of the map
	int minObservations = 5;        //!< objects seen in fewer frames are left out of the results
	double observationSigma = 0.2;  //!< of e_oc [m]
	double observationSigmaAngle = 0.2;         //!< of e_oc [rad]
	double maxDriftSigmas = 4.0;                //!< of a loop closure's correction; 0: no limit
	double keyPoseDistance = 0.3;               //!< between two key poses of map.simplemap [m], or
	double keyPoseAngle = mrpt::DEG2RAD(20.0);  //!< between their views [rad]
	int maxKeyPoses = 300;                      //!< of them; their images stay in memory
	double scanBelow = 0.1;  //!< of their horizontal scan: so far below the camera [m]
	double scanAbove = 0.1;  //!< and so far above it [m]

protected:
	void describe(OptionFields& fields) override;
};

}  // namespace semloop

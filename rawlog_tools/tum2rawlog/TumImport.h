#pragma once

#include <mrpt/img/TCamera.h>

#include <cstddef>
#include <functional>
#include <string>

namespace semloop
{
struct TumImport
{
	std::string directory;
	std::string rawlog;
	mrpt::img::TCamera camera;
	double maxTimeDifference = 0.02;  //!< between the colour and the depth image of a frame [s]
	bool embed = false;               //!< images inside the rawlog, colour lossless
};

struct TumImportReport
{
	std::size_t pairs = 0;
	std::size_t unpairedColor = 0;
	std::size_t unpairedDepth = 0;
	std::size_t groundTruthPoses = 0;
	std::size_t accelerations = 0;
};

/** Writes the sequence as a rawlog of CObservation3DRangeScan ("RGBD", with the time of the colour
 *  image, as the benchmark's evaluation has it; depth bit by bit, 5000 = 1 m) and CObservationIMU
 *  ("ACCEL"), in order of time; images to <rawlog>_Images/ unless they are to be inside, the ground
 *  truth to <rawlog>_groundtruth.tum. Throws InputError on the first thing that is wrong with the
 *  sequence. progress(frames, share) is called after each frame. */
TumImportReport importTum(
	const TumImport& import, const std::function<void(std::size_t, double)>& progress);

}  // namespace semloop

#pragma once

#include <mrpt/core/Clock.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace semloop
{
/** A line of rgb.txt or depth.txt. */
struct TumImage
{
	mrpt::Clock::time_point time;
	std::string path;
};

/** A line of accelerometer.txt. */
struct TumAcceleration
{
	mrpt::Clock::time_point time;
	std::array<double, 3>
		acceleration{};  //!< [m/s^2], in the Kinect's axes: x left, y up, z forward
};

/** The lists of a sequence of the TUM RGB-D benchmark (Sturm et al., IROS 2012), each in order of
 *  time. */
struct TumDirectory
{
	std::vector<TumImage> color;
	std::vector<TumImage> depth;
	std::vector<TumAcceleration> accelerations;  //!< empty without accelerometer.txt
	std::string groundTruthPath;                 //!< empty without groundtruth.txt
};

/** Throws InputError when the folder or a list of images is missing, and on a bad line, naming file
 *  and line. Images are not looked at. */
TumDirectory readTumDirectory(const std::string& path);

/** Indices into the lists of a colour and a depth image. */
struct TumPair
{
	std::size_t color = 0;
	std::size_t depth = 0;
};

/** Pairs one to one by nearest time: of all pairs at most maxDifference [s] apart the closest comes
 *  first and takes its two images away, and so on, as the benchmark's own tools do. In order of the
 *  colour images. */
std::vector<TumPair> pairByTime(
	const std::vector<TumImage>& color, const std::vector<TumImage>& depth, double maxDifference);

}  // namespace semloop

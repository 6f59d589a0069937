#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/img/TCamera.h>
#include <mrpt/obs/CObservation3DRangeScan.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <optional>
#include <string>

namespace semloop
{
/** A colour and a depth image that were taken together, of the same size. */
struct OniFrame
{
	std::chrono::microseconds time{0};  //!< of the depth image, since the first image
	cv::Mat color;                      //!< CV_8UC3, BGR
	cv::Mat depth;                      //!< CV_16UC1, in OniRecording::depthUnit(); 0 = invalid
};

/** How the images of a recording become frames. */
struct OniReading
{
	bool keepMirrored = false;  //!< else mirrored images are turned back
	/** Greedy pairs: the next image of one kind with the next of the other, when so close, else the
	 *  earlier one is dropped. Without it each with the nearest within half a frame's period. */
	std::optional<std::chrono::microseconds> greedyWithin;
};

/** Reads the frames of an .oni, a recording of OpenNI2's or OpenNI 1's, one by one and as fast as they
 *  can be decoded. Depth comes as it was stored, bit by bit.
 *
 *  Images are paired by time, each with the nearest within half a frame's period: their indices slip
 *  where the camera lost an image of one kind only. Mirrored recordings are turned back.
 *
 *  A process can have a file open once at a time: OpenNI2 knows it by its name.
 *
 *  The format does not say whether depth was registered to colour. It is taken to be: recording it so is
 *  what Device::setImageRegistrationMode() is for. */
class OniRecording
{
public:
	/** Throws InputError when the file is missing, no .oni, cut so that OpenNI2 does not open it, without
	 *  depth or colour, or when these differ in size or are in a format that is not known here. */
	explicit OniRecording(const std::string& path, const OniReading& reading = {});
	~OniRecording();
	OniRecording(OniRecording&&) noexcept;
	OniRecording& operator=(OniRecording&&) noexcept;

	/** The next pair; empty at the end of the recording. Throws InputError when the file is cut or
	 *  damaged here; what came before stays good. */
	std::optional<OniFrame> next();

	const std::string& path() const;
	cv::Size size() const;  //!< of all images
	/** What one unit of depth is, 0.001 or 0.0001 [m]. */
	float depthUnit() const;
	/** Intrinsics of the colour camera, hence of both images, as its field of view tells: f = size /
	 *  (2 tan(fov / 2)), the principal point in the middle, no distortion. OpenNI2 does not know
	 *  better. Throws InputError when the recording does not tell. */
	mrpt::img::TCamera camera() const;

	/** Images without partner, among those read so far. */
	std::size_t unpairedColor() const;
	std::size_t unpairedDepth() const;
	/** Share of the recording that was read, in [0, 1]; 0 when it does not tell its length. */
	double progress() const;

private:
	struct Impl;
	std::unique_ptr<Impl> impl_;
};

/** The frames of a recording as range scans that rgbdFrameFrom() takes ("RGBD"), images inside. */
class OniScans
{
public:
	/** The camera is that of both images, the recording's unless given; the first scan gets the time `start`.
	 *  Throws InputError when the camera is for images of another size, and as OniRecording::camera(). */
	OniScans(
		OniRecording recording, const std::optional<mrpt::img::TCamera>& camera,
		mrpt::Clock::time_point start);

	/** The next one; null at the end. Throws InputError as OniRecording::next(), and when there is none. */
	mrpt::obs::CObservation3DRangeScan::Ptr next();

	const OniRecording& recording() const { return recording_; }

private:
	OniRecording recording_;
	const mrpt::img::TCamera camera_;
	const mrpt::Clock::time_point start_;
	std::optional<std::chrono::microseconds> firstTime_;
};

}  // namespace semloop

#pragma once

#include <OpenNI.h>

#include <atomic>
#include <chrono>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>

namespace semloop
{
/** An image of a recording. */
struct OniImage
{
	bool isDepth = false;
	std::chrono::microseconds time{0};  //!< since the first image
	cv::Mat pixels;                     //!< CV_8UC3, BGR, or CV_16UC1, as stored
};

/** Knows when OpenNI2 has played a recording to its end. */
class OniEndListener : public openni::OpenNI::DeviceStateChangedListener
{
public:
	/** The name that the recording is opened by. */
	explicit OniEndListener(const std::string& name);
	~OniEndListener() override;
	OniEndListener(const OniEndListener&) = delete;
	OniEndListener& operator=(const OniEndListener&) = delete;

	void onDeviceStateChanged(const openni::DeviceInfo* info, openni::DeviceState state) override;
	bool ended() const { return ended_; }

private:
	const std::string name_;
	std::atomic<bool> ended_{false};
};

/** Plays an .oni with OpenNI2, which has a thread of its own for it: the images one by one, of both kinds
 *  as they come. Errors are those of OniRecording. */
class OniPlayer
{
public:
	OniPlayer(const std::string& path, bool keepMirrored);

	/** Empty at the end of the recording, and from then on. */
	std::optional<OniImage> next();

	const std::string& path() const { return path_; }
	/** Of all images. */
	cv::Size size() const { return size_; }
	/** Of the colour camera, horizontal and vertical [rad]. */
	cv::Vec2d fieldOfView() const { return fieldOfView_; }
	/** [m] */
	float depthUnit() const { return depthUnit_; }
	/** Of the kind with more frames a second. */
	std::chrono::microseconds period() const { return period_; }
	/** As OniRecording's. */
	double progress() const;

private:
	/** Closes in an order that the player's thread survives, also when a constructor throws. */
	struct Playback
	{
		~Playback() { close(); }
		void close();

		std::chrono::steady_clock::time_point opened;
		openni::Device device;
		openni::VideoStream depth, color;
	};

	void open(openni::VideoStream& stream, openni::SensorType type, const std::string& kind);
	OniImage read(bool isDepth);

	const std::string path_;
	const bool keepMirrored_;
	const std::string name_;
	const OniEndListener end_;
	Playback playback_;
	cv::Size size_;
	cv::Vec2d fieldOfView_;
	float depthUnit_ = 0;
	std::chrono::microseconds period_{0};
	std::chrono::microseconds origin_{0};
	int images_ = 0;  //!< in the whole recording, when it tells
	std::size_t imagesRead_ = 0;
	bool atEnd_ = false;
};

}  // namespace semloop

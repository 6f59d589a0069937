#include "OniPlayer.h"

#include <semloop/config/Error.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "OpenNi2.h"

namespace semloop
{
namespace
{
namespace fs = std::filesystem;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr auto kPatience = std::chrono::seconds(5);  // a file that gives nothing for so long is cut
constexpr int kWait = 200;                           // for one image [ms]

/** The name that OpenNI2 shall open. It does not tell why it does not. */
std::string requireOni(const std::string& path)
{
	if (!fs::is_regular_file(path))
		throw InputError(path + ": no such file: give a recording of OpenNI2, *.oni");
	std::string magic(4, '\0');
	std::ifstream(path, std::ios::binary).read(magic.data(), 4);
	if (magic != "NI10")
		throw InputError(path + ": no recording of OpenNI2: an .oni begins with NI10");
	const std::string name = fs::absolute(path).lexically_normal().string();
	if (name.size() >= ONI_MAX_STR)
		throw InputError(
			name + ": OpenNI2 opens only names shorter than " + std::to_string(ONI_MAX_STR) +
			" characters: move the file");
	return name;
}

float metresPerUnit(const std::string& path, openni::PixelFormat format)
{
	switch (format)
	{
		case openni::PIXEL_FORMAT_DEPTH_1_MM:
			return 1e-3f;
		case openni::PIXEL_FORMAT_DEPTH_100_UM:
			return 1e-4f;
		default:
			throw InputError(
				path + ": its depth is not in millimetres or tenths of them (pixel format " +
				std::to_string(format) + "): record it as DEPTH_1_MM");
	}
}

int colorType(const std::string& path, openni::PixelFormat format)
{
	switch (format)
	{
		case openni::PIXEL_FORMAT_RGB888:
			return CV_8UC3;
		case openni::PIXEL_FORMAT_YUV422:
		case openni::PIXEL_FORMAT_YUYV:
			return CV_8UC2;
		case openni::PIXEL_FORMAT_GRAY8:
			return CV_8UC1;
		default:
			throw InputError(
				path + ": the format of its colour images is not known (pixel format " +
				std::to_string(format) + "): record them as RGB888");
	}
}

cv::Mat bgrFrom(const cv::Mat& image, openni::PixelFormat format)
{
	cv::Mat bgr;
	switch (format)
	{
		case openni::PIXEL_FORMAT_YUV422:
			cv::cvtColor(image, bgr, cv::COLOR_YUV2BGR_UYVY);
			break;
		case openni::PIXEL_FORMAT_YUYV:
			cv::cvtColor(image, bgr, cv::COLOR_YUV2BGR_YUY2);
			break;
		case openni::PIXEL_FORMAT_GRAY8:
			cv::cvtColor(image, bgr, cv::COLOR_GRAY2BGR);
			break;
		default:
			cv::cvtColor(image, bgr, cv::COLOR_RGB2BGR);
	}
	return bgr;
}

cv::Size sizeOf(const openni::VideoMode& mode)
{
	return {mode.getResolutionX(), mode.getResolutionY()};
}

std::string text(cv::Size size)
{
	return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace

OniEndListener::OniEndListener(const std::string& name) : name_(name)
{
	startOpenNi2();
	openni::OpenNI::addDeviceStateChangedListener(this);
}

OniEndListener::~OniEndListener()
{
	openni::OpenNI::removeDeviceStateChangedListener(this);
}

void OniEndListener::onDeviceStateChanged(const openni::DeviceInfo* info, openni::DeviceState state)
{
	if (state == openni::DEVICE_STATE_EOF && name_ == info->getUri()) ended_ = true;
}

OniPlayer::OniPlayer(const std::string& path, bool keepMirrored)
	: path_(path), keepMirrored_(keepMirrored), name_(requireOni(path)), end_(name_)
{
	playback_.opened = Clock::now();
	if (playback_.device.open(name_.c_str()) != openni::STATUS_OK)
		throw InputError(
			path + ": OpenNI2 cannot open it: the file was cut or is damaged; copy it again");
	// Every ten milliseconds from now on the player's thread looks through the streams, unlocked.
	std::this_thread::sleep_for(milliseconds(3));
	open(playback_.depth, openni::SENSOR_DEPTH, "depth");
	open(playback_.color, openni::SENSOR_COLOR, "colour");
	const auto depthMode = playback_.depth.getVideoMode(),
			   colorMode = playback_.color.getVideoMode();
	size_ = sizeOf(colorMode);
	if (sizeOf(depthMode) != size_)
		throw InputError(
			path + ": colour of " + text(size_) + " and depth of " + text(sizeOf(depthMode)) +
			" pixels: record both in one size");
	depthUnit_ = metresPerUnit(path, depthMode.getPixelFormat());
	colorType(path, colorMode.getPixelFormat());
	fieldOfView_ = {
		playback_.color.getHorizontalFieldOfView(), playback_.color.getVerticalFieldOfView()};

	const int rate = std::max(depthMode.getFps(), colorMode.getFps());
	period_ = microseconds(1'000'000 / (rate > 0 ? rate : 30));
	auto* const control = playback_.device.getPlaybackControl();
	control->setRepeatEnabled(false);
	control->setSpeed(-1);  // an image each time that one is asked for
	images_ =
		control->getNumberOfFrames(playback_.depth) + control->getNumberOfFrames(playback_.color);
	if (playback_.depth.start() != openni::STATUS_OK ||
		playback_.color.start() != openni::STATUS_OK)
		throw InputError(path + ": OpenNI2 cannot play it: the file is damaged; copy it again");
}

void OniPlayer::open(openni::VideoStream& stream, openni::SensorType type, const std::string& kind)
{
	if (!playback_.device.hasSensor(type) ||
		stream.create(playback_.device, type) != openni::STATUS_OK)
		throw InputError(path_ + ": has no " + kind + " images: record depth and colour together");
}

/** The player's thread gives an image once more when the device is closed; it looks through the streams
 *  without a lock, so that they must outlive it; and it does not end when it is told to before it has
 *  begun. */
void OniPlayer::Playback::close()
{
	depth.stop();
	color.stop();
	std::this_thread::sleep_until(opened + milliseconds(100));
	device.close();
	depth.destroy();
	color.destroy();
}

std::optional<OniImage> OniPlayer::next()
{
	const auto giveUp = Clock::now() + kPatience;
	while (!atEnd_)
	{
		// The end is told after the last image.
		const bool ended = end_.ended();
		openni::VideoStream* streams[] = {&playback_.depth, &playback_.color};
		int which = 0;
		if (openni::OpenNI::waitForAnyStream(streams, 2, &which, ended ? 1 : kWait) ==
			openni::STATUS_OK)
			return read(which == 0);
		atEnd_ = ended;
		if (atEnd_)
			playback_.close();  // its thread would go on asking for more
		else if (Clock::now() > giveUp)
			throw InputError(
				path_ + ": cut or damaged after image " + std::to_string(imagesRead_) +
				": what comes before is good; copy the file again");
	}
	return std::nullopt;
}

OniImage OniPlayer::read(bool isDepth)
{
	openni::VideoStream& stream = isDepth ? playback_.depth : playback_.color;
	const std::string image = path_ + ": image " + std::to_string(imagesRead_ + 1);
	openni::VideoFrameRef frame;
	if (stream.readFrame(&frame) != openni::STATUS_OK || !frame.isValid())
		throw InputError(image + " cannot be read: the file is damaged; copy it again");
	const auto format = frame.getVideoMode().getPixelFormat();
	const int type = isDepth ? CV_16UC1 : colorType(path_, format);
	const cv::Size size(frame.getWidth(), frame.getHeight());
	const int stride = frame.getStrideInBytes();
	if (size != size_ || stride < size.width * int(CV_ELEM_SIZE(type)) ||
		frame.getDataSize() < stride * size.height)
		throw InputError(
			image + " is of " + text(size) + " pixels and not of " + text(size_) +
			": record without cropping, or copy the file again if it is damaged");

	const cv::Mat view(
		size, type, const_cast<void*>(frame.getData()), std::size_t(stride));  // not written
	cv::Mat pixels = isDepth ? view.clone() : bgrFrom(view, format);
	if (stream.getMirroringEnabled() && !keepMirrored_) cv::flip(pixels, pixels, 1);
	const microseconds time(int64_t(frame.getTimestamp()));
	if (imagesRead_++ == 0) origin_ = time;
	return {isDepth, time - origin_, pixels};
}

double OniPlayer::progress() const
{
	if (images_ <= 0) return 0;
	return std::min(1.0, double(imagesRead_) / images_);
}

}  // namespace semloop

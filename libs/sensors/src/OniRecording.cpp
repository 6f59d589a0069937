// OpenNI's headers want the name that compilers had before they knew of standards.
#ifndef linux
#define linux 1
#endif
#include <OpenNI.h>
#include <semloop/config/Error.h>
#include <semloop/observations/CameraFrames.h>
#include <semloop/sensors/OniRecording.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <deque>
#include <filesystem>
#include <fstream>
#include <opencv2/imgproc.hpp>
#include <thread>

namespace semloop
{
namespace
{
namespace fs = std::filesystem;
using std::chrono::microseconds;
using Clock = std::chrono::steady_clock;

constexpr auto kPatience = std::chrono::seconds(5);  // a file that gives nothing for so long is cut
constexpr int kWait = 200;                           // for one image [ms]
constexpr std::size_t kLongestQueue = 60;            // images of one kind without any of the other
constexpr float kLongestRange = 10.0f;               // of the cameras that OpenNI2 knows [m]

/** Sets OpenNI2 up once for the process: each time its drivers look through all of USB. */
void requireLibrary()
{
	static const openni::Status status = openni::OpenNI::initialize();
	if (status != openni::STATUS_OK)
		throw InputError(
			"OpenNI2 has no drivers: install the package libopenni2-0, or look at the folder "
			"OpenNI2/Drivers beside libOpenNI2.so.0");
}

/** Knows when a recording has been played to its end. */
class EndListener : public openni::OpenNI::DeviceStateChangedListener
{
public:
	explicit EndListener(const std::string& path) : path_(path)
	{
		requireLibrary();
		openni::OpenNI::addDeviceStateChangedListener(this);
	}
	~EndListener() override { openni::OpenNI::removeDeviceStateChangedListener(this); }
	EndListener(const EndListener&) = delete;
	EndListener& operator=(const EndListener&) = delete;

	void onDeviceStateChanged(const openni::DeviceInfo* info, openni::DeviceState state) override
	{
		if (state == openni::DEVICE_STATE_EOF && path_ == info->getUri()) ended_ = true;
	}
	bool ended() const { return ended_; }

private:
	const std::string path_;
	std::atomic<bool> ended_{false};
};

/** What OpenNI2 plays a file with, in a thread of its own. */
struct Player
{
	~Player() { close(); }

	/** In an order that the thread survives: it gives an image once more when the device is closed; it
	 *  looks through the streams without a lock, so that they must outlive it; and it does not end when
	 *  it is told to before it has begun. */
	void close()
	{
		depth.stop();
		color.stop();
		std::this_thread::sleep_until(opened + std::chrono::milliseconds(100));
		device.close();
		depth.destroy();
		color.destroy();
	}

	Clock::time_point opened;
	openni::Device device;
	openni::VideoStream depth, color;
};

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

struct TimedImage
{
	microseconds time;
	cv::Mat image;
};

/** Images of one kind that wait for their partners. */
struct Queue
{
	std::deque<TimedImage> images;
	std::size_t unpaired = 0;

	void dropFirst()
	{
		images.pop_front();
		++unpaired;
	}
};

}  // namespace

struct OniRecording::Impl
{
	Impl(const std::string& file, const OniReading& itsReading)
		: path(file), reading(itsReading), name(requireOni(file)), end(name)
	{
		player.opened = Clock::now();
		if (player.device.open(name.c_str()) != openni::STATUS_OK)
			throw InputError(
				path + ": OpenNI2 cannot open it: the file was cut or is damaged; copy it again");
		// Every ten milliseconds from now on the player's thread looks through the streams, unlocked.
		std::this_thread::sleep_for(std::chrono::milliseconds(3));
		open(player.depth, openni::SENSOR_DEPTH, "depth");
		open(player.color, openni::SENSOR_COLOR, "colour");
		const auto depthMode = player.depth.getVideoMode(), colorMode = player.color.getVideoMode();
		size = sizeOf(colorMode);
		if (sizeOf(depthMode) != size)
			throw InputError(
				path + ": colour of " + text(size) + " and depth of " + text(sizeOf(depthMode)) +
				" pixels: record both in one size");
		unit = metresPerUnit(path, depthMode.getPixelFormat());
		colorType(path, colorMode.getPixelFormat());
		fieldOfView = {
			player.color.getHorizontalFieldOfView(), player.color.getVerticalFieldOfView()};

		const int rate = std::max(depthMode.getFps(), colorMode.getFps());
		halfPeriod = microseconds(500'000 / (rate > 0 ? rate : 30));
		auto* const playback = player.device.getPlaybackControl();
		playback->setRepeatEnabled(false);
		playback->setSpeed(-1);  // an image each time that one is asked for
		images =
			playback->getNumberOfFrames(player.depth) + playback->getNumberOfFrames(player.color);
		if (player.depth.start() != openni::STATUS_OK || player.color.start() != openni::STATUS_OK)
			throw InputError(path + ": OpenNI2 cannot play it: the file is damaged; copy it again");
	}

	void open(openni::VideoStream& stream, openni::SensorType type, const std::string& kind)
	{
		if (!player.device.hasSensor(type) ||
			stream.create(player.device, type) != openni::STATUS_OK)
			throw InputError(
				path + ": has no " + kind + " images: record depth and colour together");
	}

	/** Puts the next image of either kind into its queue. False at the end of the recording. */
	bool read()
	{
		const auto giveUp = Clock::now() + kPatience;
		while (true)
		{
			// The end is told after the last image.
			const bool ended = end.ended();
			openni::VideoStream* streams[] = {&player.depth, &player.color};
			int which = 0;
			if (openni::OpenNI::waitForAnyStream(streams, 2, &which, ended ? 1 : kWait) ==
				openni::STATUS_OK)
			{
				take(which == 0);
				return true;
			}
			if (ended) return false;
			if (Clock::now() > giveUp)
				throw InputError(
					path + ": cut or damaged after image " + std::to_string(imagesRead) +
					": what comes before is good; copy the file again");
		}
	}

	void take(bool isDepth)
	{
		openni::VideoStream& stream = isDepth ? player.depth : player.color;
		openni::VideoFrameRef frame;
		if (stream.readFrame(&frame) != openni::STATUS_OK || !frame.isValid())
			throw InputError(
				path + ": image " + std::to_string(imagesRead + 1) +
				" cannot be read: the file is damaged; copy it again");
		const auto format = frame.getVideoMode().getPixelFormat();
		const int type = isDepth ? CV_16UC1 : colorType(path, format);
		const cv::Size read(frame.getWidth(), frame.getHeight());
		const int stride = frame.getStrideInBytes();
		if (read != size || stride < size.width * int(CV_ELEM_SIZE(type)) ||
			frame.getDataSize() < stride * size.height)
			throw InputError(
				path + ": image " + std::to_string(imagesRead + 1) + " is of " + text(read) +
				" pixels and not of " + text(size) +
				": record without cropping, or copy the file again if it is damaged");

		const cv::Mat view(
			size, type, const_cast<void*>(frame.getData()), std::size_t(stride));  // not written
		cv::Mat image = isDepth ? view.clone() : bgrFrom(view, format);
		if (stream.getMirroringEnabled() && !reading.keepMirrored) cv::flip(image, image, 1);
		const microseconds time(int64_t(frame.getTimestamp()));
		if (imagesRead++ == 0) origin = time;
		(isDepth ? depths : colors).images.push_back({time - origin, image});
	}

	/** Reads until both kinds have their next two images, as far as there are any. */
	bool readAhead()
	{
		while (!atEnd && std::min(depths.images.size(), colors.images.size()) < 2)
		{
			atEnd = !read();
			if (atEnd) player.close();  // its thread would go on asking for more
			for (Queue* queue : {&depths, &colors})
				if (queue->images.size() > kLongestQueue) queue->dropFirst();
		}
		return !depths.images.empty() && !colors.images.empty();
	}

	std::optional<OniFrame> nextPair()
	{
		while (readAhead())
		{
			const TimedImage& d = depths.images.front();
			const TimedImage& c = colors.images.front();
			Queue& earlier = d.time <= c.time ? depths : colors;
			const auto gap = std::chrono::abs(d.time - c.time);
			const auto later = std::max(d.time, c.time);
			const bool successorIsNearer =
				earlier.images.size() > 1 && std::chrono::abs(earlier.images[1].time - later) < gap;
			if (reading.greedyWithin ? gap <= *reading.greedyWithin
									 : gap <= halfPeriod && !successorIsNearer)
			{
				OniFrame frame{d.time, c.image, d.image};
				depths.images.pop_front();
				colors.images.pop_front();
				return frame;
			}
			earlier.dropFirst();
		}
		for (Queue* queue : {&depths, &colors})
			while (!queue->images.empty()) queue->dropFirst();
		return std::nullopt;
	}

	const std::string path;
	const OniReading reading;
	const std::string name;
	const EndListener end;
	Player player;
	cv::Size size;          // of all images
	cv::Vec2d fieldOfView;  // of the colour camera, horizontal and vertical [rad]
	float unit = 0;
	microseconds halfPeriod{0};
	microseconds origin{0};
	int images = 0;  // in the whole recording, when it tells
	std::size_t imagesRead = 0;
	Queue depths, colors;
	bool atEnd = false;
};

OniRecording::OniRecording(const std::string& path, const OniReading& reading)
	: impl_(std::make_unique<Impl>(path, reading))
{
}
OniRecording::~OniRecording() = default;
OniRecording::OniRecording(OniRecording&&) noexcept = default;
OniRecording& OniRecording::operator=(OniRecording&&) noexcept = default;

std::optional<OniFrame> OniRecording::next()
{
	return impl_->nextPair();
}

const std::string& OniRecording::path() const
{
	return impl_->path;
}

float OniRecording::depthUnit() const
{
	return impl_->unit;
}

mrpt::img::TCamera OniRecording::camera() const
{
	const double horizontal = impl_->fieldOfView[0], vertical = impl_->fieldOfView[1];
	if (!(horizontal > 0 && horizontal < M_PI && vertical > 0 && vertical < M_PI))
		throw InputError(
			impl_->path +
			": does not tell the camera's field of view: give a file with the "
			"camera's intrinsics");
	const cv::Size size = impl_->size;
	mrpt::img::TCamera camera;
	camera.ncols = uint32_t(size.width);
	camera.nrows = uint32_t(size.height);
	camera.setIntrinsicParamsFromValues(
		size.width / (2 * std::tan(horizontal / 2)), size.height / (2 * std::tan(vertical / 2)),
		0.5 * (size.width - 1), 0.5 * (size.height - 1));
	return camera;
}

std::size_t OniRecording::unpairedColor() const
{
	return impl_->colors.unpaired;
}

std::size_t OniRecording::unpairedDepth() const
{
	return impl_->depths.unpaired;
}

double OniRecording::progress() const
{
	if (impl_->images <= 0) return 0;
	return std::min(1.0, double(impl_->imagesRead) / impl_->images);
}

mrpt::obs::CObservation3DRangeScan::Ptr rangeScanFrom(
	const OniFrame& frame, float depthUnit, const mrpt::img::TCamera& camera)
{
	auto scan = mrpt::obs::CObservation3DRangeScan::Create();
	scan->cameraParams = scan->cameraParamsIntensity = camera;
	scan->relativePoseIntensityWRTDepth = sensorFromCamera();
	scan->range_is_depth = true;
	scan->rangeUnits = depthUnit;
	scan->maxRange = kLongestRange;
	scan->hasRangeImage = true;
	scan->rangeImage.resize(frame.depth.rows, frame.depth.cols);
	for (int row = 0; row < frame.depth.rows; ++row)
		std::copy_n(frame.depth.ptr<uint16_t>(row), frame.depth.cols, &scan->rangeImage(row, 0));
	scan->hasIntensityImage = true;
	scan->intensityImage = mrpt::img::CImage(frame.color, mrpt::img::SHALLOW_COPY);
	return scan;
}

}  // namespace semloop

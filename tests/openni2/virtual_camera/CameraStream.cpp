#include "CameraStream.h"

#include <algorithm>
#include <cstring>

#include "Property.h"

namespace semloop::virtual_camera
{
namespace
{
bool isSame(const OniVideoMode& a, const OniVideoMode& b)
{
	return a.pixelFormat == b.pixelFormat && a.resolutionX == b.resolutionX &&
		   a.resolutionY == b.resolutionY && a.fps == b.fps;
}

int pixelSize(const OniVideoMode& mode)
{
	if (mode.pixelFormat == ONI_PIXEL_FORMAT_RGB888) return 3;
	return mode.pixelFormat == ONI_PIXEL_FORMAT_GRAY8 ? 1 : 2;
}
}  // namespace

CameraStream::CameraStream(const OniSensorInfo& sensor, cv::Vec2f fieldOfView)
	: sensor_(sensor), fieldOfView_(fieldOfView), mode_(sensor.pSupportedVideoModes[0])
{
}

OniStatus CameraStream::start()
{
	running_ = true;
	return ONI_STATUS_OK;
}

OniVideoMode CameraStream::mode() const
{
	const std::lock_guard lock(mutex_);
	return mode_;
}

void CameraStream::send(const cv::Mat& image, int index, uint64_t microseconds)
{
	const OniVideoMode mode = this->mode();
	// The library makes room for images of the mode.
	if (!running_ || image.size() != cv::Size(mode.resolutionX, mode.resolutionY) ||
		int(image.elemSize()) != pixelSize(mode))
		return;
	OniFrame* const frame = getServices().acquireFrame();
	if (!frame) return;
	const std::size_t bytes = image.total() * image.elemSize();
	cv::Mat sent(image.size(), image.type(), frame->data);
	if (mirrored_)
		cv::flip(image, sent, 1);
	else
		image.copyTo(sent);
	frame->dataSize = int(bytes);
	frame->sensorType = type();
	frame->timestamp = microseconds;
	frame->frameIndex = index;
	frame->width = image.cols;
	frame->height = image.rows;
	frame->videoMode = mode;
	frame->croppingEnabled = FALSE;
	frame->cropOriginX = frame->cropOriginY = 0;
	frame->stride = int(image.cols * int(image.elemSize()));
	raiseNewFrame(frame);
	getServices().releaseFrame(frame);
}

OniBool CameraStream::isPropertySupported(int id)
{
	for (const int known :
		 {ONI_STREAM_PROPERTY_VIDEO_MODE, ONI_STREAM_PROPERTY_HORIZONTAL_FOV,
		  ONI_STREAM_PROPERTY_VERTICAL_FOV, ONI_STREAM_PROPERTY_MIRRORING,
		  ONI_STREAM_PROPERTY_MAX_VALUE, ONI_STREAM_PROPERTY_MIN_VALUE, ONI_STREAM_PROPERTY_STRIDE,
		  ONI_STREAM_PROPERTY_CROPPING})
		if (id == known) return TRUE;
	return FALSE;
}

OniStatus CameraStream::getProperty(int id, void* data, int* size)
{
	switch (id)
	{
		case ONI_STREAM_PROPERTY_VIDEO_MODE:
			return give(mode(), data, size);
		case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
			return give(fieldOfView_[0], data, size);
		case ONI_STREAM_PROPERTY_VERTICAL_FOV:
			return give(fieldOfView_[1], data, size);
		case ONI_STREAM_PROPERTY_MIRRORING:
			return give(OniBool(mirrored_), data, size);
		case ONI_STREAM_PROPERTY_MAX_VALUE:
			return give(kFarthest, data, size);
		case ONI_STREAM_PROPERTY_MIN_VALUE:
			return give(0, data, size);
		case ONI_STREAM_PROPERTY_STRIDE:
			return give(stride(), data, size);
		case ONI_STREAM_PROPERTY_CROPPING:
			return give(OniCropping{}, data, size);
		default:
			return ONI_STATUS_NOT_SUPPORTED;
	}
}

OniStatus CameraStream::setProperty(int id, const void* data, int size)
{
	if (id == ONI_STREAM_PROPERTY_VIDEO_MODE) return setMode(data, size);
	if (id == ONI_STREAM_PROPERTY_MIRRORING && size == int(sizeof(OniBool)))
		mirrored_ = *static_cast<const OniBool*>(data) != FALSE;
	return isPropertySupported(id) ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED;
}

void CameraStream::notifyAllProperties()
{
	const auto tell = [&](int id, const auto& value)
	{ raisePropertyChanged(id, &value, sizeof(value)); };
	tell(ONI_STREAM_PROPERTY_VIDEO_MODE, mode());
	tell(ONI_STREAM_PROPERTY_HORIZONTAL_FOV, fieldOfView_[0]);
	tell(ONI_STREAM_PROPERTY_VERTICAL_FOV, fieldOfView_[1]);
	tell(ONI_STREAM_PROPERTY_MIRRORING, OniBool(mirrored_));
	tell(ONI_STREAM_PROPERTY_MAX_VALUE, kFarthest);
	tell(ONI_STREAM_PROPERTY_MIN_VALUE, int(0));
	tell(ONI_STREAM_PROPERTY_STRIDE, stride());
	tell(ONI_STREAM_PROPERTY_CROPPING, OniCropping{});
}

int CameraStream::stride() const
{
	return mode().resolutionX * pixelSize(mode());
}

OniStatus CameraStream::setMode(const void* data, int size)
{
	OniVideoMode wanted;
	if (size != int(sizeof(wanted))) return ONI_STATUS_BAD_PARAMETER;
	std::memcpy(&wanted, data, sizeof(wanted));
	if (running_) return ONI_STATUS_OUT_OF_FLOW;
	const auto* const modes = sensor_.pSupportedVideoModes;
	if (std::none_of(
			modes, modes + sensor_.numSupportedVideoModes,
			[&](const OniVideoMode& mode) { return isSame(mode, wanted); }))
		return ONI_STATUS_NOT_SUPPORTED;
	const std::lock_guard lock(mutex_);
	mode_ = wanted;
	return ONI_STATUS_OK;
}

}  // namespace semloop::virtual_camera

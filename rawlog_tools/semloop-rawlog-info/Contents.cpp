#include "Contents.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationStereoImages.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/ExternalImages.h>
#include <semloop/observations/RgbdFrame.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

namespace semloop
{
namespace
{
using mrpt::obs::CObservation3DRangeScan;

constexpr double kGapPeriods = 2.5;

double secondsBetween(mrpt::Clock::time_point a, mrpt::Clock::time_point b)
{
	return std::chrono::duration<double>(b - a).count();
}

std::vector<mrpt::Clock::time_point> sorted(std::vector<mrpt::Clock::time_point> times)
{
	std::sort(times.begin(), times.end());
	return times;
}

std::string sizeText(std::size_t columns, std::size_t rows)
{
	return std::to_string(columns) + "x" + std::to_string(rows);
}

std::string formOf(const mrpt::img::CImage& image, const std::string& what)
{
	if (image.isExternallyStored()) return what + " in files";
	return what + " " + sizeText(image.getWidth(), image.getHeight());
}

std::string formOf(const CObservation3DRangeScan& scan)
{
	std::ostringstream form;
	const auto& camera = scan.cameraParamsIntensity;
	form << "camera " << sizeText(camera.ncols, camera.nrows) << ", f " << camera.fx();
	if (scan.hasIntensityImage) form << ", " << formOf(scan.intensityImage, "colour");
	if (!scan.hasRangeImage) return form.str();
	form << ", depth ";
	if (scan.rangeImage_isExternallyStored())
		form << "in files";
	else
		form << sizeText(std::size_t(scan.rangeImage.cols()), std::size_t(scan.rangeImage.rows()));
	form << " in steps of " << 1000 * scan.rangeUnits << " mm";
	return form.str();
}

std::vector<const mrpt::img::CImage*> imagesOf(const mrpt::obs::CObservation& observation)
{
	std::vector<const mrpt::img::CImage*> images;
	if (const auto* const scan = dynamic_cast<const CObservation3DRangeScan*>(&observation))
	{
		if (scan->hasIntensityImage) images.push_back(&scan->intensityImage);
		if (scan->hasConfidenceImage) images.push_back(&scan->confidenceImage);
	}
	else if (
		const auto* const one = dynamic_cast<const mrpt::obs::CObservationImage*>(&observation))
		images.push_back(&one->image);
	else if (
		const auto* const stereo =
			dynamic_cast<const mrpt::obs::CObservationStereoImages*>(&observation))
	{
		images.push_back(&stereo->imageLeft);
		if (stereo->hasImageRight) images.push_back(&stereo->imageRight);
		if (stereo->hasImageDisparity) images.push_back(&stereo->imageDisparity);
	}
	return images;
}

std::vector<std::string> externalFilesOf(const mrpt::obs::CObservation& observation)
{
	std::vector<std::string> files;
	for (const auto* const image : imagesOf(observation))
		if (image->isExternallyStored())
			files.push_back(image->getExternalStorageFileAbsolutePath());
	const auto* const scan = dynamic_cast<const CObservation3DRangeScan*>(&observation);
	if (scan && scan->hasRangeImage && scan->rangeImage_isExternallyStored())
		files.push_back(scan->rangeImage_getExternalStorageFileAbsolutePath(""));
	return files;
}

}  // namespace

std::vector<Stream::Gap> Stream::gaps() const
{
	std::vector<Gap> gaps;
	if (times.size() < 2) return gaps;
	const auto ascending = sorted(times);
	std::vector<double> steps;
	for (std::size_t i = 1; i < ascending.size(); i++)
		steps.push_back(secondsBetween(ascending[i - 1], ascending[i]));
	const double mean = secondsBetween(ascending.front(), ascending.back()) / double(steps.size());
	std::vector<double> order = steps;
	const auto middle = order.begin() + long(order.size() / 2);
	std::nth_element(order.begin(), middle, order.end());
	// Sensors that send several at once have a small median and no gaps.
	const double longest = kGapPeriods * std::max(*middle, mean);
	for (std::size_t i = 0; i < steps.size(); i++)
		if (steps[i] > longest) gaps.push_back({ascending[i], steps[i]});
	return gaps;
}

std::size_t Stream::outOfOrder() const
{
	std::size_t count = 0;
	for (std::size_t i = 1; i < times.size(); i++) count += times[i] < times[i - 1];
	return count;
}

void Contents::add(const mrpt::obs::CObservation& observation)
{
	auto& stream = streams_[{observation.sensorLabel, observation.GetRuntimeClass()->className}];
	stream.observations++;
	if (observation.timestamp != INVALID_TIMESTAMP) stream.times.push_back(observation.timestamp);
	if (const auto* const scan = dynamic_cast<const CObservation3DRangeScan*>(&observation))
		stream.forms[formOf(*scan)]++;
	else if (const auto images = imagesOf(observation); !images.empty())
		stream.forms[formOf(*images.front(), "image")]++;
	else if (const auto* const found = dynamic_cast<const CObservationInstances*>(&observation))
	{
		const bool depth = std::any_of(
			found->instances.begin(), found->instances.end(),
			[](const Instance& instance) { return instance.depth.has_value(); });
		if (!firstInstances_) firstInstances_ = observations_;
		stream.forms
			["masks " + sizeText(found->camera.ncols, found->camera.nrows) +
			 (found->instances.empty() ? ", none"
			  : depth                  ? ", with depth"
									   : "")]++;
		for (const auto& instance : found->instances)
			stream.instancesOfLabel[found->labels.name(instance.label())]++;
	}
	for (const auto& file : externalFilesOf(observation))
		if (!std::filesystem::exists(file)) missing_.push_back(file);
	observations_++;
}

void Contents::checkImages(const mrpt::obs::CObservation& observation)
{
	const auto* const scan = dynamic_cast<const CObservation3DRangeScan*>(&observation);
	if (scan && scan->hasIntensityImage && scan->hasRangeImage)
	{
		rgbdFrameFrom(*scan);
		return;
	}
	for (const auto* const image : imagesOf(observation))
		if (image->isExternallyStored())
			readImageFile(image->getExternalStorageFileAbsolutePath(), cv::IMREAD_UNCHANGED);
}

}  // namespace semloop

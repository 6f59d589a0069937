#include <mrpt/core/initializer.h>
#include <semloop/config/Options.h>
#include <semloop/observations/CameraFrames.h>
#include <semloop/segmentation/Segmenter.h>

#include <array>
#include <opencv2/imgproc.hpp>
#include <string>

namespace examples
{
struct ColorSegmenterOptions : semloop::Options
{
	int minSaturation = 90;  //!< of 255
	int minValue = 40;       //!< of 255
	int minArea = 60;        //!< [px]

protected:
	void describe(semloop::OptionFields& fields) override
	{
		fields.integer("min_saturation", minSaturation, 0, 255, "of a vivid pixel");
		fields.integer("min_value", minValue, 0, 255, "of a vivid pixel");
		fields.integer("min_area", minArea, 1, 1000000, "of a region [px]");
	}
};

/** Connected regions of vivid colour, labelled by their hue: good enough for toy blocks. */
class ColorSegmenter : public semloop::Segmenter
{
	DEFINE_MRPT_OBJECT(ColorSegmenter, examples)

public:
	void configure(const mrpt::config::CConfigFileBase& config, const std::string& section) override
	{
		options_.loadFromConfigFile(config, section);
	}

	semloop::CObservationInstances::Ptr segment(const semloop::RgbdFrame& frame) override
	{
		auto result = semloop::CObservationInstances::Create();
		result->timestamp = frame.time;
		result->camera = frame.camera;
		result->sensorPose = frame.T_robot_camera + (-semloop::sensorFromCamera());
		result->labels = labels_;

		cv::Mat hsv;
		cv::cvtColor(frame.color, hsv, cv::COLOR_BGR2HSV);
		for (uint32_t label = 0; label < labels_.size(); ++label)
		{
			const cv::Mat vivid = pixelsOf(label, hsv);
			cv::Mat regions, figures, centres;
			const int count = cv::connectedComponentsWithStats(vivid, regions, figures, centres);
			for (int region = 1; region < count; ++region)  // 0 is what is not vivid
				if (figures.at<int>(region, cv::CC_STAT_AREA) >= options_.minArea)
					result->instances.push_back(instanceOf(regions == region, label));
		}
		return result;
	}

private:
	/** Hues that belong to a label: six of them, 60 degrees wide, red around 0. */
	cv::Mat pixelsOf(uint32_t label, const cv::Mat& hsv) const
	{
		const int middle = int(label) * 30;  // OpenCV's hue ends at 180
		const auto between = [&](int low, int high)
		{
			cv::Mat mask;
			cv::inRange(
				hsv, cv::Scalar(low, options_.minSaturation, options_.minValue),
				cv::Scalar(high, 255, 255), mask);
			return mask;
		};
		if (label == 0) return between(0, 14) | between(165, 179);
		return between(middle - 15, middle + 14);
	}

	static semloop::Instance instanceOf(const cv::Mat& mask, uint32_t label)
	{
		semloop::Instance instance;
		instance.mask = semloop::InstanceMask::encode(mask);
		instance.box = instance.mask.boundingBox();
		instance.labelScores = {{label, 1.0f}};
		instance.confidence = 0.9f;
		return instance;
	}

	ColorSegmenterOptions options_;
	semloop::LabelSet labels_{{"red", "yellow", "green", "cyan", "blue", "magenta"}};
};
}  // namespace examples

IMPLEMENTS_MRPT_OBJECT(ColorSegmenter, semloop::Segmenter, examples)

MRPT_INITIALIZER(registerColorSegmenter)
{
	mrpt::rtti::registerClass(CLASS_ID(examples::ColorSegmenter));
}

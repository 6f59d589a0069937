#include <mrpt/core/format.h>
#include <mrpt/core/initializer.h>
#include <mrpt/serialization/CArchive.h>
#include <semloop/config/Error.h>
#include <semloop/observations/CObservationInstances.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <sstream>

#include "InstanceArchive.h"

IMPLEMENTS_SERIALIZABLE(CObservationInstances, CObservation, semloop)

namespace semloop
{
namespace
{
std::string text(cv::Size size)
{
	return std::to_string(size.width) + "x" + std::to_string(size.height);
}

void requireProbability(float value, const char* what)
{
	if (!(value >= 0 && value <= 1))
		throw InputError(std::string(what) + " " + std::to_string(value) + " is not in [0, 1]");
}

void validateScores(const LabelScores& scores, std::size_t labelCount)
{
	if (scores.empty()) throw InputError("it has no label");
	std::vector<bool> seen(labelCount);
	for (std::size_t i = 0; i < scores.size(); i++)
	{
		const auto [label, score] = scores[i];
		if (label >= labelCount)
			throw InputError(
				"label " + std::to_string(label) + " is not among the " +
				std::to_string(labelCount) + " of the label set");
		requireProbability(score, "label score");
		if (seen[label]) throw InputError("label " + std::to_string(label) + " is there twice");
		if (i > 0 && scores[i - 1].score < score)
			throw InputError("label scores are not sorted, highest first");
		seen[label] = true;
	}
}

void validateInstance(const Instance& instance, cv::Size imageSize, std::size_t labelCount)
{
	const cv::Rect& box = instance.box;
	if (box.empty() || (box & cv::Rect({0, 0}, imageSize)) != box)
		throw InputError(
			"box of " + text(box.size()) + " at (" + std::to_string(box.x) + ", " +
			std::to_string(box.y) + ") is empty or outside the image of " + text(imageSize));
	if (instance.mask.imageSize() != imageSize)
		throw InputError(
			"mask for an image of " + text(instance.mask.imageSize()) + ", not " + text(imageSize));
	validateScores(instance.labelScores, labelCount);
	requireProbability(instance.confidence, "confidence");

	const auto isFinite = [](float value) { return std::isfinite(value); };
	if (!std::all_of(instance.embedding.begin(), instance.embedding.end(), isFinite))
		throw InputError("embedding with a number that is not finite");
	if (!instance.depth) return;
	if (instance.depth->depth.type() != CV_16UC1 || instance.depth->depth.size() != box.size())
		throw InputError(
			"depth crop is not 16 bit or of " + text(instance.depth->depth.size()) +
			", the box of " + text(box.size()));
	if (!(instance.depth->unit > 0) || !isFinite(instance.depth->unit))
		throw InputError("unit of the depth crop is not a positive number");
}

}  // namespace

void CObservationInstances::validate() const
{
	InstanceMask{imageSize()};  // throws when no mask can have this size
	for (std::size_t i = 0; i < instances.size(); i++)
	{
		try
		{
			validateInstance(instances[i], imageSize(), labels.size());
		}
		catch (const InputError& e)
		{
			throw InputError("instance " + std::to_string(i) + ": " + e.what());
		}
	}
}

uint8_t CObservationInstances::serializeGetVersion() const
{
	return 1;
}

void CObservationInstances::serializeTo(mrpt::serialization::CArchive& out) const
{
	validate();
	out << timestamp << sensorLabel << camera << sensorPose;
	writeLabels(out, labels);
	writeInstances(out, instances);
}

void CObservationInstances::serializeFrom(mrpt::serialization::CArchive& in, uint8_t version)
{
	if (version > 1) MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);

	in >> timestamp >> sensorLabel >> camera >> sensorPose;
	labels = readLabels(in);
	instances = readInstances(in, imageSize(), version);
	validate();
}

void CObservationInstances::getDescriptionAsText(std::ostream& o) const
{
	CObservation::getDescriptionAsText(o);
	o << "Image size: " << text(imageSize()) << " pixels\n"
	  << "Sensor pose on the robot: " << sensorPose.asString() << "\n"
	  << "Labels known to the detector: " << labels.size() << "\n"
	  << "Instances: " << instances.size() << "\n";
	for (std::size_t i = 0; i < instances.size(); i++)
	{
		const Instance& instance = instances[i];
		o << "  " << i << ": " << labels.name(instance.label()) << " "
		  << instance.labelScores.front().score << ", confidence " << instance.confidence
		  << ", box " << text(instance.box.size()) << " at (" << instance.box.x << ", "
		  << instance.box.y << "), " << instance.mask.area() << " pixels, embedding of "
		  << instance.embedding.size() << (instance.depth ? ", with depth" : "");
		if (instance.trueObject) o << ", truly object " << *instance.trueObject;
		o << "\n";
	}
}

std::string CObservationInstances::exportTxtHeader() const
{
	return "INSTANCE LABEL SCORE CONFIDENCE BOX_X BOX_Y BOX_WIDTH BOX_HEIGHT AREA_PX";
}

std::string CObservationInstances::exportTxtDataRow() const
{
	if (instances.empty()) return "-1 - 0 0 0 0 0 0 0";
	std::ostringstream rows;
	for (std::size_t i = 0; i < instances.size(); i++)
	{
		const Instance& instance = instances[i];
		if (i > 0) rows << "\n" << mrpt::format("%16.6f ", mrpt::Clock::toDouble(timestamp));
		std::string label = labels.name(instance.label());
		std::replace(label.begin(), label.end(), ' ', '_');  // blanks separate the columns
		const cv::Rect& box = instance.box;
		rows << i << " " << label << " " << instance.labelScores.front().score << " "
			 << instance.confidence << " " << box.x << " " << box.y << " " << box.width << " "
			 << box.height << " " << instance.mask.area();
	}
	return rows.str();
}

MRPT_INITIALIZER(registerObservations)
{
	mrpt::rtti::registerClass(CLASS_ID(semloop::CObservationInstances));
}

}  // namespace semloop

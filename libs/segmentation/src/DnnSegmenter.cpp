#include "DnnNetwork.h"

#include <mrpt/core/initializer.h>
#include <mrpt/rtti/CObject.h>
#include <semloop/config/Error.h>
#include <semloop/observations/CameraFrames.h>
#include <semloop/segmentation/DnnSegmenter.h>
#include <semloop/segmentation/InstanceFilter.h>
#include <semloop/segmentation/MaskRcnnDecoder.h>
#include <semloop/segmentation/YoloSegDecoder.h>

namespace semloop
{
IMPLEMENTS_MRPT_OBJECT(DnnSegmenter, Segmenter, semloop)

namespace
{
MRPT_INITIALIZER(registerDnnSegmenter)
{
	mrpt::rtti::registerClass(CLASS_ID(DnnSegmenter));
}

enum class Layout
{
	YoloSeg,
	MaskRcnn
};

struct NetworkKind
{
	Layout layout = Layout::YoloSeg;
	int labelCount = 0;
	InputScaling scaling;
};

NetworkKind recognise(const DnnNetwork& network)
{
	const auto& outputs = network.trialOutputs();
	// YOLO takes pixels in [0, 1]; TensorFlow's graph scales them within.
	if (const auto yolo = findYoloSegOutputs(outputs, network.inputSize()))
		return {Layout::YoloSeg, yolo->labelCount(), {0.0, 1.0 / 255.0}};
	if (const auto maskRcnn = findMaskRcnnOutputs(outputs))
		return {Layout::MaskRcnn, maskRcnn->labelCount(), {0.0, 1.0}};
	throw InputError(
		network.path() + ": not a segmentation network that semloop understands (its outputs: " +
		network.describe(outputs) +
		"); use a YOLO-seg or Mask R-CNN export, see doc/segmentation-networks.md");
}

LabelMapping identity(std::size_t count)
{
	LabelMapping mapping(count);
	for (std::size_t i = 0; i < count; i++) mapping[i] = uint32_t(i);
	return mapping;
}
}  // namespace

struct DnnSegmenter::State
{
	explicit State(const DnnSegmenterOptions& o)
		: options(o),
		  network(o.model, o.modelConfig, {o.inputWidth, o.inputHeight}),
		  kind(recognise(network))
	{
		chooseLabels();
	}

	void chooseLabels()
	{
		const auto count = std::size_t(kind.labelCount);
		const auto tensorflow = cocoLabelsOfTensorflow();
		const bool fromFile = !options.labels.empty();
		labels = fromFile ? LabelSet::fromFile(options.labels) : LabelSet::coco();
		if (labels.size() == count)
			mapping = identity(count);
		else if (!fromFile && kind.layout == Layout::MaskRcnn && count == tensorflow.size())
			mapping = tensorflow;
		else
			throw InputError(
				options.model + ": the network has " + std::to_string(count) + " labels, but " +
				(fromFile ? options.labels : "COCO, the default,") + " has " +
				std::to_string(labels.size()) +
				"; give the network's own label file, one name a line");
	}

	std::vector<Detection> detect(const cv::Mat& color)
	{
		const Letterbox letterbox(color.size(), network.inputSize());
		const auto outputs = network.run(letterbox.apply(color), kind.scaling);
		const DetectionLimits limits{
			options.minScore, options.minLabelScore, options.maxIou, options.maxInstances};
		if (kind.layout == Layout::YoloSeg)
			if (const auto yolo = findYoloSegOutputs(outputs, network.inputSize()))
				return decodeYoloSeg(*yolo, letterbox, limits);
		if (const auto maskRcnn = findMaskRcnnOutputs(outputs))
			return decodeMaskRcnn(*maskRcnn, letterbox, limits);
		throw InputError(
			network.path() + ": its outputs changed their shapes to " + network.describe(outputs));
	}

	DnnSegmenterOptions options;
	DnnNetwork network;
	NetworkKind kind;
	LabelSet labels;
	LabelMapping mapping;
};

void DnnSegmenterOptions::describe(OptionFields& fields)
{
	fields.text(
		"model", model, "network file: .onnx (YOLO-seg), or .pb with model_config (Mask R-CNN)");
	fields.text("model_config", modelConfig, "graph description (.pbtxt) of a TensorFlow .pb");
	fields.text("labels", labels, "file with the network's labels, one a line; empty: COCO's 80");
	fields.integer(
		"input_width", inputWidth, 0, 8192,
		"width of the network's input [px]; 0: as the file says");
	fields.integer(
		"input_height", inputHeight, 0, 8192,
		"height of the network's input [px]; 0: as the file says");
	fields.number(
		"min_score", minScore, 0, 1, "detections whose best label scores less are dropped");
	fields.number(
		"min_label_score", minLabelScore, 0, 1,
		"other labels of a detection that score less are dropped");
	fields.number(
		"max_iou", maxIou, 0, 1,
		"boxes of one label that overlap more are one object (non-maximum suppression)");
	fields.number(
		"duplicate_iou", duplicateIou, 0, 1,
		"masks of any labels that overlap more are one object");
	fields.number(
		"min_part_area", minPartArea, 0, 1,
		"separate parts of a mask below this share of its largest part are removed");
	fields.integer("min_area", minArea, 1, 1 << 30, "smaller masks are dropped [px]");
	fields.integer("max_instances", maxInstances, 1, 1000, "of an image, highest scores first");
}

DnnSegmenter::DnnSegmenter() = default;
DnnSegmenter::~DnnSegmenter() = default;

void DnnSegmenter::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	DnnSegmenterOptions options;
	options.loadFromConfigFile(config, section);
	requireModel(config, section, options.model);
	configure(options);
}

void DnnSegmenter::configure(const DnnSegmenterOptions& options)
{
	state_ = std::make_unique<State>(options);
}

CObservationInstances::Ptr DnnSegmenter::segment(const RgbdFrame& frame)
{
	if (!state_) throw UsageError("DnnSegmenter: configure() was not called");
	if (frame.color.empty() || frame.color.type() != CV_8UC3)
		throw InputError("DnnSegmenter: the frame has no colour image of 8 bits a channel");

	auto result = CObservationInstances::Create();
	result->timestamp = frame.time;
	result->sensorLabel = "instances";
	result->camera = frame.camera;
	result->camera.ncols = uint32_t(frame.color.cols);
	result->camera.nrows = uint32_t(frame.color.rows);
	result->sensorPose = frame.T_robot_camera + (mrpt::poses::CPose3D() - sensorFromCamera());
	result->labels = state_->labels;
	const auto& o = state_->options;
	result->instances = filterInstances(
		state_->detect(frame.color), frame.color.size(), state_->mapping,
		{o.minPartArea, o.minArea, o.duplicateIou});
	return result;
}

}  // namespace semloop

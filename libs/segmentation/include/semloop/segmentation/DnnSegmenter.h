#pragma once

#include <semloop/config/Options.h>
#include <semloop/segmentation/Segmenter.h>

#include <memory>
#include <string>

namespace semloop
{
struct DnnSegmenterOptions : Options
{
	std::string model;
	std::string modelConfig;
	std::string labels;
	int inputWidth = 0;
	int inputHeight = 0;
	double minScore = 0.25;
	double minLabelScore = 0.05;
	double maxIou = 0.5;
	double duplicateIou = 0.7;
	double minPartArea = 0.1;
	int minArea = 400;
	int maxInstances = 50;

protected:
	void describe(OptionFields& fields) override;
};

/** An instance segmentation network run by cv::dnn on the processor. The layout of its outputs, YOLO's
 *  or Mask R-CNN's, is recognised from their shapes; see doc/segmentation-networks.md.
 *
 *  An instance's label scores are those of the network above minLabelScore, at most five, scaled to
 *  sum up to 1; its confidence is the best one before scaling. Deterministic. */
class DnnSegmenter : public Segmenter
{
	DEFINE_MRPT_OBJECT(DnnSegmenter, semloop)

public:
	DnnSegmenter();
	~DnnSegmenter() override;

	/** Loads the network and runs it once on an empty image. Throws InputError, saying what was found
	 *  and what to do, when a file is missing, the network does not load, its outputs have another
	 *  layout, its input size is unknown or differs from the one asked for, or the number of labels
	 *  does not fit. */
	void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;
	void configure(const DnnSegmenterOptions& options);

	/** Throws InputError on an empty image. */
	CObservationInstances::Ptr segment(const RgbdFrame& frame) override;

private:
	struct State;
	std::unique_ptr<State> state_;
};

}  // namespace semloop

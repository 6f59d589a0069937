#pragma once

#include <mrpt/img/TCamera.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/opengl/Visualizable.h>
#include <mrpt/poses/CPose3D.h>
#include <semloop/observations/InstanceMask.h>
#include <semloop/observations/LabelSet.h>

#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

namespace semloop
{
/** The depth image inside an instance's box, so that the instance can be put into a map without
 *  the range scan it came from. */
struct DepthCrop
{
	cv::Mat depth;        //!< CV_16UC1 of the box's size; 0 = invalid
	float unit = 0.001f;  //!< metres = value * unit
};

/** One detected object: s_k = (m_k, l_k, c_k, e_k) of the paper, Sec. III-B. */
struct Instance
{
	cv::Rect box;                  //!< [px], inside the image
	InstanceMask mask;             //!< m_k, of the whole image's size
	LabelScores labelScores;       //!< l_k as a distribution, highest first; never empty
	float confidence = 0;          //!< c_k in [0, 1]
	std::vector<float> embedding;  //!< e_k, unit length; empty: none. Stored as half floats.
	std::optional<DepthCrop> depth;
	/** Of the real object, where truth is known (simulated or annotated data). For evaluation only. */
	std::optional<uint32_t> trueObject;

	uint32_t label() const { return labelScores.front().label; }
};

// MRPT's Visualizable has a public destructor that is not virtual; nobody owns an observation as one.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wnon-virtual-dtor"

/** What an instance segmentation saw in one image.
 *
 *  The camera and sensorPose are those of the colour image: sensorPose is the camera on the robot
 *  in MRPT's convention (x forward, y left, z up), as CObservation3DRangeScan has it. The timestamp
 *  is that of the range scan it belongs to. */
class CObservationInstances : public mrpt::obs::CObservation, public mrpt::opengl::Visualizable
{
	DEFINE_SERIALIZABLE(CObservationInstances, semloop)

public:
	mrpt::img::TCamera camera;  //!< ncols x nrows is the image size that all masks share
	mrpt::poses::CPose3D sensorPose;
	LabelSet labels;
	std::vector<Instance> instances;

	cv::Size imageSize() const { return {int(camera.ncols), int(camera.nrows)}; }

	/** Throws InputError, naming the instance, when a box or mask does not fit the image, a label is
	 *  not in the set, a score is not in [0, 1], an embedding is not finite or a crop does not fit
	 *  its box. Everything read from a file is checked with this. */
	void validate() const;

	void getSensorPose(mrpt::poses::CPose3D& out) const override { out = sensorPose; }
	void setSensorPose(const mrpt::poses::CPose3D& pose) override { sensorPose = pose; }
	void getDescriptionAsText(std::ostream& o) const override;

	/** @name A table for `rawlog-edit --export-txt`: a row for each instance
	 * @{ */
	bool exportTxtSupported() const override { return true; }
	/** `INSTANCE LABEL SCORE CONFIDENCE BOX_X BOX_Y BOX_WIDTH BOX_HEIGHT AREA_PX` behind MRPT's time. */
	std::string exportTxtHeader() const override;
	/** Rows from the second on begin with the time, as MRPT writes it before the first. Without an
	 *  instance one row says so: number -1, label "-". Blanks in a label become "_". */
	std::string exportTxtDataRow() const override;
	/** @} */

	/** For RawLogViewer, in the robot's frame: the masks as a picture 1 m in front of the camera, and the
	 *  points of the depth crops, all in the colours of their labels. */
	void getVisualizationInto(mrpt::opengl::CSetOfObjects& out) const override;
};

#pragma GCC diagnostic pop

}  // namespace semloop

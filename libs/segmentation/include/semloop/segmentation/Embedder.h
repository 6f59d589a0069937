#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/rtti/CObject.h>
#include <semloop/observations/CObservationInstances.h>

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace semloop
{
/** Appearance of one instance as a vector of unit length, so that the inner product of two is
 *  their cosine similarity d_f (Eq. 3). A module. */
class Embedder : public mrpt::rtti::CObject
{
	DEFINE_VIRTUAL_MRPT_OBJECT(Embedder)

public:
	virtual void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) = 0;

	/** Embedding of the instance in a BGR image (CV_8UC3); only pixels of its mask count. Empty when
	 *  the mask is. */
	virtual std::vector<float> embed(const cv::Mat& color, const Instance& instance) = 0;
};

/** Gives every instance that has no embedding yet its own; color is the image they were found in. */
void addEmbeddings(Embedder& embedder, const cv::Mat& color, CObservationInstances& observation);

}  // namespace semloop

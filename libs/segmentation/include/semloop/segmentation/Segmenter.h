#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/rtti/CObject.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/RgbdFrame.h>

#include <string>
#include <vector>

namespace semloop
{
/** Image -> instances (Sec. III-B, first step). A module: an implementation registers itself with
 *  MRPT's class registry and the configuration names it. */
class Segmenter : public mrpt::rtti::CObject
{
	DEFINE_VIRTUAL_MRPT_OBJECT(Segmenter)

public:
	/** Reads the section of the chosen implementation; throws UsageError on a bad option, InputError
	 *  on a bad file. Called once before segment(). */
	virtual void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) = 0;

	/** What is seen in the frame's colour image, in that image's pixels (not rectified); null when
	 *  this frame has no segmentation (recorded every n-th frame), which is not the same as an
	 *  observation without instances. Depth crops are not filled in. */
	virtual CObservationInstances::Ptr segment(const RgbdFrame& frame) = 0;
};

}  // namespace semloop

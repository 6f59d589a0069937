#pragma once

#include <semloop/sensors/SensorSource.h>

namespace semloop
{
/** [live]: what a run does with what comes too fast, or not at all. */
struct LiveOptions : SensorSourceOptions
{
	int segmentationQueue = 3;  //!< frames
	int mappingQueue = 30;      //!< segmented frames

protected:
	void describe(OptionFields& fields) override;
};

}  // namespace semloop

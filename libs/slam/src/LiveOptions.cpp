#include <semloop/slam/LiveOptions.h>

namespace semloop
{
void LiveOptions::describe(OptionFields& f)
{
	SensorSourceOptions::describe(f);
	f.integer(
		"segmentation_queue", segmentationQueue, 1, 1000,
		"frames waiting for the segmenter; the others are tracked only");
	f.integer(
		"mapping_queue", mappingQueue, 1, 1000,
		"segmented frames waiting for the map; while there are more, frames are tracked only");
}

}  // namespace semloop

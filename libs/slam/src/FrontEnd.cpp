#include <semloop/slam/FrontEnd.h>

namespace semloop
{
CObservationInstances::Ptr FrontEnd::instancesOf(const RgbdFrame& raw) const
{
	auto instances = segmenter->segment(raw);
	if (instances) embed(raw, *instances);
	return instances;
}

void FrontEnd::embed(const RgbdFrame& raw, CObservationInstances& instances) const
{
	if (embedder) addEmbeddings(*embedder, raw.color, instances);
}

}  // namespace semloop

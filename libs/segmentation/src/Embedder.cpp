#include <semloop/segmentation/Embedder.h>

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Embedder, mrpt::rtti::CObject, semloop)

namespace semloop
{
void addEmbeddings(Embedder& embedder, const cv::Mat& color, CObservationInstances& observation)
{
	for (auto& instance : observation.instances)
		if (instance.embedding.empty()) instance.embedding = embedder.embed(color, instance);
}

}  // namespace semloop

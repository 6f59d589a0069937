#include <semloop/segmentation/Embedder.h>

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Embedder, mrpt::rtti::CObject, semloop)

#include <semloop/segmentation/Segmenter.h>

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Segmenter, mrpt::rtti::CObject, semloop)

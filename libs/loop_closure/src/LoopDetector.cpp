#include <semloop/loop_closure/LoopDetector.h>

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(LoopDetector, mrpt::rtti::CObject, semloop)

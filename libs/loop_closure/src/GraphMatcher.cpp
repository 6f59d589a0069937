#include <semloop/loop_closure/GraphMatcher.h>

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(GraphMatcher, mrpt::rtti::CObject, semloop)

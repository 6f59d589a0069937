#include <semloop/association/MatchingCost.h>

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(MatchingCost, mrpt::rtti::CObject, semloop)

#include <semloop/association/Associator.h>

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Associator, mrpt::rtti::CObject, semloop)

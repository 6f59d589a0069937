#include <semloop/odometry/Odometry.h>

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Odometry, mrpt::rtti::CObject, semloop)

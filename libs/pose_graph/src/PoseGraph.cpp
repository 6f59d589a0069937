#include <semloop/pose_graph/PoseGraph.h>

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(PoseGraph, mrpt::rtti::CObject, semloop)

#include <semloop/pose_graph/PoseGraph.h>

#include <semloop/loop_closure/SemanticGraph.h>

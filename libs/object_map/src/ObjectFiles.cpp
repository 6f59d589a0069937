#include <semloop/object_map/ObjectFiles.h>

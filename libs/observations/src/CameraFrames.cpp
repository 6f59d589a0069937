#include <semloop/observations/CameraFrames.h>
namespace semloop {}

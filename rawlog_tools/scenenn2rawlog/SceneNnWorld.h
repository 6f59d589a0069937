#pragma once

#include <mrpt/poses/CPose3D.h>

namespace semloop
{
/** SceneNN's world has y up, ours z: (x, y, z) becomes (x, -z, y). Everything that is read of a sequence
 *  is turned by this at once. */
inline mrpt::poses::CPose3D worldFromSceneNn()
{
	return mrpt::poses::CPose3D::FromYawPitchRoll(0, 0, M_PI / 2);
}

}  // namespace semloop

#pragma once

#include <mrpt/poses/CPose3D.h>

#include <random>

namespace semloop
{
/** (R, t) -> (R exp(w), t + n): every component of n from N(0, sigmaTranslation^2) [m], of w from
 *  N(0, sigmaRotation^2) [rad]. Takes 12 numbers from the generator, whatever the sigmas. */
mrpt::poses::CPose3D withNoise(
	const mrpt::poses::CPose3D& pose, double sigmaTranslation, double sigmaRotation,
	std::mt19937_64& random);

}  // namespace semloop

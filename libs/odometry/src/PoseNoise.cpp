#include "PoseNoise.h"

#include <Eigen/Geometry>
#include <cmath>

#include "PoseAlgebra.h"

namespace semloop
{
namespace
{
/** In (0, 1), the same on every platform, which std::uniform_real_distribution does not promise. */
double uniform(std::mt19937_64& random)
{
	return (double(random() >> 11) + 0.5) * 0x1p-53;
}

/** Box and Muller, Ann. Math. Stat. 29(2), 1958. */
double normal(std::mt19937_64& random)
{
	const double radius = std::sqrt(-2 * std::log(uniform(random)));
	return radius * std::cos(2 * M_PI * uniform(random));
}

Eigen::Vector3d normalVector(double sigma, std::mt19937_64& random)
{
	Eigen::Vector3d v;
	for (int axis = 0; axis < 3; axis++) v[axis] = sigma * normal(random);
	return v;
}
}  // namespace

mrpt::poses::CPose3D withNoise(
	const mrpt::poses::CPose3D& pose, double sigmaTranslation, double sigmaRotation,
	std::mt19937_64& random)
{
	Eigen::Isometry3d T = toIsometry(pose);
	T.translation() += normalVector(sigmaTranslation, random);
	const Eigen::Vector3d w = normalVector(sigmaRotation, random);
	if (w.norm() > 0) T.linear() = T.linear() * Eigen::AngleAxisd(w.norm(), w.normalized());
	return toPose(T);
}

}  // namespace semloop

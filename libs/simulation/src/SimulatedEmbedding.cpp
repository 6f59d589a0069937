#include "SimulatedEmbedding.h"

#include <semloop/config/Error.h>

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "Random.h"

namespace semloop
{
namespace
{
using Eigen::VectorXd;
using ViewVector = Eigen::Matrix<double, 5, 1>;

VectorXd randomDirection(int size, uint64_t key)
{
	RandomStream random(key);
	VectorXd v(size);
	for (int i = 0; i < size; i++) v[i] = random.normal();
	return v.normalized();
}

/** Unit vectors of which each is made by its key and then turned to a right angle with those before:
 *  Gram and Schmidt. */
Eigen::MatrixXd orthonormalBasis(int size, const std::vector<uint64_t>& keys)
{
	Eigen::MatrixXd basis(size, Eigen::Index(keys.size()));
	for (Eigen::Index k = 0; k < basis.cols(); k++)
	{
		VectorXd v = randomDirection(size, keys[std::size_t(k)]);
		for (Eigen::Index j = 0; j < k; j++) v -= basis.col(j).dot(v) * basis.col(j);
		basis.col(k) = v.normalized();
	}
	return basis;
}

/** Of unit length; smooth in the direction from which the object is seen. */
ViewVector viewVector(const SceneObject& object, const mrpt::poses::CPose3D& T_world_camera)
{
	const mrpt::poses::CPose3D T_object_camera = T_world_camera - object.T_world_object;
	const double x = T_object_camera.x(), y = T_object_camera.y(), z = T_object_camera.z();
	const double azimuth = std::atan2(y, x), elevation = std::atan2(z, std::hypot(x, y));
	const double level = std::cos(elevation);
	ViewVector v;
	v << level * std::cos(azimuth), level * std::sin(azimuth), 0.5 * level * std::cos(2 * azimuth),
		0.5 * level * std::sin(2 * azimuth), std::sqrt(1.25) * std::sin(elevation);
	return v / std::sqrt(1.25);
}

double identityShare(const SimulatedDetectorOptions& o)
{
	return std::max(1 - o.embeddingClass - o.embeddingView - o.embeddingNoise, 0.0);
}

std::vector<float> unitLength(const VectorXd& v)
{
	const Eigen::VectorXf unit = v.normalized().cast<float>();
	return {unit.data(), unit.data() + unit.size()};
}
}  // namespace

std::vector<float> simulatedEmbedding(
	const Scene& scene, const SceneObject& object, const mrpt::poses::CPose3D& T_world_camera,
	const SimulatedDetectorOptions& o, uint64_t noiseKey)
{
	o.requireConsistent();
	const double identity = identityShare(o);
	if (o.embeddingSize == 0) return {};
	const uint64_t label = hashedText(scene.labels.name(object.label));
	const uint64_t model = hashedText(object.model);
	const uint64_t own = hashed(hashedText(scene.name), model, object.id);
	const Eigen::MatrixXd basis = orthonormalBasis(
		o.embeddingSize, {hashed(label, 0), hashed(model, 1), hashed(model, 2), hashed(model, 3),
						  hashed(model, 4), hashed(model, 5), hashed(model, 6), hashed(own, 7)});

	Eigen::Matrix<double, 8, 1> parts;
	parts << std::sqrt(o.embeddingClass), std::sqrt(identity * (1 - o.embeddingInstance)),
		std::sqrt(o.embeddingView) * viewVector(object, T_world_camera),
		std::sqrt(identity * o.embeddingInstance);
	return unitLength(
		basis * parts + std::sqrt(o.embeddingNoise) * randomDirection(o.embeddingSize, noiseKey));
}

std::vector<float> falseEmbedding(
	const std::string& label, const SimulatedDetectorOptions& o, uint64_t key)
{
	if (o.embeddingSize == 0) return {};
	return unitLength(
		std::sqrt(o.embeddingClass) *
			randomDirection(o.embeddingSize, hashed(hashedText(label), 0)) +
		std::sqrt(1 - o.embeddingClass) * randomDirection(o.embeddingSize, key));
}

std::vector<float> mergedEmbedding(const std::vector<float>& a, const std::vector<float>& b)
{
	const auto size = Eigen::Index(a.size());
	if (size == 0) return {};
	using Map = Eigen::Map<const Eigen::VectorXf>;
	return unitLength((Map(a.data(), size) + Map(b.data(), size)).cast<double>());
}

}  // namespace semloop

#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "EmbreeScene.h"

namespace semloop
{
/** A point where a camera's ray ends. */
struct Hit
{
	uint32_t object = 0, triangle = 0;
	float u = 0, v = 0;  //!< barycentric, of the triangle's second and third corner
	Eigen::Vector3f point = Eigen::Vector3f::Zero();
	Eigen::Vector3f normal = Eigen::Vector3f::Zero();  //!< unit length, towards the camera
	int x = 0, y = 0;                                  //!< pixel
};

/** Colours of surfaces: textures and light. */
class Shading
{
public:
	Shading(const Scene& scene, const EmbreeScene& geometry);

	/** The light that each hit sends to the camera, BGR, linear; at most kPacket hits. */
	void shade(const std::vector<Hit>& hits, std::vector<cv::Vec3f>& out) const;

private:
	cv::Vec3f albedo(const Hit& hit) const;
	/** Irradiance that a light adds to each hit, 0 in its shadow. */
	void addLight(
		const PointLight& light, const std::vector<Hit>& hits,
		std::array<float, kPacket>& irradiance) const;

	const Scene& scene_;
	const EmbreeScene& geometry_;
	std::array<float, 256> linear_{};  //!< of a value in sRGB
};

}  // namespace semloop

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace semloop
{
/** What a surface looks like: Lambertian, its colour from a texture or plain. */
struct Material
{
	cv::Vec3f color{0.5F, 0.5F, 0.5F};  //!< blue, green, red, linear in [0, 1]; times the texture
	int texture = -1;                   //!< index in Mesh::textures; -1: none
};

/** Textured triangles. Furniture stands in its own frame: x to its right (width), y to its back (depth),
 *  z up, the origin in the middle of its footprint, so that it stands on z = 0 and looks along -y. */
struct Mesh
{
	struct Triangle
	{
		std::array<uint32_t, 3> vertices{};
		std::array<Eigen::Vector2f, 3> uv{};  //!< u to the right, v up; textures repeat
		uint32_t material = 0;
	};

	std::vector<Eigen::Vector3f> vertices;  //!< [m]
	std::vector<Triangle> triangles;
	std::vector<Material> materials;
	std::vector<cv::Mat> textures;  //!< CV_8UC3, BGR, sRGB
};

/** Smallest axis-parallel box of the vertices; throws InputError for a mesh without any. */
struct Bounds
{
	Eigen::Vector3f minimum = Eigen::Vector3f::Zero(), maximum = Eigen::Vector3f::Zero();
	Eigen::Vector3f size() const { return maximum - minimum; }
};
Bounds boundsOf(const Mesh& mesh);

}  // namespace semloop

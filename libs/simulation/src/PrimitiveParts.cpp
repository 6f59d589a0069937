#include "PrimitiveParts.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace semloop
{
namespace
{
using Eigen::Vector2f;
using Eigen::Vector3f;

//! of a dome: a low-poly ellipsoid is round enough for a depth camera
constexpr uint32_t kMeridians = 16, kRings = 5;

/** A side with its corners counterclockwise from the lower left one, as seen from outside. */
void addSide(Mesh& mesh, const std::array<Vector3f, 4>& corners, uint32_t material)
{
	const auto first = static_cast<uint32_t>(mesh.vertices.size());
	mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
	const std::array<Vector2f, 4> uv = {
		Vector2f(0, 0), Vector2f(1, 0), Vector2f(1, 1), Vector2f(0, 1)};
	mesh.triangles.push_back({{first, first + 1, first + 2}, {uv[0], uv[1], uv[2]}, material});
	mesh.triangles.push_back({{first, first + 2, first + 3}, {uv[0], uv[2], uv[3]}, material});
}

}  // namespace

cv::Scalar SeededRandom::color(double saturation, double value)
{
	const double hue = uniform(0, 6);
	const auto channel = [&](double n)
	{
		const double k = std::fmod(n + hue, 6.0);
		const double tint = std::max(0.0, std::min({k, 4 - k, 1.0}));
		return 255 * value * (1 - saturation * tint);
	};
	return {channel(1), channel(3), channel(5)};
}

uint32_t addColor(Mesh& mesh, const cv::Scalar& srgb)
{
	Material material;
	for (int i = 0; i < 3; i++)
		material.color[i] = static_cast<float>(std::pow(srgb[i] / 255, 2.2));
	mesh.materials.push_back(material);
	return static_cast<uint32_t>(mesh.materials.size() - 1);
}

uint32_t addTexture(Mesh& mesh, const cv::Mat& texture)
{
	Material material;
	material.color = {1, 1, 1};
	material.texture = static_cast<int>(mesh.textures.size());
	mesh.textures.push_back(texture);
	mesh.materials.push_back(material);
	return static_cast<uint32_t>(mesh.materials.size() - 1);
}

BoxMaterials BoxMaterials::all(uint32_t material)
{
	return {material, material, material, material, material, material};
}

void addBox(
	Mesh& mesh, const Vector3f& minimum, const Vector3f& maximum, const BoxMaterials& materials)
{
	const float x0 = minimum.x(), y0 = minimum.y(), z0 = minimum.z();
	const float x1 = maximum.x(), y1 = maximum.y(), z1 = maximum.z();
	addSide(mesh, {{{x0, y0, z0}, {x1, y0, z0}, {x1, y0, z1}, {x0, y0, z1}}}, materials.front);
	addSide(mesh, {{{x1, y1, z0}, {x0, y1, z0}, {x0, y1, z1}, {x1, y1, z1}}}, materials.back);
	addSide(mesh, {{{x0, y1, z0}, {x0, y0, z0}, {x0, y0, z1}, {x0, y1, z1}}}, materials.left);
	addSide(mesh, {{{x1, y0, z0}, {x1, y1, z0}, {x1, y1, z1}, {x1, y0, z1}}}, materials.right);
	addSide(mesh, {{{x0, y0, z1}, {x1, y0, z1}, {x1, y1, z1}, {x0, y1, z1}}}, materials.top);
	addSide(mesh, {{{x0, y1, z0}, {x1, y1, z0}, {x1, y0, z0}, {x0, y0, z0}}}, materials.bottom);
}

void addDome(Mesh& mesh, const Vector3f& size, uint32_t material)
{
	const auto first = static_cast<uint32_t>(mesh.vertices.size());
	const auto add = [&](const Vector3f& unit) {
		mesh.vertices.emplace_back(
			unit.cwiseProduct(Vector3f(size.x() / 2, size.y() / 2, size.z())));
	};
	for (uint32_t ring = 0; ring < kRings; ring++)
		for (uint32_t i = 0; i < kMeridians; i++)
		{
			const double up = M_PI / 2 * ring / kRings, around = 2 * M_PI * i / kMeridians;
			add(Eigen::Vector3d(
					std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up))
					.cast<float>());
		}
	const auto apex = static_cast<uint32_t>(mesh.vertices.size());
	add({0, 0, 1});
	add({0, 0, 0});

	const auto triangle = [&](uint32_t a, uint32_t b, uint32_t c)
	{
		Mesh::Triangle t{{a, b, c}, {}, material};
		for (std::size_t i = 0; i < 3; i++)
			t.uv[i] = mesh.vertices[t.vertices[i]].head<2>().cwiseQuotient(size.head<2>()) +
					  Vector2f(0.5F, 0.5F);
		mesh.triangles.push_back(t);
	};
	for (uint32_t i = 0; i < kMeridians; i++)
	{
		const uint32_t next = (i + 1) % kMeridians;
		for (uint32_t low = first; low + kMeridians < apex; low += kMeridians)
		{
			const uint32_t high = low + kMeridians;
			triangle(low + i, low + next, high + next);
			triangle(low + i, high + next, high + i);
		}
		triangle(apex - kMeridians + i, apex - kMeridians + next, apex);
		triangle(first + next, first + i, apex + 1);
	}
}

}  // namespace semloop

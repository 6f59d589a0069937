#pragma once

#include <semloop/simulation/Scene.h>
#include <semloop/simulation/SceneRenderer.h>

#include <Eigen/Core>
#include <cmath>
#include <memory>

namespace semloop
{
/** A rectangle, its normal side x up; the texture is upright seen against the normal. */
inline void addRectangle(
	Mesh& mesh, const Eigen::Vector3f& corner, const Eigen::Vector3f& side,
	const Eigen::Vector3f& up)
{
	const auto first = uint32_t(mesh.vertices.size());
	mesh.vertices.insert(
		mesh.vertices.end(), {corner, corner + side, corner + side + up, corner + up});
	const Eigen::Vector2f a(0, 0), b(1, 0), c(1, 1), d(0, 1);
	mesh.triangles.push_back({{first, first + 1, first + 2}, {a, b, c}, 0});
	mesh.triangles.push_back({{first, first + 2, first + 3}, {a, c, d}, 0});
}

inline Mesh plainMesh(const cv::Vec3f& color)
{
	Mesh mesh;
	mesh.materials.push_back({color, -1});
	return mesh;
}

/** A plate at height 0, its middle at the origin. */
inline Mesh plate(float width, float depth, const cv::Vec3f& color)
{
	Mesh mesh = plainMesh(color);
	addRectangle(mesh, {-width / 2, -depth / 2, 0}, {width, 0, 0}, {0, depth, 0});
	return mesh;
}

/** A floor of 10 x 10 m at z = 0, nothing else. */
inline Scene emptyScene()
{
	Scene scene;
	scene.name = "test";
	scene.labels = LabelSet({"thing"});
	scene.rooms = plate(10, 10, {0.2F, 0.4F, 0.6F});
	scene.ambient = 0.25F;
	return scene;
}

inline void addObject(Scene& scene, const Mesh& mesh, double x, double y, double z)
{
	SceneObject object;
	object.id = uint32_t(scene.objects.size() + 1);
	object.model = "plate" + std::to_string(object.id);
	object.mesh = std::make_shared<Mesh>(mesh);
	object.T_world_object = mrpt::poses::CPose3D(x, y, z, 0, 0, 0);
	scene.objects.push_back(object);
}

/** f = 300 px, 301 x 301 px, so that the middle of the image is a pixel. */
inline mrpt::img::TCamera squareCamera()
{
	mrpt::img::TCamera camera;
	camera.ncols = camera.nrows = 301;
	camera.setIntrinsicParamsFromValues(300, 300, 150, 150);
	return camera;
}

/** Three metres above the floor, looking down: pixel (150 + 100 x, 150 - 100 y) sees (x, y) on it. */
inline mrpt::poses::CPose3D lookingDown()
{
	return mrpt::poses::CPose3D(0, 0, 3, 0, 0, M_PI);
}

inline RenderedView viewFromAbove(const Scene& scene, bool color = false)
{
	return SceneRenderer(scene).render(squareCamera(), lookingDown(), color);
}
}  // namespace semloop

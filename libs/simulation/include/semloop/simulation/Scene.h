#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/observations/LabelSet.h>
#include <semloop/simulation/Mesh.h>

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace semloop
{
/** A piece of furniture in its place. */
struct SceneObject
{
	uint32_t id = 0;     //!< from 1; 0 is the room itself
	uint32_t label = 0;  //!< in Scene::labels
	std::string model;   //!< catalogue id or primitive
	std::shared_ptr<const Mesh> mesh;
	mrpt::poses::CPose3D T_world_object;  //!< of furniture's frame (Mesh.h)
};

struct PointLight
{
	Eigen::Vector3f position = Eigen::Vector3f::Zero();  //!< [m]
	float intensity = 1;  //!< irradiance at one metre, where a white surface's 1 is full exposure
};

/** Everything that a camera can see. World: z up, the floor at z = 0. */
struct Scene
{
	std::string name;
	LabelSet labels;
	std::vector<SceneObject> objects;  //!< id = index + 1
	Mesh rooms;                        //!< floor, walls, ceiling, in the world
	std::vector<PointLight> lights;
	float ambient = 0.25F;  //!< irradiance from everywhere
};

}  // namespace semloop

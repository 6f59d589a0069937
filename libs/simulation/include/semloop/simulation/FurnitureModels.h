#pragma once

#include <semloop/simulation/FurnitureCatalog.h>
#include <semloop/simulation/Mesh.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>

namespace semloop
{
/** A model that is ready to be placed. */
struct FurnitureModel
{
	std::string id;
	std::shared_ptr<const Mesh> mesh;
	Eigen::Vector3d size = Eigen::Vector3d::Zero();  //!< width, depth, height [m]
	double top = 0;  //!< height of the surface that things are put on [m]
};

/** Meshes by id, each loaded once: "Scopia#bed1" of the catalogue, or "primitive:book" made for a seed. */
class FurnitureModels
{
public:
	explicit FurnitureModels(const FurnitureCatalog& catalog) : catalog_(catalog) {}

	/** Throws InputError as the catalogue and makePrimitive() do. The seed matters to primitives only:
	 *  the model's id then is "primitive:book#<seed>". */
	const FurnitureModel& get(const std::string& id, uint64_t seed);

	const FurnitureCatalog& catalog() const { return catalog_; }

private:
	const FurnitureCatalog& catalog_;
	std::map<std::string, FurnitureModel> models_;
};

}  // namespace semloop

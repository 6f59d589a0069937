#pragma once

#include <semloop/simulation/Mesh.h>

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

namespace semloop
{
/** One model of Sweet Home 3D's catalogues. */
struct CatalogEntry
{
	std::string id;  //!< "Scopia#bed1": unique over all catalogues
	std::string name, category, creator, license;
	std::string archive;  //!< path of the .sh3f
	std::string model;    //!< of the OBJ file inside
	Eigen::Vector3d size = Eigen::Vector3d::Zero();  //!< width, depth, height [m]
	double elevation = 0;  //!< above the floor where it is usually put [m]
	double top = 0;        //!< height of the surface that things are put on [m]; 0: nothing is
	Eigen::Matrix3d modelRotation = Eigen::Matrix3d::Identity();
};

/** The furniture of Debian's package sweethome3d-furniture, read in place. */
class FurnitureCatalog
{
public:
	static constexpr const char* kDefaultFolder = "/usr/share/sweethome3d/furniture";

	/** Reads the property files of all .sh3f archives in a folder. Throws InputError when the folder
	 *  or the archives are missing (remedy: install sweethome3d-furniture), one is damaged, or two have
	 *  a model of the same id. Texts are UTF-8. */
	static FurnitureCatalog open(const std::string& folder = kDefaultFolder);

	/** Throws InputError, with the most similar ids, when there is none of that id. */
	const CatalogEntry& entry(const std::string& id) const;
	const std::map<std::string, CatalogEntry>& entries() const { return entries_; }

	/** The model in furniture's frame, of the size that the catalogue gives: turned by modelRotation
	 *  (about the OBJ's axes: x right, y up, z to the viewer), its box scaled to width x depth x height.
	 *  Materials with an opacity (MTL d) below 0.15 are left out after that: glass is not what a depth
	 *  sensor sees. Triangles without area or with indices out of range are left out too; what has no
	 *  material is grey. Textures are at most 512 pixels wide and high; one that is missing or unreadable
	 *  leaves the plain colour (MTL Kd). May be called from several threads.
	 *  Throws InputError, naming archive and model, when it cannot be read or nothing is left. */
	Mesh load(const CatalogEntry& entry) const;

private:
	std::map<std::string, CatalogEntry> entries_;
};

}  // namespace semloop

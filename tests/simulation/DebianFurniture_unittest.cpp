// What the package sweethome3d-furniture has, and that the scenes' list of models agrees with it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFile.h>
#include <semloop/config/Error.h>
#include <semloop/simulation/FurnitureCatalog.h>
#include <semloop/simulation/Primitives.h>

#include <filesystem>
#include <set>
#include <sstream>

#include "TemporaryFolder.h"

using semloop::CatalogEntry;
using semloop::FurnitureCatalog;
using semloop::Mesh;

namespace
{
const std::string kPrimitive = "primitive:";

class DebianFurniture : public testing::Test
{
protected:
	void SetUp() override
	{
		if (!std::filesystem::exists(FurnitureCatalog::kDefaultFolder))
			GTEST_SKIP() << "sweethome3d-furniture is not installed";
		catalog_ = FurnitureCatalog::open();
	}
	FurnitureCatalog catalog_;
};

std::vector<std::string> split(const std::string& list)
{
	std::vector<std::string> parts;
	std::istringstream in(list);
	for (std::string part; std::getline(in >> std::ws, part, ',');) parts.push_back(part);
	return parts;
}

double farthestFromTheCatalogue(const CatalogEntry& entry, const Mesh& mesh)
{
	return (boundsOf(mesh).size().cast<double>() - entry.size).cwiseAbs().maxCoeff();
}

void expectConsistent(const Mesh& mesh, const std::string& id)
{
	for (const auto& triangle : mesh.triangles)
	{
		ASSERT_LT(triangle.material, mesh.materials.size()) << id;
		for (const uint32_t vertex : triangle.vertices) ASSERT_LT(vertex, mesh.vertices.size());
	}
	for (const auto& material : mesh.materials)
		ASSERT_LT(material.texture, static_cast<int>(mesh.textures.size())) << id;
	for (const auto& texture : mesh.textures)
		ASSERT_TRUE(texture.type() == CV_8UC3 && texture.cols <= 512 && texture.rows <= 512) << id;
}

}  // namespace

TEST_F(DebianFurniture, HasHundredsOfModelsWithTheirLicences)
{
	EXPECT_GE(catalog_.entries().size(), 800u);
	for (const auto& [id, entry] : catalog_.entries())
	{
		EXPECT_FALSE(entry.license.empty()) << id;
		EXPECT_FALSE(entry.creator.empty()) << id;
	}
	EXPECT_THAT(catalog_.entry("Scopia#bed1").license, testing::HasSubstr("\u00a9"));
	EXPECT_EQ(catalog_.entry("Scopia#billet-10-euros").name, "Bill 10\u20ac");
}

TEST_F(DebianFurniture, AMistypedIdNamesTheRightOne)
{
	const auto message =
		semloop::messageOf<semloop::InputError>([&] { catalog_.entry("Scopia#wardrob1"); });
	EXPECT_THAT(message, testing::HasSubstr("similar ones: Scopia#wardrobe1, "));
}

TEST_F(DebianFurniture, EveryModelForIndoorsLoads)
{
	const std::set<std::string> elsewhere = {"Exterior", "Vehicles", "Characters"};
	for (const auto& [id, entry] : catalog_.entries())
	{
		if (elsewhere.count(entry.category) != 0) continue;
		ASSERT_NO_THROW(expectConsistent(catalog_.load(entry), id)) << id;
	}
}

TEST_F(DebianFurniture, WhatTheScenesDrawFromHasTheCataloguesSizeAndAKnownPlace)
{
	const mrpt::config::CConfigFile models(SEMLOOP_SOURCE_DIR "/config_ini/scenes/models.ini");
	std::vector<std::string> items;
	models.getAllSections(items);
	EXPECT_GE(items.size(), 30u);
	const std::set<std::string> places = {"wall", "floor", "corner", "top"};
	for (const auto& item : items)
	{
		EXPECT_FALSE(models.read_string(item, "label", "").empty()) << item;
		EXPECT_EQ(places.count(models.read_string(item, "place", "")), 1u) << item;
		const auto ids = split(models.read_string(item, "models", ""));
		EXPECT_FALSE(ids.empty()) << item;
		for (const auto& id : ids)
		{
			if (id.compare(0, kPrimitive.size(), kPrimitive) == 0)
			{
				EXPECT_NO_THROW(semloop::makePrimitive(id.substr(kPrimitive.size()), 1)) << item;
				continue;
			}
			const auto& entry = catalog_.entry(id);
			EXPECT_LT(farthestFromTheCatalogue(entry, catalog_.load(entry)), 1e-4) << id;
			EXPECT_LT(entry.elevation, 1.2) << id;
		}
	}
}

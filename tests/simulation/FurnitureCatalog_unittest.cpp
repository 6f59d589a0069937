#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>

#include <Eigen/Geometry>
#include <array>
#include <functional>

#include "CatalogFixture.h"

using Eigen::Vector3d;
using semloop::CatalogFixture;
using semloop::FurnitureCatalog;
using semloop::InputError;
using testing::HasSubstr;
using testing::StartsWith;

namespace
{
std::string errorOf(const std::function<void()>& call)
{
	return semloop::messageOf<InputError>(call);
}

}  // namespace

TEST(FurnitureCatalog, ReadsTheEntriesOfAnArchive)
{
	CatalogFixture test;
	test.model["category"] = "Living room";
	test.model["creator"] = "Someone";
	test.model["elevation"] = "12.5";
	test.model["dropOnTopElevation"] = "45";
	const auto catalog = test.open();
	ASSERT_EQ(catalog.entries().size(), 1u);
	const auto& chair = catalog.entry("Test#chair");
	EXPECT_EQ(chair.name, "Chair");
	EXPECT_EQ(chair.category, "Living room");
	EXPECT_EQ(chair.creator, "Someone");
	EXPECT_EQ(chair.archive, test.archive());
	EXPECT_EQ(chair.model, "/test/chair/chair.obj");
	EXPECT_TRUE(chair.size.isApprox(Vector3d(0.4, 0.5, 0.9)));
	EXPECT_DOUBLE_EQ(chair.elevation, 0.125);
	EXPECT_DOUBLE_EQ(chair.top, 0.45);
	EXPECT_TRUE(chair.modelRotation.isIdentity());
}

TEST(FurnitureCatalog, ThingsStandOnTopUnlessTheCatalogueSaysThatNothingDoes)
{
	CatalogFixture test;
	EXPECT_DOUBLE_EQ(test.open().entry("Test#chair").top, 0.9);
	test.model["dropOnTopElevation"] = "-1";
	EXPECT_DOUBLE_EQ(test.open().entry("Test#chair").top, 0);
}

TEST(FurnitureCatalog, ReadsJavasEscapesAndLatin1AsUtf8)
{
	CatalogFixture test;
	test.model["name"] = "Caf\xe9 10\\u20ac \\uD83D\\uDCA1 a\\=b \\\n   and on";
	const auto catalog = test.open();
	EXPECT_EQ(catalog.entry("Test#chair").name, "Caf\u00e9 10\u20ac \U0001F4A1 a=b and on");
	EXPECT_EQ(catalog.entry("Test#chair").license, "Free for \u00a9 all");
}

TEST(FurnitureCatalog, AnUnknownIdNamesSimilarOnes)
{
	CatalogFixture test;
	const auto catalog = test.open();
	const auto message = errorOf([&] { catalog.entry("chiar"); });
	EXPECT_EQ(message, "no model 'chiar' in the furniture catalogues; similar ones: Test#chair");
}

TEST(FurnitureCatalog, AFolderWithoutCataloguesSaysWhatToInstall)
{
	const semloop::TemporaryFolder folder;
	const std::string rest =
		": no furniture catalogues (*.sh3f) here; install Debian's package sweethome3d-furniture";
	for (const std::string& path : {folder.path().string(), folder.file("missing")})
		EXPECT_EQ(errorOf([&] { FurnitureCatalog::open(path); }), path + rest);
}

TEST(FurnitureCatalog, ADamagedArchiveIsNamed)
{
	CatalogFixture test;
	test.folder.write("Test.sh3f", "this is no zip archive");
	EXPECT_THAT(
		errorOf([&] { FurnitureCatalog::open(test.folder.path().string()); }),
		StartsWith(test.archive() + ": not a readable zip archive"));
	semloop::writeZip(test.archive(), {{"other.txt", "x"}});
	EXPECT_THAT(
		errorOf([&] { FurnitureCatalog::open(test.folder.path().string()); }),
		HasSubstr("Test.sh3f: PluginFurnitureCatalog.properties: not in this archive"));
}

TEST(FurnitureCatalog, AWrongPropertyIsNamedWithItsArchive)
{
	for (const auto& [key, value, part] : std::vector<std::array<std::string, 3>>{
			 {"width", "wide", "width#1 is 'wide', not a number"},
			 {"width", "0", "width#1 is not above 0"},
			 {"height", "", "height#1 is missing"},
			 {"model", "", "model#1 is missing"},
			 {"modelRotation", "1 0 0", "modelRotation#1 is '1 0 0', not nine numbers"},
			 {"name", "\\u12", "\\u12 is not \\u and four hexadecimal digits"}})
	{
		CatalogFixture test;
		test.model[key] = value;
		const auto message = errorOf([&] { test.open(); });
		EXPECT_THAT(message, StartsWith(test.archive() + ": PluginFurnitureCatalog.properties: "));
		EXPECT_THAT(message, HasSubstr(part));
	}
}

TEST(FurnitureCatalog, TheSameIdInTwoArchivesIsRefused)
{
	CatalogFixture test;
	test.open();
	semloop::writeZip(test.folder.file("Other.sh3f"), test.files);
	EXPECT_THAT(
		errorOf([&] { FurnitureCatalog::open(test.folder.path().string()); }),
		HasSubstr("model 'Test#chair' is in "));
}

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>

#include "CatalogFixture.h"

using Eigen::Vector3f;
using semloop::boundsOf;
using semloop::CatalogFixture;
using semloop::InputError;
using semloop::Mesh;
using semloop::png;
using testing::HasSubstr;

namespace
{
std::string errorOf(const std::function<void()>& call)
{
	return semloop::messageOf<InputError>(call);
}

/** Mean of the vertices in the upper part: the chair's backrest. */
Vector3f upperMiddle(const Mesh& mesh)
{
	Vector3f sum = Vector3f::Zero();
	int count = 0;
	for (const Vector3f& vertex : mesh.vertices)
		if (vertex.z() > 0.5F * boundsOf(mesh).maximum.z()) sum += vertex, count++;
	return sum / static_cast<float>(count);
}

}  // namespace

TEST(FurnitureModel, AModelStandsInFurnituresFrameInTheCataloguesSize)
{
	CatalogFixture test;
	const Mesh mesh = test.load();
	EXPECT_EQ(mesh.triangles.size(), 4u);
	EXPECT_EQ(mesh.vertices.size(), 6u);
	EXPECT_TRUE(boundsOf(mesh).minimum.isApprox(Vector3f(-0.2F, -0.25F, 0), 1e-6F));
	EXPECT_TRUE(boundsOf(mesh).maximum.isApprox(Vector3f(0.2F, 0.25F, 0.9F), 1e-6F));
	EXPECT_NEAR(upperMiddle(mesh).y(), 0.25, 1e-6);  // the backrest is at the back
}

TEST(FurnitureModel, ModelRotationTurnsBeforeTheBoxIsFitted)
{
	CatalogFixture test;
	// a quarter about the OBJ's y axis: what is at the back, -z, comes to -x, the left
	test.model["modelRotation"] = "0 0 1 0 1 0 -1 0 0";
	const Mesh mesh = test.load();
	EXPECT_TRUE(boundsOf(mesh).size().isApprox(Vector3f(0.4F, 0.5F, 0.9F), 1e-6F));
	EXPECT_NEAR(upperMiddle(mesh).x(), -0.2, 1e-6);
	EXPECT_NEAR(upperMiddle(mesh).y(), 0, 1e-6);
}

TEST(FurnitureModel, KeepsTheWindingSoThatOutsideStaysOutside)
{
	CatalogFixture test;
	const Mesh mesh = test.load();
	const auto& [a, b, c] = mesh.triangles[0].vertices;
	const Vector3f normal =
		(mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
	EXPECT_TRUE(normal.normalized().isApprox(Vector3f::UnitZ(), 1e-6F));
}

TEST(FurnitureModel, AFlatModelStaysFlat)
{
	CatalogFixture test;
	test.files["test/chair/chair.obj"] = "v -1 5 1\nv 1 5 1\nv 1 5 -1\nf 1 2 3\n";
	const auto bounds = boundsOf(test.load());
	EXPECT_TRUE(bounds.size().isApprox(Vector3f(0.4F, 0.5F, 0), 1e-6F));
	EXPECT_EQ(bounds.minimum.z(), 0);
}

TEST(FurnitureModel, ColorsAreLinearAndGreyWithoutAMaterial)
{
	CatalogFixture test;
	EXPECT_EQ(test.load().materials.at(0).color, cv::Vec3f(0.5F, 0.5F, 0.5F));
	test.setMaterial("Kd 1 0.5 0\n");
	const auto material = test.load().materials.at(0);
	EXPECT_EQ(material.color, cv::Vec3f(0, std::pow(0.5F, 2.2F), 1));
	EXPECT_EQ(material.texture, -1);
}

TEST(FurnitureModel, GlassIsLeftOutButCountsForTheSize)
{
	CatalogFixture test;
	test.files["test/chair/chair.mtl"] = "newmtl wood\nd 1\nnewmtl glass\nTr 0.9\n";
	const std::string chair = CatalogFixture::kChair;
	const auto lastFace = chair.rfind("f ");
	test.files["test/chair/chair.obj"] = "mtllib chair.mtl\nusemtl wood\n" +
										 chair.substr(0, lastFace) + "usemtl glass\n" +
										 chair.substr(lastFace);
	const Mesh mesh = test.load();
	EXPECT_EQ(mesh.triangles.size(), 2u);
	EXPECT_EQ(mesh.vertices.size(), 4u);
	EXPECT_EQ(mesh.materials.size(), 1u);
	// the seat is at the height and of the size that it has with its backrest of glass
	EXPECT_TRUE(boundsOf(mesh).size().isApprox(Vector3f(0.4F, 0.5F, 0), 1e-6F));

	test.files["test/chair/chair.mtl"] = "newmtl wood\nd 0.1\nnewmtl glass\nTr 0.9\n";
	EXPECT_THAT(errorOf([&] { test.load(); }), HasSubstr("chair.obj: all of it is transparent"));
}

TEST(FurnitureModel, FindsATextureWhateverCaseSlashesAndFolder)
{
	for (const std::string name :
		 {"Wood.png", "wood.PNG\t", ".\\wood.png", "../chair/wood.png", "C:\\My files\\wood.png"})
	{
		CatalogFixture test;
		test.setMaterial("Kd 0 0 0\nmap_Kd " + name + "\r\n");
		test.files["test/chair/Wood.png"] = png(4, 2, {10, 20, 30});
		const Mesh mesh = test.load();
		ASSERT_EQ(mesh.textures.size(), 1u) << name;
		EXPECT_EQ(mesh.textures[0].size(), cv::Size(4, 2));
		EXPECT_EQ(mesh.textures[0].at<cv::Vec3b>(0, 0), cv::Vec3b(10, 20, 30));
		EXPECT_EQ(mesh.materials.at(0).texture, 0);
		EXPECT_EQ(mesh.materials.at(0).color, cv::Vec3f(1, 1, 1));
		EXPECT_EQ(mesh.triangles.at(0).uv[1], Eigen::Vector2f(1, 0));
	}
}

TEST(FurnitureModel, WithoutItsTextureAModelIsOfPlainColor)
{
	CatalogFixture test;
	test.setMaterial("Kd 0 0 1\nmap_Kd nowhere.png\n");
	EXPECT_TRUE(test.load().textures.empty());
	test.files["test/chair/nowhere.png"] = "no image";
	const Mesh mesh = test.load();
	EXPECT_TRUE(mesh.textures.empty());
	EXPECT_EQ(mesh.materials.at(0).texture, -1);
	EXPECT_EQ(mesh.materials.at(0).color, cv::Vec3f(1, 0, 0));
}

TEST(FurnitureModel, HolesOfATextureGetItsMeanColor)
{
	CatalogFixture test;
	test.setMaterial("map_Kd leaf.png\n");
	cv::Mat leaf(1, 3, CV_8UC4, cv::Scalar(0, 0, 0, 0));
	leaf.at<cv::Vec4b>(0, 0) = {10, 100, 30, 255};
	leaf.at<cv::Vec4b>(0, 1) = {20, 120, 50, 255};
	std::vector<uchar> bytes;
	cv::imencode(".png", leaf, bytes);
	test.files["test/chair/leaf.png"] = {bytes.begin(), bytes.end()};
	const Mesh mesh = test.load();
	EXPECT_EQ(mesh.textures.at(0).at<cv::Vec3b>(0, 1), cv::Vec3b(20, 120, 50));
	EXPECT_EQ(mesh.textures.at(0).at<cv::Vec3b>(0, 2), cv::Vec3b(15, 110, 40));
}

TEST(FurnitureModel, LargeTexturesShrink)
{
	CatalogFixture test;
	test.setMaterial("map_Kd wood.png\n");
	test.files["test/chair/wood.png"] = png(1000, 100, {10, 20, 30});
	EXPECT_EQ(test.load().textures.at(0).size(), cv::Size(512, 100));
}

TEST(FurnitureModel, BadTrianglesAreDropped)
{
	CatalogFixture test;
	test.files["test/chair/chair.obj"] =
		std::string(CatalogFixture::kChair) + "f 1 1 2\nf 1 2 99\nv 3 0 2\nf 1 2 7\n";
	EXPECT_EQ(test.load().triangles.size(), 4u);
}

TEST(FurnitureModel, AMissingMaterialFileLeavesAGreyModel)
{
	CatalogFixture test;
	test.setMaterial("Kd 1 0 0\n");
	test.files.erase("test/chair/chair.mtl");
	EXPECT_EQ(test.load().materials.at(0).color, cv::Vec3f(0.5F, 0.5F, 0.5F));
}

TEST(FurnitureModel, ADamagedModelIsNamedWithItsArchive)
{
	CatalogFixture test;
	const auto catalog = test.open();
	std::string bytes = semloop::readBytes(test.archive());
	bytes.at(bytes.find("v -1 0 2")) = 'w';
	test.folder.write("Test.sh3f", bytes);
	const auto message = errorOf([&] { catalog.load(catalog.entry("Test#chair")); });
	EXPECT_THAT(message, HasSubstr("Test.sh3f: /test/chair/chair.obj: cannot be unpacked"));

	for (const std::string content : {"", "not a model at all", "v 0 0 0\nv 1 1 1\nf 1 2 1\n"})
	{
		test.files["test/chair/chair.obj"] = content;
		EXPECT_THAT(
			errorOf([&] { test.load(); }),
			HasSubstr("Test.sh3f: /test/chair/chair.obj: not an OBJ model"));
	}
	test.files.erase("test/chair/chair.obj");
	EXPECT_THAT(errorOf([&] { test.load(); }), HasSubstr("chair.obj: not in this archive"));
}

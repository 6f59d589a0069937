#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/ObjectFiles.h>

#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "ObjectMapFixtures.h"

using namespace semloop;
using namespace semloop::synthetic;

namespace
{
class ObjectFiles : public testing::Test
{
protected:
	void SetUp() override
	{
		const auto* info = testing::UnitTest::GetInstance()->current_test_info();
		folder_ = std::filesystem::path(testing::TempDir()) /
				  ("semloop_" + std::string(info->name()) + std::to_string(getpid()));
		std::filesystem::create_directories(folder_);
	}
	void TearDown() override { std::filesystem::remove_all(folder_); }

	std::string path(const std::string& name) const { return (folder_ / name).string(); }

	static std::string contents(const std::string& file)
	{
		std::ifstream in(file, std::ios::binary);
		return {std::istreambuf_iterator<char>(in), {}};
	}

	/** What loading says, which must name the file. */
	static std::string errorOf(const std::string& file)
	{
		try
		{
			loadObjectMap(file);
		}
		catch (const InputError& error)
		{
			const std::string what = error.what();
			EXPECT_EQ(what.find('\n'), std::string::npos) << what;
			return what.find(file) == 0 ? what : "does not name the file: " + what;
		}
		return "nothing";
	}

	std::filesystem::path folder_;
};
}  // namespace

TEST_F(ObjectFiles, AMapComesBackAsItWas)
{
	CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	map.markCovisible({0, 1});
	saveObjectMap(path("map.objmap"), map);
	EXPECT_EQ(bytesOf(*loadObjectMap(path("map.objmap"))), bytesOf(map));
	saveObjectMap(path("empty.objmap"), CObjectMap());
	EXPECT_TRUE(loadObjectMap(path("empty.objmap"))->isEmpty());
}

TEST_F(ObjectFiles, MissingCutAndForeignFilesAreNamed)
{
	EXPECT_NE(errorOf(path("no.objmap")).find("no such file"), std::string::npos);
	saveObjectMap(path("map.objmap"), mapOf(ballAndBox(), {kCup, kBook}));
	const std::string whole = contents(path("map.objmap"));
	for (const double share : {0.0, 0.01, 0.5, 0.99})
	{
		std::ofstream(path("cut.objmap"), std::ios::binary)
			<< whole.substr(0, std::size_t(share * double(whole.size())));
		EXPECT_NE(errorOf(path("cut.objmap")).find("cut short"), std::string::npos) << share;
	}
	std::ofstream(path("text.objmap")) << "this is no map at all, but a line of text";
	EXPECT_NE(errorOf(path("text.objmap")).find("not an object map"), std::string::npos);
	{
		mrpt::io::CFileGZOutputStream file(path("other.objmap"));
		mrpt::serialization::archiveFrom(file) << mrpt::obs::CObservationOdometry();
	}
	EXPECT_NE(errorOf(path("other.objmap")).find("CObservationOdometry"), std::string::npos);
}

TEST_F(ObjectFiles, DamageInsideTheMapIsNoticed)
{
	CObjectMap map = emptyMap();
	map.insertionOptions.voxelsPerSide = 16;  // a small file
	const View view = renderView(ballAndBox(), testCamera(), onCircle(0, 8));
	ASSERT_TRUE(map.addObject(view.frame, makeInstance(view.masks[1], kCup), onCircle(0, 8)));
	const std::string good = bytesOf(map);
	int refused = 0;
	for (std::size_t at = 0; at < good.size(); at += at < 400 ? 7 : good.size() / 50)
	{
		std::string bad = good;
		bad[at] = char(~bad[at]);
		{
			mrpt::io::CFileGZOutputStream file(path("bad.objmap"));
			file.Write(bad.data(), bad.size());
		}
		// Some bytes are colours or distances: anything but an error or a sound map is a failure.
		try
		{
			loadObjectMap(path("bad.objmap"))->predict(testCamera(), onCircle(0, 8));
		}
		catch (const InputError&)
		{
			++refused;
		}
	}
	EXPECT_GT(refused, 0);
}

TEST_F(ObjectFiles, UnwritablePlacesAreNamed)
{
	const std::string nowhere = path("no/such/folder/file");
	EXPECT_THROW(saveObjectMap(nowhere, CObjectMap()), InputError);
	EXPECT_THROW(savePly(nowhere, TriangleMesh(), CPose3D()), InputError);
	EXPECT_THROW(CObjectMap().saveMetricMapRepresentationToFile(nowhere), InputError);
}

TEST_F(ObjectFiles, APlyHoldsTheMeshInWorldCoordinates)
{
	TriangleMesh mesh;
	mesh.vertices = {
		{{1, 0, 0}, {1, 0, 0}, {255, 0, 7}},
		{{0, 1, 0}, {0, 1, 0}, {0, 255, 0}},
		{{0, 0, 1}, {0, 0, 1}, {0, 0, 255}},
		{{1, 1, 1}, {0, 0, 1}, {9, 9, 9}}};
	mesh.triangles = {{0, 1, 2}, {3, 2, 1}};
	savePly(path("mesh.ply"), mesh, CPose3D(10, 20, 30, M_PI / 2, 0, 0));

	const std::string file = contents(path("mesh.ply"));
	const std::string end = "end_header\n";
	const auto body = file.find(end) + end.size();
	const std::string header = file.substr(0, body);
	EXPECT_EQ(header.find("ply\nformat binary_little_endian 1.0\n"), 0U);
	EXPECT_NE(header.find("element vertex 4\n"), std::string::npos);
	EXPECT_NE(header.find("element face 2\n"), std::string::npos);
	ASSERT_EQ(file.size() - body, 4U * (6 * 4 + 3) + 2U * (1 + 3 * 4));

	// The x axis turns to y: vertex 0 lies at (10, 21, 30) with normal (0, 1, 0).
	float numbers[6];
	std::memcpy(numbers, file.data() + body, sizeof(numbers));
	const float expected[6] = {10, 21, 30, 0, 1, 0};
	for (int i = 0; i < 6; ++i) EXPECT_NEAR(numbers[i], expected[i], 1e-6);
	EXPECT_EQ(uint8_t(file[body + 24]), 255);
	EXPECT_EQ(uint8_t(file[body + 26]), 7);
	int32_t last[3];
	std::memcpy(last, file.data() + file.size() - 12, sizeof(last));
	EXPECT_EQ(last[0], 3);
	EXPECT_EQ(last[2], 1);
}

TEST_F(ObjectFiles, TheMetricMapWritesASceneTheMapAndAMeshPerObject)
{
	const CObjectMap map = mapOf(ballAndBox(), {kCup, kChair});
	map.saveMetricMapRepresentationToFile(path("out"));
	mrpt::opengl::COpenGLScene scene;
	EXPECT_TRUE(scene.loadFromFile(path("out.3Dscene")));
	EXPECT_EQ(bytesOf(*loadObjectMap(path("out.objmap"))), bytesOf(map));
	EXPECT_GT(std::filesystem::file_size(path("out_objects/0_cup.ply")), 10000U);
	EXPECT_GT(std::filesystem::file_size(path("out_objects/1_dining-chair.ply")), 10000U);
}

TEST_F(ObjectFiles, MeshesOfTheMapBeforeAreRemovedAndOtherFilesStay)
{
	mapOf(ballAndBox(), {kCup, kChair}).saveMetricMapRepresentationToFile(path("out"));
	std::ofstream(path("out_objects/notes.txt")) << "mine";
	mapOf(ballAndBox(), {kChair, kCup}).saveMetricMapRepresentationToFile(path("out"));
	std::set<std::string> names;
	for (const auto& entry : std::filesystem::directory_iterator(path("out_objects")))
		names.insert(entry.path().filename().string());
	EXPECT_EQ(names, (std::set<std::string>{"0_dining-chair.ply", "1_cup.ply", "notes.txt"}));
}


// Whether places are seen again in the scenes of config_ini/scenes, from how different directions.
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFile.h>
#include <semloop/simulation/CameraPath.h>
#include <semloop/simulation/SceneBuilder.h>
#include <semloop/simulation/SceneRenderer.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>
#include <set>

using namespace semloop;

namespace
{
constexpr double kRate = 1.0;      // [Hz]
constexpr int kSeenPixels = 400;   // of 640 x 480
constexpr double kLongAgo = 20.0;  // [s]

struct Glance
{
	double time = 0;     // [s]
	double heading = 0;  // [rad]
	std::set<uint16_t> objects;
};

std::set<uint16_t> objectsIn(const cv::Mat& view)
{
	std::vector<int> pixels(1 << 16, 0);
	for (int y = 0; y < view.rows; ++y)
		for (int x = 0; x < view.cols; ++x) ++pixels[view.at<uint16_t>(y, x)];
	std::set<uint16_t> seen;
	for (std::size_t id = 1; id < pixels.size(); ++id)
		if (pixels[id] > kSeenPixels) seen.insert(uint16_t(id));
	return seen;
}

std::vector<Glance> glances(const std::string& name)
{
	const mrpt::config::CConfigFile config(
		SEMLOOP_SOURCE_DIR "/config_ini/scenes/" + name + ".ini");
	const auto description =
		SceneDescription::load(config, {"depth_sensor", "color_sensor", "detector", "odometry"});
	const auto built = buildScene(description, FurnitureCatalog::open(), 1);
	const SceneRenderer renderer(built.scene);
	const auto camera = cameraOf(description.camera);
	std::vector<Glance> all;
	for (const auto& pose :
		 carriedCamera(built.way, description.path, kRate, mrpt::Clock::fromDouble(0), 1))
	{
		const auto look = pose.pose.rotateVector({0, 0, 1});
		all.push_back(
			{mrpt::Clock::toDouble(pose.time), std::atan2(look.y, look.x),
			 objectsIn(renderer.render(camera, pose.pose, false).object)});
	}
	return all;
}

int commonObjects(const Glance& a, const Glance& b)
{
	int common = 0;
	for (const auto id : a.objects) common += int(b.objects.count(id));
	return common;
}

double turnBetween(const Glance& a, const Glance& b)
{
	return mrpt::RAD2DEG(std::abs(std::remainder(a.heading - b.heading, 2 * M_PI)));
}

class SceneLoops : public testing::Test
{
protected:
	void SetUp() override
	{
		if (!std::filesystem::exists(FurnitureCatalog::kDefaultFolder))
			GTEST_SKIP() << "sweethome3d-furniture is not installed";
	}
	static void expectOppositeViews(const std::string& scene)
	{
		int pairs = 0;
		const auto all = glances(scene);
		for (const auto& a : all)
			for (const auto& b : all)
				pairs += b.time > a.time + kLongAgo && turnBetween(a, b) > 120 &&
						 commonObjects(a, b) >= 4;
		EXPECT_GE(pairs, 5);
	}
	static void expectNothingSeenAgain(const std::string& scene)
	{
		const auto all = glances(scene);
		for (const auto& a : all)
			for (const auto& b : all)
			{
				if (b.time <= a.time + kLongAgo) continue;
				EXPECT_LT(commonObjects(a, b), 3) << a.time << " s and " << b.time << " s";
			}
	}
};
}  // namespace

TEST_F(SceneLoops, TheApartmentShowsFourObjectsFromOppositeSides)
{
	expectOppositeViews("apartment");
}

TEST_F(SceneLoops, TheOfficeShowsFourObjectsFromOppositeSides)
{
	expectOppositeViews("office");
}

TEST_F(SceneLoops, TheCorridorShowsNothingAgain)
{
	expectNothingSeenAgain("corridor");
}

TEST_F(SceneLoops, TheRoomsInARowShowNothingAgain)
{
	expectNothingSeenAgain("no_loop");
}

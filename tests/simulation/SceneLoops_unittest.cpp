// Whether places are seen again in the scenes of config_ini/scenes, from how different directions.
#include <gtest/gtest.h>
#include <semloop/simulation/CameraPath.h>
#include <semloop/simulation/SceneRenderer.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <set>
#include <tuple>

#include "DescribedScenes.h"

using namespace semloop;

namespace
{
constexpr double kRate = 1.0;  // [Hz]
constexpr int kWidth = 320, kHeight = 240;
constexpr int kSeenPixels = 100;   // 400 of 640 x 480
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

std::vector<Glance> glances(const std::string& name, uint64_t seed)
{
	auto description = describe(name);
	description.camera.width = kWidth;
	description.camera.height = kHeight;
	const auto built = buildScene(description, catalog(), seed);
	const SceneRenderer renderer(built.scene);
	const auto camera = cameraOf(description.camera);
	std::vector<Glance> all;
	for (const auto& pose :
		 carriedCamera(built.way, description.path, kRate, mrpt::Clock::fromDouble(0), seed))
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

/** A scene and a seed. */
class SceneLoops : public testing::TestWithParam<std::tuple<std::string, uint64_t>>
{
protected:
	void SetUp() override
	{
		if (!hasFurniture()) GTEST_SKIP() << "sweethome3d-furniture is not installed";
		all_ = std::apply(glances, GetParam());
	}
	std::vector<Glance> all_;
};
class OppositeViews : public SceneLoops
{
};
class NothingAgain : public SceneLoops
{
};

auto scenesAndSeeds(const std::string& one, const std::string& other)
{
	return testing::Combine(testing::Values(one, other), testing::Range<uint64_t>(1, kSeeds + 1));
}

const auto kName = [](const auto& scene)
{ return std::get<0>(scene.param) + "_seed" + std::to_string(std::get<1>(scene.param)); };
}  // namespace

TEST_P(OppositeViews, FourObjectsAreSeenFromOppositeSides)
{
	int pairs = 0;
	for (const auto& a : all_)
		for (const auto& b : all_)
			pairs +=
				b.time > a.time + kLongAgo && turnBetween(a, b) > 120 && commonObjects(a, b) >= 4;
	EXPECT_GE(pairs, 5);
}
INSTANTIATE_TEST_SUITE_P(Scene, OppositeViews, scenesAndSeeds("apartment", "office"), kName);

TEST_P(NothingAgain, NoThreeObjectsAreSeenASecondTime)
{
	for (const auto& a : all_)
		for (const auto& b : all_)
		{
			if (b.time <= a.time + kLongAgo) continue;
			EXPECT_LT(commonObjects(a, b), 3) << a.time << " s and " << b.time << " s";
		}
}
INSTANTIATE_TEST_SUITE_P(Scene, NothingAgain, scenesAndSeeds("corridor", "no_loop"), kName);

// What stands and hangs in the rooms of config_ini/scenes, besides where it stands (Scenes_unittest.cpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "DescribedScenes.h"

using namespace semloop;

namespace
{
template <class Test>
class WithFurniture : public Test
{
protected:
	void SetUp() override
	{
		if (!hasFurniture()) GTEST_SKIP() << "sweethome3d-furniture is not installed";
	}
};
using SceneLamps = WithFurniture<testing::TestWithParam<std::string>>;
using OfficeModels = WithFurniture<testing::Test>;
using ApartmentModels = WithFurniture<testing::TestWithParam<uint64_t>>;

/** How often each model stands in a scene. */
std::map<std::string, int> modelsOf(const SceneDescription& scene, uint64_t seed)
{
	std::map<std::string, int> models;
	for (const auto& object : buildScene(scene, catalog(), seed).scene.objects)
		++models[object.model];
	return models;
}

/** Those that a section of models.ini allows: "primitive:book#3" is a primitive:book. */
std::map<std::string, int> ofItem(const std::map<std::string, int>& models, const ItemOptions& item)
{
	std::map<std::string, int> result;
	for (const auto& [model, count] : models)
	{
		const bool made = model.rfind("primitive:", 0) == 0;
		const auto id = made ? model.substr(0, model.rfind('#')) : model;
		if (std::count(item.models.begin(), item.models.end(), id) != 0) result[model] = count;
	}
	return result;
}
}  // namespace

TEST_P(SceneLamps, HangInEveryRoomAtLeastTwo)
{
	const auto description = describe(GetParam());
	const auto built = buildScene(description, catalog(), 1);
	std::size_t inRooms = 0;
	for (const auto& room : built.plan.rooms())
	{
		std::set<std::pair<float, float>> places;
		for (const auto& light : built.scene.lights)
		{
			const Eigen::Vector2d place = light.position.head<2>().cast<double>();
			if (distance(room.footprint(), place) > 0) continue;
			places.insert({light.position.x(), light.position.y()});
			EXPECT_GT(light.position.z(), FloorPlan::kDoorHeight) << "above what stands there";
			EXPECT_LT(light.position.z(), description.scene.height);
			EXPECT_GT(light.intensity, 0);
		}
		EXPECT_GE(places.size(), 2u) << room.name;
		inRooms += places.size();
	}
	EXPECT_EQ(inRooms, built.scene.lights.size()) << "none hangs in a wall or where another does";
}

INSTANTIATE_TEST_SUITE_P(
	All, SceneLamps, testing::ValuesIn(kScenes), [](const auto& scene) { return scene.param; });

TEST_F(OfficeModels, TheDesksAreAllTheSameWithWhatBelongsToThem)
{
	const auto office = describe("office");
	std::set<std::string> desks;
	for (uint64_t seed = 1; seed <= kSeeds; ++seed)
	{
		const auto models = modelsOf(office, seed);
		// Seven desks with a chair each, six of them with a monitor.
		for (const auto& [item, count] : std::map<std::string, int>{
				 {"desk", 7}, {"office_chair", 7}, {"monitor", 6}, {"keyboard", 6}, {"mouse", 6}})
		{
			const auto own = ofItem(models, office.items.at(item));
			ASSERT_EQ(own.size(), 1u) << item << ", seed " << seed;
			EXPECT_EQ(own.begin()->second, count) << item << ", seed " << seed;
		}
		desks.insert(ofItem(models, office.items.at("desk")).begin()->first);
	}
	EXPECT_GT(desks.size(), 1u) << "the seed chooses the model";
}

TEST_P(ApartmentModels, SomeStandThereMoreThanOnce)
{
	const auto models = modelsOf(describe("apartment"), GetParam());
	const auto repeated = std::count_if(
		models.begin(), models.end(), [](const auto& model) { return model.second > 1; });
	EXPECT_GE(repeated, 3);
	EXPECT_GT(models.size(), 30u) << "most are of their own";
}
INSTANTIATE_TEST_SUITE_P(
	Seed, ApartmentModels, testing::Range<uint64_t>(1, kSeeds + 1),
	testing::PrintToStringParamName());

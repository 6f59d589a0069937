#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFile.h>
#include <semloop/config/Error.h>
#include <semloop/simulation/SceneBuilder.h>

#include "TemporaryFolder.h"

using namespace semloop;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

namespace
{
const std::string kModels =
	"[desk]\nlabel = desk\nmodels = A#desk\nplace = wall\n"
	"[cup]\nlabel = cup\nmodels = A#cup\nplace = top\n"
	"[chair]\nlabel = chair\nmodels = A#chair, B#chair\n";
const std::string kRoom =
	"[room.den]\ncorner = 1, 2\nsize = 4, 3\nfurniture = desk + cup > chair\n";
const std::string kPath = "[path]\nwaypoints = 1.5 2.5, 4.5 2.5\n";

class SceneDescriptionTest : public testing::Test
{
protected:
	SceneDescription load(const std::string& scene, const std::string& models = kModels)
	{
		folder_.write("models.ini", models);
		const mrpt::config::CConfigFile config(folder_.write("den.ini", scene));
		return SceneDescription::load(config, {"sensor"});
	}
	/** The message, which names file and section first. */
	template <class Error = UsageError>
	std::string errorOf(const std::string& scene, const std::string& models = kModels)
	{
		return messageOf<Error>(
			[&]
			{
				const auto description = load(scene, models);
				description.floorPlan();
				description.waypoints();
				for (const auto& [name, room] : description.rooms)
					for (const auto& text : room.furniture) description.group(name, text);
			});
	}
	std::string place(const std::string& words) const
	{
		return folder_.file("den.ini") + ": " + words;
	}

	TemporaryFolder folder_;
};
}  // namespace

TEST_F(SceneDescriptionTest, ReadsRoomsPathAndModels)
{
	const auto scene =
		load("[scene]\ndoors = 5.05 3.5 0.8\n" + kRoom + kPath + "[sensor]\nx = 1\n");
	const FloorPlan plan = scene.floorPlan();
	ASSERT_EQ(plan.rooms().size(), 1u);
	EXPECT_EQ(plan.rooms()[0].name, "den");
	EXPECT_EQ(plan.rooms()[0].corner, Eigen::Vector2d(1, 2));
	EXPECT_EQ(plan.rooms()[0].size, Eigen::Vector2d(4, 3));
	EXPECT_EQ(plan.doors().at(0).width, 0.8);
	EXPECT_THAT(
		scene.waypoints(), ElementsAre(Eigen::Vector2d(1.5, 2.5), Eigen::Vector2d(4.5, 2.5)));
	EXPECT_THAT(scene.items.at("chair").models, ElementsAre("A#chair", "B#chair"));
}

TEST_F(SceneDescriptionTest, AGroupHasABaseAndThingsOnTopAndAround)
{
	const auto scene = load(kRoom + kPath);
	const auto group = scene.group("den", "desk + cup + cup > chair > chair");
	EXPECT_EQ(group.base, "desk");
	EXPECT_THAT(group.onTop, ElementsAre("cup", "cup"));
	EXPECT_THAT(group.around, ElementsAre("chair", "chair"));
	const auto tight = scene.group("den", "desk+cup>chair");
	EXPECT_THAT(tight.onTop, ElementsAre("cup"));
	EXPECT_THAT(tight.around, ElementsAre("chair"));
}

TEST_F(SceneDescriptionTest, AWrongGroupIsNamedWithFileSectionAndKey)
{
	for (const std::string group :
		 {"dask", "desk + cap", "desk +", "+ desk", "desk + + cup", "desk > > chair", "desk cup",
		  "desk >"})
		EXPECT_THAT(
			errorOf("[room.den]\ncorner = 0, 0\nsize = 4, 3\nfurniture = " + group + "\n" + kPath),
			AllOf(
				HasSubstr(place("[room.den] furniture = " + group)),
				HasSubstr("no section of " + folder_.file("models.ini"))))
			<< group;
}

TEST_F(SceneDescriptionTest, UnknownSectionsAndKeysAreNamed)
{
	EXPECT_THAT(errorOf(kRoom + kPath + "[rooms.x]\nsize = 1, 1\n"), HasSubstr(place("[rooms.x]")));
	EXPECT_THAT(errorOf(kRoom + kPath + "spead = 1\n"), HasSubstr(place("[path] spead")));
	EXPECT_THAT(errorOf("[room.a]\nwidth = 3\n" + kPath), HasSubstr(place("[room.a] width")));
	EXPECT_THAT(errorOf(kPath), AllOf(HasSubstr("den.ini"), HasSubstr("no [room.NAME]")));
}

TEST_F(SceneDescriptionTest, NumbersThatAreNoneAreNamed)
{
	const auto room = [](const std::string& keys) { return "[room.a]\n" + keys + kPath; };
	EXPECT_THAT(errorOf(room("size = 4, 3\n")), HasSubstr(place("[room.a] corner")));
	EXPECT_THAT(errorOf(room("corner = 0, 0\nsize = 4\n")), HasSubstr(place("[room.a] size = 4")));
	EXPECT_THAT(
		errorOf(room("corner = 0, 0\nsize = 4, wide\n")),
		HasSubstr(place("[room.a] size = 4 wide")));
	EXPECT_THAT(errorOf(room("corner = 0, 0\nsize = 4, 0.2\n")), HasSubstr(place("[room.a] size")));
	EXPECT_THAT(
		errorOf("[scene]\ndoors = 1 2\n" + kRoom + kPath), HasSubstr(place("[scene] doors = 1 2")));
	EXPECT_THAT(
		errorOf("[scene]\ndoors = 5.05 3.5 0.1\n" + kRoom + kPath),
		HasSubstr(place("[scene] doors = 5.05 3.5 0.1")));
	EXPECT_THAT(
		errorOf(kRoom + "[path]\nwaypoints = 1 2, 3 4 5\n"),
		HasSubstr(place("[path] waypoints = 3 4 5")));
	EXPECT_THAT(errorOf(kRoom + "[path]\nwaypoints = 1 2\n"), HasSubstr(place("[path] waypoints")));
	EXPECT_THAT(errorOf(kRoom), HasSubstr("at least two points"));
}

TEST_F(SceneDescriptionTest, ADoorInNoWallNamesTheFile)
{
	EXPECT_THAT(
		errorOf<InputError>("[scene]\ndoors = 3 3.5 0.8\n" + kRoom + kPath),
		AllOf(HasSubstr("den.ini"), HasSubstr("(3, 3.5)")));
}

TEST_F(SceneDescriptionTest, AWrongModelsFileIsNamedWithItsSection)
{
	const std::string scene = kRoom + kPath;
	const std::string file = folder_.file("models.ini");
	EXPECT_THAT(
		errorOf(scene, "[desk]\nmodels = A#desk\n"),
		AllOf(HasSubstr(file + ": [desk]"), HasSubstr("needs both label and models")));
	EXPECT_THAT(errorOf(scene, "[desk]\nlabel = desk\n"), HasSubstr("needs both label and models"));
	EXPECT_THAT(errorOf(scene, kModels + "color = red\n"), HasSubstr(file + ": [chair] color"));
	EXPECT_THAT(errorOf(scene, kModels + "place = roof\n"), HasSubstr("[chair] place = roof"));
	for (const std::string spot : {"0", "0, left", "0, 1.5"})
		EXPECT_THAT(errorOf(scene, kModels + "spot = " + spot + "\n"), HasSubstr("[chair] spot"))
			<< spot;
	EXPECT_THAT(
		errorOf<InputError>("[scene]\nmodels = none.ini\n" + scene),
		AllOf(HasSubstr(folder_.file("none.ini")), HasSubstr("no such models file")));
}

TEST_F(SceneDescriptionTest, CameraHeightsMustFitTheRoom)
{
	const auto build = [&](const std::string& heights)
	{
		return messageOf<UsageError>(
			[&] { buildScene(load(kRoom + kPath + heights), FurnitureCatalog(), 1); });
	};
	for (const std::string heights :
		 {"minimum_height = 1.5\nmaximum_height = 1.2\n", "maximum_height = 2.6\n"})
		EXPECT_THAT(build(heights), HasSubstr(place("[path] minimum_height"))) << heights;
}

TEST_F(SceneDescriptionTest, AModelThatTheCatalogueLacksIsNamedWhateverTheSeedDraws)
{
	const auto scene = load(kRoom + kPath);
	for (uint64_t seed = 1; seed < 4; ++seed)
		EXPECT_THAT(
			messageOf<InputError>([&] { buildScene(scene, FurnitureCatalog(), seed); }),
			AllOf(HasSubstr("models.ini: [chair] models"), HasSubstr("A#chair")));
}

TEST(CameraOfScene, ItsFieldOfViewIsTheImagesWidth)
{
	CameraOptions options;
	options.width = 200;
	options.height = 100;
	options.fieldOfView = M_PI / 2;
	const auto camera = cameraOf(options);
	EXPECT_NEAR(camera.fx(), 100, 1e-9);
	EXPECT_EQ(camera.fx(), camera.fy());
	EXPECT_EQ(camera.cx(), 99.5);
	EXPECT_EQ(camera.cy(), 49.5);
}

#include <gtest/gtest.h>
#include <semloop/object_map/CObjectMap.h>

#include "ObjectMapFixtures.h"

using namespace semloop;
using namespace semloop::synthetic;

namespace
{
using Pairs = std::vector<std::pair<ObjectId, ObjectId>>;

/** Adds every object of the scene as seen once by a camera that believes to be displaced by `drift`;
 *  returns the ids. */
std::vector<ObjectId> addAgain(
	CObjectMap& map, const Scene& scene, const std::vector<uint32_t>& labels, int place,
	const CPose3D& drift)
{
	std::vector<ObjectId> ids;
	const View view = renderView(scene, testCamera(), onCircle(place, 8));
	for (std::size_t id = 1; id < view.masks.size(); ++id)
		ids.push_back(map.addObject(
							 view.frame, makeInstance(view.masks[id], labels.at(id - 1)),
							 drift + onCircle(place, 8))
						  .value());
	return ids;
}

/** Books of 20 x 15 x 2 cm lying at these places; seen from eight sides. */
CObjectMap booksAt(const std::vector<TPoint3D>& places)
{
	Scene scene;
	int id = 1;
	for (const auto& p : places)
		scene.boxes.push_back(
			{CPose3D(p.x, p.y, p.z, 0, 0, 0), {0.2, 0.15, 0.02}, {50, 50, 50}, id++, 0});
	return mapOf(scene, std::vector<uint32_t>(places.size(), kBook));
}
}  // namespace

TEST(CObjectMapLoopClosure, DriftMakesDuplicatesThatAMoveBringsTogetherAndAMergeUnites)
{
	const std::vector<uint32_t> labels = {kCup, kBook};
	CObjectMap map = mapOf(ballAndBox(), labels);
	EXPECT_TRUE(map.findDuplicates().empty());
	const CPose3D drift(0.8, 0, 0, 0, 0, 0);
	const auto again = addAgain(map, ballAndBox(), labels, 2, drift);
	ASSERT_EQ(again, (std::vector<ObjectId>{2, 3}));
	EXPECT_TRUE(map.findDuplicates().empty());

	std::map<ObjectId, CPose3D> corrected;
	for (const ObjectId id : again) corrected[id] = (-drift) + map.object(id).T_world_object;
	map.moveObjects(corrected);
	auto duplicates = map.findDuplicates();
	std::sort(duplicates.begin(), duplicates.end());
	EXPECT_EQ(duplicates, (Pairs{{0, 2}, {1, 3}}));
	EXPECT_EQ(map.findDuplicates(std::set<ObjectId>{0, 1, 3}), (Pairs{{1, 3}}));
	EXPECT_EQ(map.findDuplicates(std::set<ObjectId>{}), Pairs{});

	for (const auto& [kept, absorbed] : map.findDuplicates()) map.mergeObjects(kept, absorbed);
	ASSERT_EQ(map.objects().size(), 2U);
	EXPECT_TRUE(map.findDuplicates().empty());
	EXPECT_EQ(map.object(0).observations, 9);
	// Merging what fits changes no shape.
	EXPECT_NEAR(map.object(1).extent().x, 0.3, 0.03);
	EXPECT_NEAR(map.object(1).extent().y, 0.2, 0.03);
	EXPECT_LT(map.object(1).centre().distanceTo({0, 0.45, 0.775}), 0.02);
}

TEST(CObjectMapLoopClosure, MergingAddsTheEvidenceOfBoth)
{
	CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	const ObjectId third = addAgain(map, ballAndBox(), {kBook, kBook}, 2, CPose3D()).front();
	map.markCovisible({0, 1});
	map.markCovisible({1, third});
	map.markCovisible({0, third});
	map.mergeObjects(0, third);
	// eight times cup, once book
	const Object& merged = map.object(0);
	ASSERT_EQ(merged.labelScores.size(), 2U);
	EXPECT_EQ(merged.labelScores[0].label, kCup);
	EXPECT_NEAR(merged.labelScores[0].score, 8.0 / 9, 1e-6);
	EXPECT_NEAR(merged.labelScores[1].score, 1.0 / 9, 1e-6);
	EXPECT_EQ(merged.covisible, (std::map<ObjectId, int>{{1, 2}}));
	EXPECT_EQ(map.object(1).covisible, (std::map<ObjectId, int>{{0, 2}}));
	EXPECT_EQ(map.objects().count(third), 0U);
	EXPECT_THROW(map.mergeObjects(0, 0), std::invalid_argument);
	EXPECT_THROW(map.mergeObjects(0, third), std::out_of_range);
	EXPECT_THROW(map.mergeObjects(third, 0), std::out_of_range);
}

TEST(CObjectMapLoopClosure, OneSurfaceUnderTwoNamesIsOneObject)
{
	CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	addAgain(map, ballAndBox(), {kBook, kBook}, 2, CPose3D());
	auto duplicates = map.findDuplicates();
	std::sort(duplicates.begin(), duplicates.end());
	EXPECT_EQ(duplicates, (Pairs{{0, 2}, {1, 3}}));
	map.maintenanceOptions.mergeIou = 0.9;
	EXPECT_EQ(map.findDuplicates(), (Pairs{{1, 3}})) << "the surface alone does for one label only";
}

TEST(CObjectMapLoopClosure, LabelsAreCompatibleWhenTheDistributionsOverlap)
{
	const auto duplicatesWith = [](const LabelScores& scores)
	{
		CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
		map.maintenanceOptions.mergeIou = 0.9;  // the surface has to do
		const View view = renderView(ballAndBox(), testCamera(), onCircle(2, 8));
		Instance ball = makeInstance(view.masks[1], kBook);
		ball.labelScores = scores;
		map.addObject(view.frame, ball, onCircle(2, 8));
		return map.findDuplicates();
	};
	EXPECT_EQ(duplicatesWith({{kBook, 1.f}}), Pairs{});
	EXPECT_EQ(duplicatesWith({{kBook, 0.8f}, {kCup, 0.2f}}), Pairs{});
	EXPECT_EQ(duplicatesWith({{kBook, 0.5f}, {kCup, 0.45f}}), (Pairs{{0, 2}}));
}

TEST(CObjectMapLoopClosure, NeighboursStandingSideBySideOrStackedStayApart)
{
	EXPECT_EQ(
		booksAt({{0, 0, 0.75}, {0, 0.2, 0.75}, {0.28, 0, 0.75}, {0, -0.2, 0.75}}).findDuplicates(),
		Pairs{});
	EXPECT_EQ(booksAt({{0, 0, 0.75}, {0, 0, 0.79}}).findDuplicates(), Pairs{});
}

TEST(CObjectMapLoopClosure, ThinObjectsAreDuplicatesWhenTheirPlacesAre)
{
	CObjectMap map = booksAt({{0, 0, 0.75}});
	Scene one;
	one.boxes.push_back({CPose3D(0, 0, 0.75, 0, 0, 0), {0.2, 0.15, 0.02}, {50, 50, 50}, 1, 0});
	addAgain(map, one, {kBook}, 1, CPose3D(0.02, 0.01, 0.012, 0, 0, 0));
	EXPECT_EQ(map.findDuplicates(), (Pairs{{0, 1}}));
}

TEST(CObjectMapLoopClosure, ThePartOfAnObjectIsInsideTheWhole)
{
	CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	const View view = renderView(ballAndBox(), testCamera(), onCircle(2, 8));
	// A quarter of the mask of the box: IoU of the boxes is far below 0.3.
	const cv::Rect box = view.masks[2].boundingBox();
	cv::Mat part = cv::Mat::zeros(240, 320, CV_8UC1);
	part(cv::Rect(box.x, box.y, box.width / 2, box.height)).setTo(255);
	part.setTo(0, view.ids != 2);
	map.addObject(view.frame, makeInstance(InstanceMask::encode(part), kBook), onCircle(2, 8));
	EXPECT_EQ(map.findDuplicates(), (Pairs{{1, 2}}));
}

TEST(CObjectMapLoopClosure, ManyCopiesMergeIntoTheOldestWhenAskedUntilThereIsNone)
{
	CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	for (int i = 1; i < 5; ++i)
		addAgain(map, ballAndBox(), {kCup, kBook}, i, CPose3D(0.01 * i, -0.01, 0, 0, 0, 0));
	ASSERT_EQ(map.objects().size(), 10U);
	for (auto pairs = map.findDuplicates(); !pairs.empty(); pairs = map.findDuplicates())
		for (const auto& [kept, absorbed] : pairs) map.mergeObjects(kept, absorbed);
	std::vector<ObjectId> left;
	for (const auto& [id, object] : map.objects()) left.push_back(id);
	EXPECT_EQ(left, (std::vector<ObjectId>{0, 1}));
}

#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <semloop/object_map/CObjectMap.h>
#include <semloop/object_map/SeenSides.h>

#include <cmath>

#include "ObjectMapFixtures.h"

using namespace semloop;
using namespace semloop::synthetic;

namespace
{
constexpr unsigned long kLeft = 1, kRight = 2, kBack = 4, kFront = 8, kTop = 16;

unsigned long seenFrom(const mrpt::math::TPoint3D& camera)
{
	SeenSides sides;
	sides.seenFrom(camera);
	return sides.bits();
}

/** A box on a table, seen from these azimuths [degrees], 45 degrees down. */
SeenSides mapped(const std::vector<double>& azimuths, int width = 320)
{
	Scene scene;
	scene.boxes.push_back({CPose3D(0, 0, 0.8, 0, 0, 0), {0.3, 0.3, 0.3}, {0, 0, 200}, 1, 0});
	CObjectMap map = emptyMap();
	std::optional<ObjectId> id;
	for (const double degrees : azimuths)
	{
		const double a = degrees * M_PI / 180;
		const auto pose = lookAt({std::cos(a), std::sin(a), 1.8}, {0, 0, 0.8});
		const auto view = renderView(scene, makeCamera(width, 240, 262), pose);
		const auto instance = makeInstance(view.masks[1], kBook);
		if (!id)
			id = map.addObject(view.frame, instance, pose);
		else
			map.fuse(*id, view.frame, instance, pose);
	}
	return map.object(id.value()).seenSides;
}
}  // namespace

TEST(SeenSides, AreThoseThatACameraLooksAtByMoreThanTwentyDegrees)
{
	EXPECT_EQ(seenFrom({2, 0, 0}), kRight);
	EXPECT_EQ(seenFrom({-2, -2, 0}), kLeft | kBack);
	EXPECT_EQ(seenFrom({1, 1, 1}), kRight | kFront | kTop);
	EXPECT_EQ(seenFrom({0, 0, -1}), 0UL) << "the bottom is no side";
	EXPECT_EQ(seenFrom({1, std::tan(19 * M_PI / 180), 0}), kRight);
	EXPECT_EQ(seenFrom({1, std::tan(21 * M_PI / 180), 0}), kRight | kFront);
	EXPECT_EQ(seenFrom({0, 0, 0}), 0UL) << "from inside";
}

TEST(SeenSides, AddUpToCompleteness)
{
	SeenSides sides;
	EXPECT_EQ(sides.completeness(), 0);
	sides.seenFrom({1, 0, 1});
	EXPECT_DOUBLE_EQ(sides.completeness(), 0.4);
	EXPECT_TRUE(sides.isMeasured(2));
	EXPECT_FALSE(sides.isMeasured(0));
	sides.seenFrom({-1, 0, 0});
	EXPECT_TRUE(sides.isMeasured(0));
	EXPECT_FALSE(sides.isMeasured(1));
	sides.seenFrom({0, 1, 0});
	sides.seenFrom({0, -1, 0});
	EXPECT_TRUE(sides.all());
	EXPECT_EQ(sides.completeness(), 1);
	EXPECT_THROW(SeenSides(32), std::invalid_argument);
	EXPECT_EQ(SeenSides(kLeft | kTop).bits(), kLeft | kTop);
}

TEST(SeenSides, OfAnObjectThatIsTurnedGoToTheNearestOfOurs)
{
	SeenSides sides;
	sides.add(SeenSides(kRight | kTop), CPose3D(1, 2, 3, M_PI / 2, 0, 0));
	EXPECT_EQ(sides.bits(), kFront | kTop);
	sides.add(SeenSides(kRight), CPose3D(0, 0, 0, -0.7, 0, 0));
	EXPECT_EQ(sides.bits(), kFront | kTop | kRight);
}

TEST(SeenSides, WidenTheCentreBySoMuch)
{
	EXPECT_EQ(centreSigma(1, 2), 0);
	EXPECT_DOUBLE_EQ(centreSigma(0, 2), 0.5);
	EXPECT_NEAR(centreSigma(0.4, 0.5), 0.045, 1e-12);
}

TEST(SeenSides, TheMapRemembersThemForEachObject)
{
	EXPECT_EQ(mapped({0}).bits(), kRight | kTop);
	EXPECT_EQ(mapped({0, 45}).bits(), kRight | kFront | kTop);
	EXPECT_TRUE(mapped({0, 90, 180, 270}).all());
	// A picture so narrow that it cuts the box: what is missing may be anything.
	EXPECT_EQ(mapped({0}, 60).bits(), 0UL);
}

TEST(SeenSides, AreMergedAndSavedWithTheObject)
{
	CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	const auto sides = map.object(1).seenSides;
	EXPECT_GT(sides.completeness(), 0.5);
	mrpt::io::CMemoryStream stream;
	auto archive = mrpt::serialization::archiveFrom(stream);
	archive << map;
	stream.Seek(0);
	CObjectMap back;
	archive >> back;
	EXPECT_EQ(back.object(1).seenSides.bits(), sides.bits());

	const View view = renderView(ballAndBox(), testCamera(), onCircle(0, 8));
	const auto once =
		map.addObject(view.frame, makeInstance(view.masks[2], kBook), onCircle(0, 8)).value();
	EXPECT_LT(map.object(once).seenSides.completeness(), sides.completeness());
	map.mergeObjects(once, 1);
	EXPECT_EQ(map.object(once).seenSides.bits() & sides.bits(), sides.bits());
}

TEST(SeenSides, OfMapsFromBeforeCountAsSeen)
{
	CObjectMap map = emptyMap();
	const View view = renderView(ballAndBox(), testCamera(), onCircle(0, 8));
	const auto id = map.addObject(view.frame, makeInstance(view.masks[1], kCup), onCircle(0, 8));
	ASSERT_FALSE(map.object(id.value()).seenSides.all());
	std::string bytes = bytesOf(map);
	// Version 1 had no byte of sides, the last before the end mark.
	const std::string name = "semloop::CObjectMap";
	const auto at = bytes.find(name);
	ASSERT_NE(at, std::string::npos);
	ASSERT_EQ(bytes[at + name.size()], 2);
	bytes[at + name.size()] = 1;
	bytes.erase(bytes.size() - 2, 1);
	mrpt::io::CMemoryStream stream;
	stream.Write(bytes.data(), bytes.size());
	stream.Seek(0);
	CObjectMap back;
	mrpt::serialization::archiveFrom(stream) >> back;
	EXPECT_TRUE(back.object(id.value()).seenSides.all());
	EXPECT_EQ(back.object(id.value()).lastSeen, map.object(id.value()).lastSeen);
}

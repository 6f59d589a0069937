#include <gtest/gtest.h>
#include <semloop/evaluation/UprightBox.h>

#include <cmath>

namespace semloop
{
namespace
{
constexpr double kPi = 3.14159265358979323846;

TEST(UprightBox, OverlapsItselfWhollyHoweverItStands)
{
	for (const double yaw : {0.0, 0.3, kPi / 2, -2.5})
	{
		const UprightBox box{{100, -200, 3}, {2, 1, 0.5}, yaw};
		EXPECT_NEAR(intersectionOverUnion(box, box), 1, 1e-12);
	}
}

TEST(UprightBox, HalfMovedBoxesShareAThird)
{
	const UprightBox box{{0, 0, 0}, {1, 1, 1}, 0};
	EXPECT_NEAR(intersectionOverUnion(box, {{0.5, 0, 0}, {1, 1, 1}, 0}), 1.0 / 3, 1e-12);
	EXPECT_NEAR(intersectionOverUnion(box, {{0, 0, 0.5}, {1, 1, 1}, 0}), 1.0 / 3, 1e-12);
	EXPECT_EQ(intersectionOverUnion(box, {{0, 0, 2}, {1, 1, 1}, 0}), 0);
	EXPECT_EQ(intersectionOverUnion(box, {{1.5, 1.5, 0}, {1, 1, 1}, 0}), 0);
}

TEST(UprightBox, TurnedByAQuarterItsSidesChangePlaces)
{
	const UprightBox lying{{0, 0, 0}, {2, 1, 1}, 0};
	EXPECT_NEAR(intersectionOverUnion(lying, {{0, 0, 0}, {1, 2, 1}, kPi / 2}), 1, 1e-12);
	// A cross of two bars: 1 x 1 is common, of 2 + 2 - 1.
	EXPECT_NEAR(intersectionOverUnion(lying, {{0, 0, 0}, {2, 1, 1}, kPi / 2}), 1.0 / 3, 1e-12);
}

TEST(UprightBox, ASquareTurnedByAnEighthSharesAnOctagon)
{
	// The octagon of a unit square has area 2 (sqrt 2 - 1).
	const UprightBox a{{0, 0, 0}, {1, 1, 1}, 0}, b{{0, 0, 0}, {1, 1, 1}, kPi / 4};
	const double shared = 2 * (std::sqrt(2.0) - 1);
	EXPECT_NEAR(intersectionOverUnion(a, b), shared / (2 - shared), 1e-12);
	EXPECT_NEAR(intersectionOverUnion(b, a), shared / (2 - shared), 1e-12);
}

TEST(UprightBox, AFlatBoxOverlapsNothing)
{
	const UprightBox flat{{0, 0, 0}, {1, 1, 0}, 0};
	EXPECT_EQ(intersectionOverUnion(flat, flat), 0);
}

TEST(UprightBox, ContainsWhatIsWithinHalfItsSizeAlongItsAxes)
{
	const UprightBox box{{1, 1, 1}, {2, 0.2, 1}, kPi / 2};
	EXPECT_TRUE(contains(box, {1, 1.9, 1.4}));
	EXPECT_FALSE(contains(box, {1.9, 1, 1}));
	EXPECT_FALSE(contains(box, {1, 1, 1.6}));
	EXPECT_TRUE(contains({{0, 0, 0}, {1, 1, 1}, 0}, {0.5, -0.5, 0.5})) << "on its corner";
}
}  // namespace
}  // namespace semloop

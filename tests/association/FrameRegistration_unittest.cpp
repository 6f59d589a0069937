#include <gtest/gtest.h>
#include <mrpt/math/TPose3D.h>
#include <semloop/association/FrameRegistration.h>

#include <cmath>

using namespace semloop;
using mrpt::math::TPoint3D;
using mrpt::poses::CPose3D;

namespace
{
const LabelScores kChair{{0, 1.0f}};

/** Things with a place, a size and, unless they look all the same, an embedding of their own. */
class Things
{
public:
	explicit Things(std::vector<TPoint3D> places, bool alike = false) : places_(std::move(places))
	{
		for (std::size_t i = 0; i < places_.size(); ++i)
		{
			auto& embeddings = embeddings_.emplace_back();
			if (alike) continue;
			embeddings.emplace_back(places_.size(), 0.0f);
			embeddings.back()[i] = 1;
		}
		radii_.assign(places_.size(), 0.0);
	}

	Things seenAfter(const CPose3D& T_seen_expected) const
	{
		Things result = *this;
		for (auto& place : result.places_) place = T_seen_expected.composePoint(place);
		return result;
	}
	Things& move(std::size_t i, const TPoint3D& by, double radius = 0)
	{
		places_[i] += by;
		radii_[i] = radius;
		return *this;
	}

	std::vector<AssociationItem> items() const
	{
		std::vector<AssociationItem> result;
		for (std::size_t i = 0; i < places_.size(); ++i)
			result.push_back(
				{nullptr, &kChair, &embeddings_[i], SurfaceExtent{places_[i], radii_[i]}});
		return result;
	}

private:
	std::vector<TPoint3D> places_;
	std::vector<std::vector<std::vector<float>>> embeddings_;
	std::vector<double> radii_;
};

Things aDesk(bool alike = false)
{
	return Things(
		{{-0.8, 0.2, 2.0}, {-0.3, -0.4, 2.6}, {0.1, 0.3, 1.8}, {0.7, 0.1, 2.2}, {1.1, -0.3, 3.0}},
		alike);
}

constexpr PoseSigma kNoisy{0.2, 0.15};

FrameRegistration registered(
	const Things& landmarks, const Things& detections, const PoseSigma& prior = kNoisy,
	const FrameRegistrationOptions& options = {})
{
	return registerFrame(landmarks.items(), detections.items(), prior, options);
}

void expectPose(const CPose3D& actual, const CPose3D& expected, double metres, double degrees)
{
	const CPose3D difference = actual - expected;
	EXPECT_LT(difference.norm(), metres) << actual;
	EXPECT_LT(
		std::hypot(difference.yaw(), difference.pitch(), difference.roll()), mrpt::DEG2RAD(degrees))
		<< actual;
}
}  // namespace

TEST(FrameRegistration, FindsTheMotionThatAllShare)
{
	const CPose3D motion(
		0.15, -0.1, 0.2, mrpt::DEG2RAD(8.0), mrpt::DEG2RAD(-5.0), mrpt::DEG2RAD(3.0));
	const auto result = registered(aDesk(), aDesk().seenAfter(motion));
	expectPose(result.T_seen_expected, motion, 0.05, 1.0);
	EXPECT_EQ(result.pairs, 5);
	EXPECT_LT(result.sigma.translation, 0.1);
	EXPECT_LT(result.sigma.rotation, 0.05);
}

TEST(FrameRegistration, WeighsThePriorAgainstTheCentres)
{
	// As good as no rotation: t = d n w / (n w + 1 / sigma_t^2) with n = 5, w = 1 / 0.1^2, and a
	// variance of 1 / (n w + 1 / sigma_t^2).
	FrameRegistrationOptions options;
	options.sigmaCentre = 0.1;
	const auto result =
		registered(aDesk(), aDesk().seenAfter(CPose3D(0.3, 0, 0, 0, 0, 0)), {0.1, 0}, options);
	EXPECT_NEAR(result.T_seen_expected.x(), 0.3 * 500 / 600, 1e-3);
	EXPECT_NEAR(result.sigma.translation, std::sqrt(1.0 / 600), 1e-4);
}

TEST(FrameRegistration, AThingThatMovedIsNoMotionOfTheCamera)
{
	const auto result = registered(aDesk(), aDesk().move(2, {0.3, 0, 0}));
	EXPECT_EQ(result.T_seen_expected, CPose3D());
	EXPECT_EQ(result.pairs, 4);
}

TEST(FrameRegistration, AThingThatMovedIsLeftOutOfTheMotion)
{
	const CPose3D motion(0.2, 0.1, 0, 0, 0, 0);
	const auto result = registered(aDesk(), aDesk().seenAfter(motion).move(2, {0, -0.4, 0}));
	expectPose(result.T_seen_expected, motion, 0.05, 1.0);
	EXPECT_EQ(result.pairs, 4);
}

TEST(FrameRegistration, ThePatternTellsThingsThatLookAlikeApart)
{
	const CPose3D motion(0.25, 0, 0.1, 0, mrpt::DEG2RAD(6.0), 0);
	const auto result = registered(aDesk(true), aDesk(true).seenAfter(motion));
	expectPose(result.T_seen_expected, motion, 0.05, 1.5);
	EXPECT_EQ(result.pairs, 5);
}

TEST(FrameRegistration, ACentreThatMovedWithWhatIsVisibleOfALargeThingCountsLittle)
{
	// Of the large one 0.8 m are in view instead of 0.2: its centre says nothing against the others.
	const auto landmarks = aDesk().move(0, {}, 0.2);
	const auto result = registered(landmarks, aDesk().move(0, {-0.4, 0, 0}, 0.8));
	EXPECT_EQ(result.T_seen_expected, CPose3D());
	EXPECT_EQ(result.pairs, 5);
	EXPECT_EQ(registered(landmarks, aDesk().move(0, {-0.4, 0, 0}, 0.2)).pairs, 4);
}

TEST(FrameRegistration, ARowOfThingsThatLookAlikeIsAmbiguous)
{
	// Moved by half their distance, and the last is out of view: left or right explain four each.
	const Things row({{-1, 0, 3}, {-0.5, 0, 3}, {0, 0, 3}, {0.5, 0, 3}, {1, 0, 3}}, true);
	const Things seen({{-0.75, 0, 3}, {-0.25, 0, 3}, {0.25, 0, 3}, {0.75, 0, 3}}, true);
	const auto result = registered(row, seen);
	EXPECT_EQ(result.T_seen_expected, CPose3D());
	EXPECT_EQ(result.pairs, 0);
	EXPECT_EQ(result.sigma.translation, kNoisy.translation);
}

TEST(FrameRegistration, AMotionTooSmallToBeSureOfIsLeftAsUncertainty)
{
	// 5 pairs of 3 cm, as good as no rotation: a variance of 1 / (5 / 0.03^2 + 1 / 0.2^2) when in place.
	constexpr PoseSigma prior{0.2, 0};
	EXPECT_NEAR(registered(aDesk(), aDesk(), prior).sigma.translation, 0.01338, 2e-4);
	// Off by 4 cm they explain 5 (4 / 3)^2 = 8.9 < 22.5 more: 0.0398 m refused, a third of its square
	// along each axis.
	const auto result = registered(aDesk(), aDesk().seenAfter(CPose3D(0.04, 0, 0, 0, 0, 0)), prior);
	EXPECT_EQ(result.T_seen_expected, CPose3D());
	EXPECT_EQ(result.pairs, 5);
	EXPECT_NEAR(result.sigma.translation, std::hypot(0.01338, 0.0398 / std::sqrt(3.0)), 5e-4);
}

TEST(FrameRegistration, ACameraThatIsCertainStaysWhereItIs)
{
	const CPose3D motion(0.1, 0, 0, 0, 0, 0);
	const auto result = registered(aDesk(), aDesk().seenAfter(motion), {0.002, 0.001});
	EXPECT_LT(result.T_seen_expected.norm(), 0.01);
}

TEST(FrameRegistration, TooFewPairsSayNothing)
{
	const Things two({{-0.8, 0.2, 2.0}, {0.7, 0.1, 2.2}});
	const auto result = registered(two, two.seenAfter(CPose3D(0.2, 0, 0, 0, 0, 0)));
	EXPECT_EQ(result.T_seen_expected, CPose3D());
	EXPECT_EQ(result.pairs, 0);
	EXPECT_EQ(result.sigma.translation, kNoisy.translation);
	EXPECT_EQ(registerFrame({}, {}, kNoisy, {}).pairs, 0);
}

TEST(FrameRegistration, CanBeSwitchedOff)
{
	FrameRegistrationOptions options;
	options.enabled = false;
	const auto result =
		registered(aDesk(), aDesk().seenAfter(CPose3D(0.2, 0, 0, 0, 0, 0)), kNoisy, options);
	EXPECT_EQ(result.T_seen_expected, CPose3D());
	EXPECT_EQ(result.pairs, 0);
}

TEST(FrameRegistration, UncertaintiesOfOneStepAfterTheOtherAdd)
{
	const PoseSigma sum = PoseSigma{0.3, 0.06} + PoseSigma{0.4, 0.08};
	EXPECT_NEAR(sum.translation, 0.5, 1e-12);
	EXPECT_NEAR(sum.rotation, 0.1, 1e-12);
}

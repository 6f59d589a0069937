#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/association/ConfusionMatrix.h>
#include <semloop/config/Error.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <utility>
#include <vector>

using semloop::ConfusionMatrix;
using semloop::InputError;
using semloop::LabelScores;
using semloop::LabelSet;
using testing::HasSubstr;

namespace
{
const LabelSet kLabels({"chair", "couch", "table"});

class ConfusionMatrixFile : public testing::Test
{
protected:
	~ConfusionMatrixFile() override { std::remove(path_.c_str()); }

	/** What load() says of a file with this text. */
	std::string errorOf(const std::string& text)
	{
		std::ofstream(path_) << text;
		try
		{
			ConfusionMatrix::load(path_);
		}
		catch (const InputError& e)
		{
			EXPECT_THAT(e.what(), HasSubstr(path_));
			return e.what();
		}
		return "no error";
	}

	const std::string path_ = testing::TempDir() + "semloop_confusion_" +
							  testing::UnitTest::GetInstance()->current_test_info()->name() +
							  ".json";
};
}  // namespace

TEST(ConfusionMatrix, OfASmoothedIdentitySpreadsTheErrorsEvenly)
{
	const ConfusionMatrix confusion(kLabels, 0.8);
	EXPECT_FLOAT_EQ(confusion.probability(1, 1), 0.8f);
	EXPECT_FLOAT_EQ(confusion.probability(0, 1), 0.1f);
	EXPECT_FLOAT_EQ(confusion.probability(2, 1), 0.1f);
}

TEST(ConfusionMatrix, OfASingleLabelIsCertain)
{
	EXPECT_EQ(ConfusionMatrix(LabelSet({"chair"}), 0.8).probability(0, 0), 1);
}

TEST(ConfusionMatrix, RefusesProbabilitiesOutsideZeroToOne)
{
	EXPECT_THROW(ConfusionMatrix(kLabels, 1.1), std::invalid_argument);
	EXPECT_THROW(ConfusionMatrix(kLabels, std::nan("")), std::invalid_argument);
}

TEST(ConfusionMatrix, CountsPairsOnTopOfThePrior)
{
	// True chair: counts 1 + 3, 0.1 + 1, 0.1, in all 5.2.
	const auto confusion = ConfusionMatrix::learn(kLabels, {{0, 0}, {0, 0}, {0, 0}, {0, 1}}, 0.1);
	EXPECT_FLOAT_EQ(confusion.probability(0, 0), float(4 / 5.2));
	EXPECT_FLOAT_EQ(confusion.probability(1, 0), float(1.1 / 5.2));
	EXPECT_FLOAT_EQ(confusion.probability(2, 0), float(0.1 / 5.2));
	// True couch was never shown: the prior alone.
	EXPECT_FLOAT_EQ(confusion.probability(1, 1), float(1 / 1.2));
}

TEST(ConfusionMatrix, ObservationsOfEachTrueLabelSumToOneAfterLearning)
{
	const auto confusion = ConfusionMatrix::learn(kLabels, {{0, 1}, {2, 1}, {2, 2}, {1, 0}}, 0.5);
	for (uint32_t truth = 0; truth < 3; ++truth)
	{
		double sum = 0;
		for (uint32_t observed = 0; observed < 3; ++observed)
			sum += confusion.probability(observed, truth);
		EXPECT_NEAR(sum, 1, 1e-6);  // three floats
	}
}

TEST(ConfusionMatrix, RefusesToLearnFromUnknownLabelsOrWithoutAPrior)
{
	EXPECT_THROW(ConfusionMatrix::learn(kLabels, {{0, 3}}), InputError);
	EXPECT_THROW(ConfusionMatrix::learn(kLabels, {}, 0), std::invalid_argument);
	const Eigen::MatrixXd counts = Eigen::MatrixXd::Zero(3, 3);
	EXPECT_THROW(
		ConfusionMatrix::learnFromCounts(kLabels, counts.array() - 1), std::invalid_argument);
	EXPECT_THROW(
		ConfusionMatrix::learnFromCounts(kLabels, counts.leftCols(2)), std::invalid_argument);
}

TEST(ConfusionMatrix, AgreementIsTheExpectationOverBothDistributions)
{
	const auto confusion = ConfusionMatrix::learn(kLabels, {{0, 1}, {0, 1}, {1, 1}}, 1);
	const LabelScores observed{{1, 0.75f}, {0, 0.25f}}, truth{{0, 0.5f}, {1, 0.25f}};
	// Rows: chair (10, 3, 1) / 14, couch (1, 11, 1) / 13.
	const double expected =
		0.75 * 0.5 * 3 / 14 + 0.25 * 0.5 * 10 / 14 + 0.75 * 0.25 * 11 / 13 + 0.25 * 0.25 * 1 / 13;
	EXPECT_NEAR(confusion.agreement(observed, truth), expected, 1e-7);
}

TEST(ConfusionMatrix, AgreementOfCertainLabelsIsTheEntry)
{
	const auto confusion = ConfusionMatrix::learn(kLabels, {{0, 1}}, 0.1);
	EXPECT_EQ(confusion.agreement({{1, 1}}, {{0, 1}}), confusion.probability(1, 0));
	EXPECT_NE(confusion.agreement({{0, 1}}, {{1, 1}}), confusion.probability(1, 0));
}

TEST(ConfusionMatrix, NothingAgreesWithAnEmptyDistribution)
{
	const ConfusionMatrix confusion(kLabels, 0.9);
	EXPECT_EQ(confusion.agreement({}, {{0, 1}}), 0);
	EXPECT_EQ(confusion.agreement({{0, 1}}, {}), 0);
}

TEST(ConfusionMatrix, RefusesLabelsThatItDoesNotHave)
{
	const ConfusionMatrix confusion(kLabels, 0.9);
	EXPECT_THROW(confusion.agreement({{3, 1}}, {{0, 1}}), InputError);
	EXPECT_THROW(confusion.agreement({{0, 1}}, {{3, 1}}), InputError);
	EXPECT_THROW(ConfusionMatrix().probability(0, 0), InputError);
}

TEST_F(ConfusionMatrixFile, ComesBackExactly)
{
	const auto saved = ConfusionMatrix::learn(LabelSet::coco(), {{56, 57}, {57, 57}, {3, 2}}, 0.1);
	saved.save(path_);
	const auto loaded = ConfusionMatrix::load(path_);
	EXPECT_EQ(loaded.labels(), saved.labels());
	for (uint32_t truth = 0; truth < 80; ++truth)
		for (uint32_t observed = 0; observed < 80; ++observed)
			ASSERT_EQ(loaded.probability(observed, truth), saved.probability(observed, truth));
}

TEST_F(ConfusionMatrixFile, HasARowForEachTrueLabel)
{
	std::ofstream(path_) << R"({"format": "semloop.confusion/1", "labels": ["a", "b"],
		"p": [[0.9, 0.1], [0.3, 0.7]]})";
	const auto confusion = ConfusionMatrix::load(path_);
	EXPECT_FLOAT_EQ(confusion.probability(1, 0), 0.1f);
	EXPECT_FLOAT_EQ(confusion.probability(0, 1), 0.3f);
}

TEST_F(ConfusionMatrixFile, ErrorsNameTheEntry)
{
	const std::string head = R"({"format": "semloop.confusion/1", "labels": ["a", "b"], "p": )";
	EXPECT_THAT(errorOf("{"), HasSubstr("not JSON"));
	EXPECT_THAT(errorOf("[]"), HasSubstr("format"));
	EXPECT_THAT(errorOf(R"({"format": 1})"), HasSubstr("format"));
	EXPECT_THAT(errorOf(R"({"format": "semloop.confusion/1"})"), HasSubstr("labels"));
	EXPECT_THAT(
		errorOf(R"({"format": "semloop.confusion/1", "labels": ["a", 3]})"),
		HasSubstr("labels[1]"));
	EXPECT_THAT(
		errorOf(R"({"format": "semloop.confusion/1", "labels": ["a", "a"]})"), HasSubstr("labels"));
	EXPECT_THAT(errorOf(head + "[[1, 0]]}"), HasSubstr("p: not a list of 2 rows"));
	EXPECT_THAT(errorOf(head + "[[1, 0], [1]]}"), HasSubstr("p[1]"));
	EXPECT_THAT(errorOf(head + "[[1, 0], [0, 1.5]]}"), HasSubstr("p[1][1]"));
	EXPECT_THAT(errorOf(head + "[[1, \"x\"], [0, 1]]}"), HasSubstr("p[0][1]"));
	EXPECT_THAT(errorOf(head + "[[1, 0], [0.5, 0.4]]}"), HasSubstr("p[1]: sums to 0.9"));
}

TEST_F(ConfusionMatrixFile, ThatIsNotThereOrCannotBeWrittenIsNamed)
{
	EXPECT_THROW(ConfusionMatrix::load("/nowhere/confusion.json"), InputError);
	EXPECT_THROW(ConfusionMatrix(kLabels, 0.9).save("/nowhere/confusion.json"), InputError);
}

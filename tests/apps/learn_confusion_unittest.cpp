#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/association/ConfusionMatrix.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

using testing::HasSubstr;

namespace
{
namespace fs = std::filesystem;

/** Runs the built program in a folder of its own. */
class LearnConfusion : public testing::Test
{
protected:
	LearnConfusion() { fs::create_directories(folder_); }
	~LearnConfusion() override { fs::remove_all(folder_); }

	std::string write(const std::string& name, const std::string& text) const
	{
		std::ofstream(folder_ / name) << text;
		return (folder_ / name).string();
	}

	std::string read(const std::string& name) const
	{
		std::ostringstream text;
		text << std::ifstream(folder_ / name).rdbuf();
		return text.str();
	}

	/** The exit code; what was printed is in files out and err. */
	int run(const std::string& arguments) const
	{
		const std::string command =
			std::string("'" SEMLOOP_BINARY_DIR "/bin/semloop-learn-confusion' ") + arguments +
			" > '" + (folder_ / "out").string() + "' 2> '" + (folder_ / "err").string() + "'";
		const int status = std::system(command.c_str());
		return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
	}

	const fs::path folder_ = fs::path(testing::TempDir()) /
							 (std::string("semloop_learn_") +
							  testing::UnitTest::GetInstance()->current_test_info()->name());
	const std::string json_ = (folder_ / "confusion.json").string();
};
}  // namespace

TEST_F(LearnConfusion, CountsTheLinesOfAFile)
{
	const auto pairs =
		write("pairs.csv", "# true,observed,count\nchair,chair,7\n\n  chair , couch \r\ntv,tv,2\n");
	ASSERT_EQ(run(pairs + " " + json_), 0) << read("err");
	EXPECT_THAT(read("out"), HasSubstr("80 labels from 10 pairs, 90.0 % of them right"));
	const auto confusion = semloop::ConfusionMatrix::load(json_);
	const auto label = [&](const char* name) { return uint32_t(*confusion.labels().find(name)); };
	// Prior 1 right and 79 x 0.1 wrong, then 7 and 1: 16.9 in all.
	EXPECT_NEAR(confusion.probability(label("chair"), label("chair")), 8 / 16.9, 1e-6);
	EXPECT_NEAR(confusion.probability(label("couch"), label("chair")), 1.1 / 16.9, 1e-6);
	EXPECT_NEAR(confusion.probability(label("chair"), label("couch")), 0.1 / 8.9, 1e-6);
}

TEST_F(LearnConfusion, TakesOtherLabelsAndAnotherPrior)
{
	const auto pairs = write("pairs.csv", "cat,dog\n");
	const auto labels = write("labels.txt", "cat\ndog\n");
	ASSERT_EQ(run(pairs + " " + json_ + " --smoothing 1 --labels " + labels), 0) << read("err");
	const auto confusion = semloop::ConfusionMatrix::load(json_);
	EXPECT_NEAR(confusion.probability(1, 0), 2.0 / 12, 1e-6);
}

TEST_F(LearnConfusion, NamesFileAndLineOfWhatItCannotUse)
{
	const auto complaintAbout = [&](const std::string& text)
	{
		EXPECT_EQ(run(write("pairs.csv", text) + " " + json_), 1) << text;
		EXPECT_FALSE(fs::exists(json_));
		return read("err");
	};
	EXPECT_THAT(complaintAbout("chair,chair\nchair,sofa\n"), HasSubstr("pairs.csv:2: 'sofa'"));
	EXPECT_THAT(complaintAbout("#\nchair\n"), HasSubstr("pairs.csv:2: 1 columns"));
	EXPECT_THAT(complaintAbout("chair,tv,1,2\n"), HasSubstr("pairs.csv:1: 4 columns"));
	EXPECT_THAT(complaintAbout("chair,tv,\n"), HasSubstr("pairs.csv:1: count ''"));
	EXPECT_THAT(complaintAbout("chair,tv,-1\n"), HasSubstr("pairs.csv:1: count '-1'"));
	EXPECT_THAT(complaintAbout("chair,tv,1.5\n"), HasSubstr("pairs.csv:1: count '1.5'"));
	EXPECT_THAT(complaintAbout("# nothing\n"), HasSubstr("no pair"));
}

TEST_F(LearnConfusion, FailsOnFilesThatAreNotThere)
{
	EXPECT_EQ(run((folder_ / "missing.csv").string() + " " + json_), 1);
	EXPECT_THAT(read("err"), HasSubstr("missing.csv"));
	const auto pairs = write("pairs.csv", "chair,chair\n");
	EXPECT_EQ(run(pairs + " /nowhere/confusion.json"), 1);
	EXPECT_THAT(read("err"), HasSubstr("/nowhere/confusion.json"));
	EXPECT_EQ(run(pairs + " " + json_ + " --labels /nowhere/labels.txt"), 1);
}

TEST_F(LearnConfusion, ExplainsItselfAndRefusesWrongArguments)
{
	EXPECT_EQ(run("--help"), 0);
	EXPECT_THAT(read("out"), HasSubstr("--smoothing"));
	EXPECT_EQ(run(""), 2);
	EXPECT_EQ(run("a.csv b.json --smoothing 0"), 2);
	EXPECT_THAT(read("err"), HasSubstr("--smoothing"));
	EXPECT_EQ(run("a.csv b.json --unknown"), 2);
}

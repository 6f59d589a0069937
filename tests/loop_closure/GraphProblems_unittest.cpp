#include <gtest/gtest.h>
#include <semloop/loop_closure/GeometricVerification.h>
#include <semloop/loop_closure/SpectralMatcher.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "TemporaryFolder.h"

namespace
{
using namespace semloop;

/** The published matching problems, unpacked. */
class GraphProblems : public testing::Test
{
protected:
	void SetUp() override
	{
		const char* data = std::getenv("SEMLOOP_DATA");
		if (!data) GTEST_SKIP() << "SEMLOOP_DATA is not set";
		const std::string archive = std::string(data) + "/data/graph_matching/problems.tar.xz";
		if (!std::filesystem::exists(archive)) GTEST_SKIP() << "SEMLOOP_DATA has no " << archive;
		const std::string unpack = "tar -xf '" + archive + "' -C '" + folder.path().string() + "'";
		ASSERT_EQ(std::system(unpack.c_str()), 0) << unpack;
	}

	SemanticGraph load(const std::string& name) const
	{
		return SemanticGraph::load(folder.file(name));
	}

	TemporaryFolder folder;
};

TEST_F(GraphProblems, AllFilesLoad)
{
	int graphs = 0;
	for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
	{
		if (entry.path().extension() != ".json" || entry.path().filename() == "truth.json")
			continue;
		EXPECT_NO_THROW(SemanticGraph::load(entry.path().string())) << entry.path();
		++graphs;
	}
	EXPECT_GT(graphs, 480);
}

/** Queries 0 and 2 of each world are of the map, 1 and 3 of another building. */
TEST_F(GraphProblems, MildQueriesAreConfirmedAndForeignOnesRefuted)
{
	for (int world = 0; world < 10; ++world)
	{
		const auto target = load("mild/target_" + std::to_string(world) + ".json");
		for (int k = 0; k < 4; ++k)
		{
			const std::string name =
				"mild/query_" + std::to_string(world) + "_" + std::to_string(k) + ".json";
			const auto query = load(name);
			const auto matches = SpectralMatcher().match(query, target).matches;
			const auto result = verifyGeometry(query, target, matches);
			EXPECT_EQ(result.outcome == GeometricVerification::Outcome::Confirmed, k % 2 == 0)
				<< name << ": " << result.reason;
		}
	}
}
}  // namespace

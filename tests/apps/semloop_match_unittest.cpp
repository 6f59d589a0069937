#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/object_map/SemanticGraph.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "GraphExamples.h"
#include "Shell.h"
#include "TemporaryFolder.h"

namespace
{
using namespace semloop;
using nlohmann::json;
using testing::HasSubstr;

/** The program on graphs of its own. */
class SemloopMatch : public testing::Test
{
protected:
	/** Writes the desk, which is seen from another frame, and a room with it. */
	SemloopMatch()
	{
		desk_ = fixtures::randomRoom(8, 8, 3);
		auto room = desk_;
		for (auto& v : room.vertices) v.id += 20;
		room.vertices.push_back(fixtures::vertex(50, "sofa", 8, 3, 0.4));
		room.save(folder_.file("room.json"));
		fixtures::moved(desk_, mrpt::poses::CPose3D() - T_).save(folder_.file("desk.json"));
	}

	ShellResult run(const std::string& arguments) const
	{
		return shell(
			"timeout 60 '" SEMLOOP_BINARY_DIR "/bin/semloop-match' " + arguments, folder_.path());
	}
	json runJson(const std::string& arguments) const
	{
		const auto result = run("--json " + arguments);
		EXPECT_EQ(result.code, 0) << result.err;
		return json::parse(result.out, nullptr, false);
	}
	void expectError(
		const std::string& arguments, int code, const std::vector<std::string>& says) const
	{
		const auto result = run(arguments);
		EXPECT_EQ(result.code, code) << result.err;
		EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
		for (const auto& words : says) EXPECT_THAT(result.err, HasSubstr(words));
	}

	static std::string matrix(double x, double y, double yaw)
	{
		std::ostringstream out;
		out << std::cos(yaw) << " " << -std::sin(yaw) << " 0 " << x << " " << std::sin(yaw) << " "
			<< std::cos(yaw) << " 0 " << y << " 0 0 1 0.1 0 0 0 1";
		return "'" + out.str() + "'";
	}

	const TemporaryFolder folder_;
	const mrpt::poses::CPose3D T_ = mrpt::poses::CPose3D::FromXYZYawPitchRoll(1, 2, 0.1, 0.5, 0, 0);
	SemanticGraph desk_;
};
}  // namespace

TEST_F(SemloopMatch, PrintsOneObjectWithAllThatWasFound)
{
	const auto result = runJson("desk.json room.json");
	EXPECT_EQ(result["decision"], "accepted");
	EXPECT_THAT(result["reason"].get<std::string>(), HasSubstr("8 of 8 objects fit one place"));
	ASSERT_EQ(result["matches"].size(), 8u);
	for (const auto& match : result["matches"])
		EXPECT_EQ(match[1].get<int>(), match[0].get<int>() + 20);
	ASSERT_EQ(result["T_target_query"].size(), 16u);
	const double expected[16] = {std::cos(0.5),
								 -std::sin(0.5),
								 0,
								 1,
								 std::sin(0.5),
								 std::cos(0.5),
								 0,
								 2,
								 0,
								 0,
								 1,
								 0.1,
								 0,
								 0,
								 0,
								 1};
	for (int i = 0; i < 16; ++i) EXPECT_NEAR(result["T_target_query"][i], expected[i], 1e-4) << i;
	EXPECT_EQ(result["inliers"], 8);
	EXPECT_LT(result["runner_up"], 0.5);
	EXPECT_GT(result["probability"], 0.9);
	EXPECT_GT(result["milliseconds"], 0);
}

TEST_F(SemloopMatch, TellsAPersonTheSame)
{
	const auto result = run("desk.json room.json");
	EXPECT_EQ(result.code, 0) << result.err;
	EXPECT_THAT(result.out, testing::StartsWith("accepted: 8 of 8"));
	EXPECT_THAT(result.out, HasSubstr("matches (query - target): 0 - 20, 1 - 21,"));
	EXPECT_THAT(result.out, HasSubstr("T_target_query:\n     0.877583    -0.479426"));
}

TEST_F(SemloopMatch, EveryMatcherIsThereByName)
{
	for (const char* name :
		 {"pairwise", "spectral-verified", "clique", "random-walk", "histogram", "spectral"})
		EXPECT_EQ(
			runJson(std::string("desk.json room.json --matcher ") + name)["decision"], "accepted")
			<< name;
	expectError("desk.json room.json --matcher magic", 2, {"--matcher = magic", "spectral-verified"});
}

TEST_F(SemloopMatch, APriorSpeaksForAPlaceOrAgainstIt)
{
	EXPECT_EQ(
		runJson("desk.json room.json --prior " + matrix(1.2, 1.8, 0.45))["decision"], "accepted");
	const auto far = runJson(
		"desk.json room.json --prior " + matrix(9, 1.8, 0.45) + " --prior-sigma '0.1 0.1 0.05'");
	EXPECT_NE(far["decision"], "accepted");
	EXPECT_EQ(far["T_target_query"].size(), 16u) << "the best guess";
	EXPECT_EQ(
		runJson(
			"desk.json room.json --prior " + matrix(9, 1.8, 0.45) +
			" --prior-sigma '5 0.1 0.05'")["decision"],
		"accepted");
}

TEST_F(SemloopMatch, WithoutAnyPlaceThereIsNoPose)
{
	folder_.write(
		"strangers.json",
		R"({"format": "semloop.graph/1", "objects": [{"id": 1, "label": "boat", "position": [0, 0, 0]},
			{"id": 2, "label": "kite", "position": [1, 0, 0]}], "edges": []})");
	const auto result = runJson("strangers.json room.json");
	EXPECT_EQ(result["decision"], "rejected");
	EXPECT_TRUE(result["T_target_query"].is_null());
	EXPECT_TRUE(result["matches"].empty());
}

TEST_F(SemloopMatch, GraphsWithoutEnoughObjectsAreRejectedWithTheReason)
{
	folder_.write("none.json", R"({"format": "semloop.graph/1", "objects": [], "edges": []})");
	folder_.write(
		"one.json",
		R"({"format": "semloop.graph/1", "objects": [{"id": 1, "label": "boat", "position": [0, 0, 0]}],
			"edges": []})");
	for (const char* graphs : {"none.json room.json", "desk.json none.json", "one.json room.json"})
	{
		const auto result = runJson(graphs);
		EXPECT_EQ(result["decision"], "rejected");
		EXPECT_THAT(result["reason"].get<std::string>(), HasSubstr("a place needs two"));
	}
}

TEST_F(SemloopMatch, DamagedGraphsAreNamedWithThePlace)
{
	const auto graph = [&](const std::string& objects, const std::string& edges)
	{
		folder_.write(
			"bad.json", R"({"format": "semloop.graph/1", "objects": [)" + objects +
							R"(], "edges": [)" + edges + "]}");
		return "bad.json room.json";
	};
	const std::string cup = R"({"id": 1, "label": "cup", "position": [0, 0, 0]})",
					  plate = R"({"id": 2, "label": "plate", "position": [1, 0, 0]})";
	expectError(graph(cup + "," + cup, ""), 1, {"bad.json", "objects[1]"});
	expectError(graph(cup + "," + plate, "[1, 7]"), 1, {"bad.json", "7"});
	expectError(
		graph(R"({"id": 1, "label": "cup", "position": [NaN, 0, 0]})", ""), 1, {"bad.json"});
	expectError(
		graph(R"({"id": 1, "label": "cup", "position": [1e999, 0, 0]})", ""), 1, {"bad.json"});
	const auto looking = [](const std::string& embedding) {
		return R"({"id": 1, "label": "cup", "position": [0, 0, 0], "embedding": )" + embedding +
			   "}";
	};
	expectError(
		graph(
			looking("[1, 0]") +
				R"(,{"id": 2, "label": "cup", "position": [1, 0, 0], "embedding": [1, 0, 0]})",
			""),
		1, {"bad.json", "3 numbers"});
	folder_.write(
		"seen.json", R"({"format": "semloop.graph/1", "objects": [)" + looking("[0, 1, 0]") + "," +
						 plate + R"(], "edges": []})");
	graph(looking("[1, 0]") + "," + plate, "");
	expectError("seen.json bad.json", 1, {"embeddings of 3 numbers against 2"});
	expectError("nowhere.json room.json", 1, {"nowhere.json"});
	expectError("desk.json nowhere.objmap", 1, {"nowhere.objmap"});
}

TEST_F(SemloopMatch, WrongUsageExitsWith2)
{
	expectError("desk.json", 2, {"two graphs"});
	expectError("desk.json room.json desk.json", 2, {"two graphs"});
	expectError("desk.json room.json --prior '1 2 3'", 2, {"--prior", "16 numbers"});
	expectError(
		"desk.json room.json --prior " + std::string("'2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1'"), 2,
		{"--prior", "rigid"});
	expectError(
		"desk.json room.json --prior " + matrix(0, 0, 0) + " --prior-sigma '1 0 1'", 2,
		{"--prior-sigma"});
	expectError("desk.json room.json --prior-sigma '1 1 1'", 2, {"--prior-sigma is only for"});
	expectError("desk.json room.json --use-prior", 2, {"--use-prior is only for --batch"});
	expectError("--batch . desk.json room.json", 2, {"--batch"});
	expectError("--no-such-option", 2, {"--help"});
}

TEST_F(SemloopMatch, RunsAFolderOfProblemsAgainstTheirTruth)
{
	// A right place, one that is called wrong by 1 m, and a foreign desk.
	fixtures::randomRoom(8, 8, 99).save(folder_.file("foreign.json"));
	const auto problem = [&](const std::string& query, const std::string& pose, bool negative)
	{
		return R"({"query": ")" + query + R"(", "target": "room.json", "negative": )" +
			   (negative ? "true" : "false") + R"(, "T_target_query": )" + pose +
			   R"(, "matches": )" + (negative ? "[]" : "[[0, 20], [1, 21], [2, 99]]") +
			   R"(, "prior": )" + pose + R"(, "prior_sigma": {"xy": 0.5, "z": 0.1, "yaw": 0.1}})";
	};
	const auto pose = [](double x)
	{
		json numbers = {std::cos(0.5),
						-std::sin(0.5),
						0,
						x,
						std::sin(0.5),
						std::cos(0.5),
						0,
						2,
						0,
						0,
						1,
						0.1,
						0,
						0,
						0,
						1};
		return numbers.dump();
	};
	folder_.write(
		"truth.json", "[" + problem("desk.json", pose(1), false) + "," +
						  problem("desk.json", pose(2), false) + "," +
						  problem("foreign.json", "null", true) + "]");
	// A negative has no pose, and here no prior.
	auto truth = json::parse(readBytes(folder_.file("truth.json")));
	truth[2].erase("prior");
	folder_.write("problems/truth.json", truth.dump());
	for (const char* file : {"desk.json", "room.json", "foreign.json"})
		std::filesystem::copy(folder_.file(file), folder_.file("problems/") + file);

	const auto result = runJson("--batch problems")["problems"];
	EXPECT_EQ(result["positives"], 2);
	EXPECT_EQ(result["negatives"], 1);
	EXPECT_EQ(result["pose_success"], 50.0);
	EXPECT_EQ(result["precision"], 50.0);
	EXPECT_EQ(result["recall"], 50.0);
	EXPECT_EQ(result["false_loops"], 0.0);
	// Each of the two accepted has 8 matches, two of which are in the truth, of three there.
	EXPECT_EQ(result["vertex_precision"], 25.0);
	EXPECT_NEAR(result["vertex_recall"], 200.0 / 3, 1e-9);
	EXPECT_GT(result["median_ms"], 0);
	const auto table = run("--batch . --use-prior");
	EXPECT_EQ(table.code, 1) << "truth.json of the folder itself has a prior without a pose";
	EXPECT_THAT(table.err, HasSubstr("truth.json: problem"));
	EXPECT_THAT(run("--batch problems --use-prior").out, HasSubstr("problems"));
	expectError("--batch nowhere", 1, {"nowhere", "truth.json"});
	folder_.write("cut/truth.json", "[{\"query\": \"a.json\"");
	expectError("--batch cut", 1, {"cut/truth.json"});
}

#include <filesystem>

#include "SemloopEvalFixture.h"

namespace semloop
{
namespace
{
using ::testing::HasSubstr;

std::string graphOf(const std::string& objects)
{
	return R"({"format": "semloop.graph/1", "objects": [)" + objects + R"(], "edges": []})";
}

/** A triangle of 1 m at this height. */
std::string triangleAt(double z)
{
	std::ostringstream out;
	out << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
		<< "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
		<< "0 0 " << z << "\n1 0 " << z << "\n0 1 " << z << "\n3 0 1 2\n";
	return out.str();
}

/** The result's world is the true one moved by (5, 0, -1). */
class SemloopEvalObjects : public SemloopEval
{
protected:
	void SetUp() override
	{
		write("OUT/trajectory.tum", square(5, -1));
		write(
			"OUT/objects.json",
			graphOf(
				R"({"id": 3, "label": "cup", "position": [5.1, 0, -1], "extent": [1, 1, 1]},
				   {"id": 4, "label": "cup", "position": [5.2, 0, -1]})"));
		write("room_groundtruth.tum", square(0, 0));
		truth_ = write(
			"room_objects.json",
			graphOf(
				R"({"id": 1, "label": "cup", "position": [0, 0, 0], "extent": [1, 1, 1]},
				   {"id": 2, "label": "tv", "position": [9, 0, 0]})"));
		arguments_ = "objects " + path("OUT") + " --truth " + truth_;
	}

	std::string truth_, arguments_;
};

TEST_F(SemloopEvalObjects, ComparesInTheTrueWorld)
{
	const auto result = json(arguments_);
	EXPECT_EQ(result["objects"], 2);
	EXPECT_EQ(result["true_objects"], 2);
	EXPECT_EQ(result["precision"], 0.5);
	EXPECT_EQ(result["recall"], 0.5);
	EXPECT_EQ(result["label_accuracy"], 1.0);
	EXPECT_EQ(result["duplicates"], nlohmann::json({4}));
	EXPECT_NEAR(result["centre_error_m"]["mean"], 0.1, 1e-6);
	EXPECT_NEAR(result["mean_box_iou"], 0.9 / 1.1, 1e-6);
}

TEST_F(SemloopEvalObjects, WithoutAlignmentTheWorldsAreOne)
{
	std::filesystem::remove(path("room_groundtruth.tum"));
	const auto result = json(arguments_ + " --align none");
	EXPECT_EQ(result["precision"], 0.0);
	EXPECT_TRUE(result["label_accuracy"].is_null());
}

TEST_F(SemloopEvalObjects, MeasuresTheSurfacesWhereBothHaveMeshes)
{
	write("OUT/objects/3_cup.ply", triangleAt(-0.98));
	// The true world's triangle is larger than the estimate's, and 5 m away in x.
	write(
		"room_objects/1_cup.ply",
		"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
		"property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
		"-9 -9 0\n9 -9 0\n-9 30 0\n3 0 1 2\n");
	const auto result = json(arguments_);
	EXPECT_EQ(result["surface"]["objects"], 1);
	EXPECT_EQ(result["surface"]["distance_m"]["count"], 3);
	EXPECT_NEAR(result["surface"]["distance_m"]["mean"], 0.02, 1e-6);
	EXPECT_NEAR(result["surface"]["distance_m"]["percentile_95"], 0.02, 1e-6);
	EXPECT_FALSE(result["surface"].contains("note"));
	EXPECT_THAT(run(arguments_).output, HasSubstr("surface                   0.0200"));
}

TEST_F(SemloopEvalObjects, NotesMissingMeshesAndGoesOn)
{
	const auto result = json(arguments_);
	EXPECT_EQ(result["surface"]["objects"], 0);
	EXPECT_TRUE(result["surface"]["distance_m"].is_null());
	EXPECT_THAT(std::string(result["surface"]["note"]), HasSubstr("1 of 1 matched objects"));
	EXPECT_THAT(run(arguments_).output, HasSubstr("room_objects"));
}

TEST_F(SemloopEvalObjects, RefusesADamagedMeshAndAPointCloudAsTruth)
{
	write("OUT/objects/3_cup.ply", triangleAt(-1));
	write("room_objects/1_cup.ply", "ply\n");
	expectError(arguments_, 1, {"1_cup.ply"});
	write("room_objects/1_cup.ply", "ply\nformat ascii 1.0\nend_header\n");
	expectError(arguments_, 1, {"1_cup.ply", "no triangle"});
}

TEST_F(SemloopEvalObjects, NamesWhatIsMissingWithARemedy)
{
	expectError("objects " + path("none") + " --truth " + truth_, 1, {"none", "semloop-slam"});
	expectError("objects " + path("OUT") + " --truth " + path("no.json"), 1, {"no.json"});
	std::filesystem::remove(path("room_groundtruth.tum"));
	expectError(arguments_, 1, {"room_groundtruth.tum", "--groundtruth", "--align none"});
	std::filesystem::remove(path("OUT/objects.json"));
	expectError(arguments_, 1, {"objects.json", "run it again"});
}

TEST_F(SemloopEvalObjects, TakesAnotherTrajectoryAndRefusesOneOfAnotherTime)
{
	const auto other = write("other.tum", square(1, 0));
	EXPECT_EQ(json(arguments_ + " --groundtruth " + other)["precision"], 0.0);
	write("other.tum", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n3 0 0 0 0 0 0 1\n");
	expectError(
		arguments_ + " --groundtruth " + other, 1, {"OUT/trajectory.tum", "other.tum", "clock"});
}

TEST_F(SemloopEvalObjects, ExitsWith2OnWrongUsage)
{
	expectError("objects " + path("OUT"), 2, {"required"});
	expectError(arguments_ + " --align sim3", 2, {"align"});
	expectError(arguments_ + " --max-distance -1", 2, {"--max-distance"});
	expectError(arguments_ + " --min-iou 2", 2, {"--min-iou"});
	const auto unnamed = write("truth.json", graphOf(""));
	expectError("objects " + path("OUT") + " --truth " + unnamed, 2, {"--groundtruth"});
}
}  // namespace
}  // namespace semloop

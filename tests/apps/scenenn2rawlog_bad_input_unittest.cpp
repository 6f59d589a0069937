#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <tuple>

#include "SceneNn2RawlogFixture.h"

namespace semloop::test
{
namespace
{
namespace fs = std::filesystem;
using ::testing::HasSubstr;

class SceneNn2RawlogBadInput : public SceneNn2Rawlog
{
protected:
	/** One line that says all this, and no result under its name. */
	void expectError(
		const ShellResult& result, int code, const std::vector<std::string>& says) const
	{
		EXPECT_EQ(result.code, code) << result.err;
		EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
		for (const auto& words : says) EXPECT_THAT(result.err, HasSubstr(words));
		for (const char* file :
			 {"room.rawlog", "room_truth_instances.rawlog", "room_groundtruth.tum",
			  "room_objects.json"})
			EXPECT_FALSE(fs::exists(written(file))) << file;
	}
};

TEST_F(SceneNn2RawlogBadInput, WrongUsageExitsWith2)
{
	const std::string xml = "--annotation " + given("076.xml"), ply = "--mesh " + given("076.ply"),
					  log = "--trajectory " + given("trajectory.log");
	expectError(run(log + " " + xml), 2, {"--annotation needs", "--mesh"});
	expectError(run(log + " " + ply), 2, {"--mesh is only for", "--annotation"});
	expectError(run(xml + " " + ply), 2, {"--trajectory"});
	expectError(run(log + " --exclude sofa"), 2, {"--annotation"});
	expectError(runAnnotated("--exclude sofa"), 2, {"sofa", "076.xml"});
	for (const char* tolerance : {"0", "nan", "2"})
		expectError(runAnnotated(std::string("--tolerance ") + tolerance), 2, {"tolerance"});
	for (const char* time : {"yesterday", "nan", "0"})
		expectError(run(std::string("--start-time ") + time), 2, {"start-time"});
	expectError(run("--no-such-option"), 2, {"--help"});
	expectError(runWith(given("076.oni")), 2, {});
	expectError(
		runWith("--camera nowhere.ini " + given("076.oni") + " room.rawlog"), 2, {"nowhere.ini"});
	EXPECT_EQ(runWith("--help").code, 0);
}

TEST_F(SceneNn2RawlogBadInput, ACameraWithDistortionIsRefused)
{
	auto camera = synthetic::smallCamera();
	camera.setDistortionPlumbBob(0.1, 0, 0, 0, 0);
	mrpt::config::CConfigFileMemory config;
	camera.saveToConfigFile("CAMERA_PARAMS", config);
	const auto file = folder_.write("distorted.ini", config.getContent());
	expectError(
		runWith("--camera " + quoted(file) + " " + given("076.oni") + " room.rawlog"), 2,
		{"distorted.ini", "distortion"});
}

TEST_F(SceneNn2RawlogBadInput, SceneNnsCameraNeedsItsImageSize)
{
	expectError(
		runWith(given("076.oni") + " room.rawlog"), 1,
		{"076.oni", "160x120", "640x480", "--camera"});
}

TEST_F(SceneNn2RawlogBadInput, AWrongCameraDoesNotCostAnEarlierRawlog)
{
	folder_.write("room.rawlog", "earlier");
	folder_.write("room_Images/color_000000.png", "earlier");
	EXPECT_EQ(runWith(given("076.oni") + " room.rawlog").code, 1);
	EXPECT_EQ(readBytes(written("room.rawlog")), "earlier");
	EXPECT_EQ(readBytes(written("room_Images/color_000000.png")), "earlier");
}

TEST_F(SceneNn2RawlogBadInput, MissingFilesAreNamed)
{
	const std::string nowhere = folder_.file("nowhere");
	expectError(runWith("nowhere.oni room.rawlog"), 1, {"nowhere.oni"});
	expectError(runAnnotated("", nowhere), 1, {nowhere});
	expectError(runAnnotated("", "", nowhere), 1, {nowhere});
	expectError(runAnnotated("", "", "", nowhere), 1, {nowhere});
	expectError(
		runWith("--camera " + given("camera.ini") + " " + given("076.oni") + " no/room.rawlog"), 1,
		{"no/room"});
}

TEST_F(SceneNn2RawlogBadInput, ARecordingWithoutDepthIsNamed)
{
	record("record-color", "color.oni", 2, synthetic::smallCamera());
	expectError(
		runWith("--camera " + given("camera.ini") + " " + given("color.oni") + " room.rawlog"), 1,
		{"color.oni", "depth"});
}

TEST_F(SceneNn2RawlogBadInput, ATrajectorysBadLineIsNamed)
{
	const std::string good = block(0, cameraAt(0)), last = "0 0 0 1\n";
	const std::vector<std::tuple<std::string, std::string, std::string>> cases{
		{good + "1 1 2\nnan 0 0 0\n0 1 0 0\n0 0 1 0\n" + last, "bad.log:7:", "'nan'"},
		{good + "1 1 2\n1 0 0\n", "bad.log:7:", "3 words"},
		{good + "1 1 2\n2 0 0 0\n0 2 0 0\n0 0 2 0\n" + last, "bad.log:10:", "rigid"},
		{good + "1 1 2\n1 0 0 0\n0 1 0 0\n0 0 -1 0\n" + last, "bad.log:10:", "rigid"},
		{good + "1 1 2\n1 0.1 0 0\n0 1 0 0\n0 0 1 0\n" + last, "bad.log:10:", "rigid"},
		{good + "1 1 2\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 2\n", "bad.log:10:", "last row"},
		{good + "1 1 2\n1 0 0 0\n", "bad.log:7:", "ends inside"},
		{good + "0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n" + last, "bad.log:6:", "frame 0"},
		{good + "1 2 3\n", "bad.log:6:", "i i i+1"},
		{good + "99999999999 99999999999 100000000000\n", "bad.log:6:", "frame 99999999999"},
		{"", "bad.log", "no pose"},
		{lostBlock(0), "bad.log", "no pose"}};
	for (const auto& [text, place, problem] : cases)
		expectError(
			run("--trajectory " + quoted(folder_.write("bad.log", text))), 1, {place, problem});
}

TEST_F(SceneNn2RawlogBadInput, ATrajectoryOfAnotherRecordingIsRefused)
{
	const auto longer = folder_.write("longer.log", trajectoryLog(kFrames + 6));
	expectError(
		run("--trajectory " + quoted(longer)), 1, {"longer.log", "frame 13", "only 8", "076.oni"});
	const auto shorter = folder_.write("shorter.log", trajectoryLog(kFrames / 2 - 1));
	expectError(
		run("--trajectory " + quoted(shorter)), 1, {"shorter.log", "3 of the 8", "076.oni"});
	// Players differ in what they pair at the end.
	const auto slightly = folder_.write("slightly.log", trajectoryLog(kFrames + 5));
	EXPECT_EQ(run("--trajectory " + quoted(slightly)).code, 0);
}

TEST_F(SceneNn2RawlogBadInput, AnAnnotationThatIsNoneIsNamedWithItsLine)
{
	const std::vector<std::tuple<std::string, std::string, std::string>> cases{
		{"<annotation>\n<label id=\"1\" text=\"a\"/>\n</wrong>", "bad.xml:3:", "mismatched tag"},
		{"<annotation>\n<label id=\"1\" text=\"a\"/>\n", "bad.xml:3:", "XML"},
		{"", "bad.xml:1:", "XML"},
		{"no XML", "bad.xml:1:", "XML"},
		{"<a>\n<label text=\"a\"/></a>", "bad.xml:2:", "without id"},
		{"<a>\n<label id=\"one\" text=\"a\"/></a>", "bad.xml:2:", "'one'"},
		{"<a>\n<label id=\"-1\" text=\"a\"/></a>", "bad.xml:2:", "'-1'"},
		{"<a>\n<label id=\"4294967296\" text=\"a\"/></a>", "bad.xml:2:", "'4294967296'"},
		{"<a><label id=\"1\" text=\"a\"/>\n<label id=\"1\" text=\"b\"/></a>",
		 "bad.xml:2:", "second time"},
		{"<a><label id=\"1\" text=\" \"/></a>", "bad.xml", "no <label>"}};
	for (const auto& [text, place, problem] : cases)
		expectError(
			runAnnotated("", "", folder_.write("bad.xml", text)), 1, {place, problem, "SceneNN"});
}

TEST_F(SceneNn2RawlogBadInput, AMeshThatCannotBeUsedIsNamed)
{
	const auto expect = [&](const std::string& ply, const std::string& problem) {
		expectError(
			runAnnotated("", "", "", folder_.write("bad.ply", ply)), 1, {"bad.ply", problem});
	};
	const std::string ascii = "ply\nformat ascii 1.0\n", xyz =
															 "property float x\nproperty float y\n"
															 "property float z\n";
	const Mesh mesh = sceneMesh();
	expect(mesh.ply(false), "no property 'label'");
	expect(mesh.ply().substr(0, 5000), "ends early");
	expect("solid\n", "not a PLY file");
	expect(
		ascii + "element vertex 1\n" + xyz + "property int label\nend_header\n0 0 0 -1\n", "label");
	expect(
		ascii + "element vertex 1\n" + xyz + "property float label\nend_header\n0 0 0 1.5\n",
		"label");
	expect(ascii + "element vertex 0\n" + xyz + "property int label\nend_header\n", "no vertices");
	expect(
		ascii + "element face 1\nproperty list uchar int vertex_indices\nend_header\n0\n",
		"no vertices");
	Mesh broken = mesh;
	broken.vertices[1000].p.x = std::nan("");
	expect(broken.ply(), "not finite");
}

TEST_F(SceneNn2RawlogBadInput, AnAnnotationOfAnotherMeshIsRefused)
{
	const auto other = folder_.write(
		"other.xml", "<a><label id=\"1\" text=\"x\"/><label id=\"2\" text=\"y\"/></a>");
	expectError(
		runAnnotated("", "", other), 1, {"other.xml", "none of its 2", "076.ply", "one sequence"});
}

TEST_F(SceneNn2RawlogBadInput, AMeshThatDoesNotFitTheSequenceIsRefusedWithTheShare)
{
	Mesh moved = sceneMesh();
	for (auto& vertex : moved.vertices) vertex.p += mrpt::math::TPoint3D(0.3, 0.3, 0);
	const auto file = folder_.write("moved.ply", moved.ply());
	const auto result = runAnnotated("", "", "", file);
	expectError(result, 1, {"076.xml", "does not fit", "076.oni", "within 0.05 m", "50.0 %"});
	// Only where sides of the moved boxes meet others.
	double share = -1;
	const auto number = result.err.find("only ");
	ASSERT_NE(number, std::string::npos);
	std::istringstream(result.err.substr(number + 5)) >> share;
	EXPECT_GE(share, 0.0);
	EXPECT_LT(share, 30.0);
	EXPECT_EQ(runAnnotated("--tolerance 0.4", "", "", file).code, 0);
}

}  // namespace
}  // namespace semloop::test

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFile.h>
#include <semloop/evaluation/ObjectEvaluation.h>
#include <semloop/object_map/CObjectMap.h>
#include <semloop/object_map/ObjectFiles.h>
#include <semloop/object_map/SemanticGraph.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <regex>
#include <sstream>

#include "../mrpt_programs/MrptPrograms.h"
#include "RobotWalk.h"

/** Debian's programs for robots, unmodified, in the simulated flat with a map of objects. */
namespace semloop
{
namespace
{
using mrpt::poses::CPose2D;
using mrpt::poses::CPose3D;

class RobotPrograms : public testing::Test
{
protected:
	void SetUp() override
	{
		if (!std::filesystem::exists(kDemo + "demo.txt")) GTEST_SKIP() << "there is no simulation";
	}

	/** A shipped ini file, to be changed. */
	mrpt::config::CConfigFile ini(const std::string& name) const
	{
		const std::string copy = folder_.file(name);
		std::filesystem::copy_file(SEMLOOP_SOURCE_DIR "/config_ini/mrpt/" + name, copy);
		return mrpt::config::CConfigFile(copy);
	}

	ShellResult run(const std::string& command) const
	{
		return shell(
			"LD_PRELOAD='" SEMLOOP_BINARY_DIR "/lib/libsemloop-object_map.so' timeout 300 " +
				command,
			folder_.path());
	}

	/** Of a log, with x, y and phi in these columns. */
	std::vector<CPose2D> pathIn(
		const std::string& log, const std::array<std::size_t, 3>& columns) const
	{
		std::vector<CPose2D> path;
		std::istringstream lines(readBytes(folder_.file("log/" + log)));
		for (std::string line; std::getline(lines, line);)
		{
			if (line[0] == '%') continue;
			std::istringstream text(line);
			const std::vector<double> values{std::istream_iterator<double>(text), {}};
			path.emplace_back(values.at(columns[0]), values.at(columns[1]), values.at(columns[2]));
		}
		return path;
	}

	/** Of the places, when both paths begin in one [m]. */
	static double greatestError(const std::vector<CPose2D>& path, const std::vector<CPose2D>& truth)
	{
		double greatest = 0;
		for (std::size_t i = 0; i < std::min(path.size(), truth.size()); ++i)
			greatest =
				std::max(greatest, (path[i] - path.front()).distanceTo(truth[i] - truth.front()));
		return greatest;
	}

	/** The programs drift, as odometry with few objects does: what counts is that the map follows them. */
	void expectMostObjectsInPlace(
		const std::string& graph, const RobotWalk& walk, const CPose2D& first) const
	{
		const CPose3D T_flat_slam =
			walk.T_flat_world() + CPose3D(walk.truth().front()) + (-CPose3D(first));
		const auto objects = evaluateObjects(
			SemanticGraph::load(folder_.file("log/" + graph)),
			SemanticGraph::load(kDemo + "apartment_objects.json"), T_flat_slam);
		EXPECT_GE(objects.centreError.count, 30u);
		EXPECT_GT(objects.precision.value(), 0.45);
		EXPECT_GT(objects.labelAccuracy.value(), 0.8);
		EXPECT_LT(objects.centreError.median, 0.45);
	}

	TemporaryFolder folder_;
};

class Localization : public RobotPrograms, public testing::WithParamInterface<int>
{
protected:
	/** Our files, and particles all over the map. */
	void writeIni() const
	{
		auto config = ini("pf-localization.ini");
		const std::string section = "LocalizationExperiment";
		config.write(section, "map_file", kDemo + "result/map.simplemap");
		config.write(section, "rawlog_file", folder_.file("robot.rawlog"));
		config.write(section, "logOutput_dir", folder_.file("log"));
		mrpt::math::TPoint3D low(1e9, 1e9, 0), high(-1e9, -1e9, 0);
		const auto map = loadObjectMap(kDemo + "result/map.objmap");
		for (const auto& [id, object] : map->objects())
		{
			const auto centre = object.centre();
			low.x = std::min(low.x, centre.x), high.x = std::max(high.x, centre.x);
			low.y = std::min(low.y, centre.y), high.y = std::max(high.y, centre.y);
		}
		config.write(section, "init_PDF_min_x", low.x);
		config.write(section, "init_PDF_max_x", high.x);
		config.write(section, "init_PDF_min_y", low.y);
		config.write(section, "init_PDF_max_y", high.y);
	}

	/** Mean of the particles after each step. */
	std::vector<CPose2D> localize() const
	{
		const auto result = run("pf-localization pf-localization.ini");
		EXPECT_EQ(result.code, 0) << result.err;
		std::vector<CPose2D> estimates;
		const std::regex line("PDF estimation: \\(([-0-9.]+),([-0-9.]+),([-0-9.]+)deg\\)");
		for (std::sregex_iterator match(result.out.begin(), result.out.end(), line), end;
			 match != end; ++match)
			estimates.emplace_back(
				std::stod((*match)[1]), std::stod((*match)[2]),
				std::stod((*match)[3]) * M_PI / 180);
		return estimates;
	}
};

TEST_P(Localization, FromAnywhereInTheMapByInstancesAlone)
{
	const std::string whyNot = whyNotRunnable("pf-localization");
	if (!whyNot.empty()) GTEST_SKIP() << whyNot;
	RobotWalk walk(folder_);
	walk.useWorldOfTheMap();
	walk.write(std::size_t(GetParam()), 40, false);
	writeIni();
	const auto estimates = localize();
	ASSERT_EQ(walk.truth().size(), 40u);
	ASSERT_EQ(estimates.size(), walk.truth().size());
	for (std::size_t i = 30; i < estimates.size(); ++i)
	{
		const auto& truth = walk.truth()[i];
		EXPECT_LT(estimates[i].distanceTo(truth), 0.3) << "step " << i;
		EXPECT_LT(std::abs(mrpt::math::wrapToPi(estimates[i].phi() - truth.phi())), 10 * M_PI / 180)
			<< "step " << i;
	}
}

TEST_F(RobotPrograms, IcpSlamMapsObjectsBesidePoints)
{
	const std::string whyNot = whyNotRunnable("icp-slam");
	if (!whyNot.empty()) GTEST_SKIP() << whyNot;
	RobotWalk walk(folder_);
	walk.write(0, 60, true);
	ini("icp-slam.ini").write("MappingApplication", "logOutput_dir", folder_.file("log"));
	const auto result = run("icp-slam icp-slam.ini robot.rawlog");
	ASSERT_EQ(result.code, 0) << result.err;
	// step x y phi
	const auto path = pathIn("log_estimated_path.txt", {1, 2, 3});
	ASSERT_EQ(path.size(), walk.truth().size());
	EXPECT_LT(greatestError(path, walk.truth()), 0.6);
	expectMostObjectsInPlace("_finalmaps_.txt_semloop__CObjectMap_00.json", walk, path.front());
}

TEST_F(RobotPrograms, RbpfSlamMapsObjects)
{
	const std::string whyNot = whyNotRunnable("rbpf-slam");
	if (!whyNot.empty()) GTEST_SKIP() << whyNot;
	RobotWalk walk(folder_);
	walk.write(0, 60, false);
	{
		auto config = ini("rbpf-slam.ini");
		config.write("MappingApplication", "logOutput_dir", folder_.file("log"));
		config.write("MappingApplication", "rawlog_file", folder_.file("robot.rawlog"));
	}
	const auto result = run("rbpf-slam rbpf-slam.ini");
	ASSERT_EQ(result.code, 0) << result.err;
	// step x y z yaw pitch roll time
	const auto path = pathIn("log_estimated_path.txt", {1, 2, 4});
	ASSERT_EQ(path.size(), walk.truth().size());
	EXPECT_LT(greatestError(path, walk.truth()), 0.8);
	expectMostObjectsInPlace("finalMap_semloop__CObjectMap_00.json", walk, path.front());
}

INSTANTIATE_TEST_SUITE_P(Start, Localization, testing::Values(0, 75));

}  // namespace
}  // namespace semloop

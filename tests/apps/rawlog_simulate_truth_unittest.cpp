// That what rawlog-simulate writes as true is what the camera sees, and that the sensors' sections count.
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semloop/evaluation/PlyFile.h>
#include <semloop/object_map/SemanticGraph.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/RgbdFrame.h>
#include <semloop/observations/Trajectory.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "RawlogSimulateFixture.h"

using namespace semloop;
using testing::HasSubstr;

namespace
{
const std::string kAllInView = "--seed 4";  // where the camera sees all three objects for long

/** The box of an object of X_objects.json, its middle the origin of its own frame. */
struct OrientedBox
{
	explicit OrientedBox(const GraphVertex& object)
		: T_world_box(
			  object.orientation.value(), object.position.x, object.position.y, object.position.z),
		  extent(object.extent.value())
	{
	}

	Eigen::Vector3d inside(const mrpt::math::TPoint3D& p_world) const
	{
		const auto p = T_world_box.inverseComposePoint(p_world);
		return {p.x, p.y, p.z};
	}
	Eigen::Vector3d half() const { return 0.5 * Eigen::Vector3d(extent.x, extent.y, extent.z); }
	/** How far a point of the world is outside; 0 inside [m]. */
	double outside(const mrpt::math::TPoint3D& p_world) const
	{
		return (inside(p_world).cwiseAbs() - half()).cwiseMax(0.0).norm();
	}

	mrpt::poses::CPose3D T_world_box;
	mrpt::math::TVector3D extent;  // [m]
};

mrpt::math::TPoint3D pointAt(const RgbdFrame& frame, int x, int y)
{
	const double z = frame.depth.at<float>(y, x);
	const auto& camera = frame.camera;
	return {(x - camera.cx()) / camera.fx() * z, (y - camera.cy()) / camera.fy() * z, z};
}

class RawlogSimulateTruth : public RawlogSimulate
{
protected:
	/** Runs the scene with sections of sensors behind it. */
	int runWithSections(const std::string& sections, const std::string& rawlog = "x.rawlog")
	{
		folder_.write("den.ini", kScene + sections);
		return run(kAllInView, rawlog);
	}
	std::map<ObjectId, OrientedBox> boxes() const
	{
		std::map<ObjectId, OrientedBox> all;
		for (const auto& vertex : SemanticGraph::load(folder_.file("x_objects.json")).vertices)
			all.emplace(vertex.id, OrientedBox(vertex));
		return all;
	}
	std::vector<std::shared_ptr<CObservationInstances>> instances(const std::string& kind) const
	{
		return readAll<CObservationInstances>(folder_.file("x_" + kind + ".rawlog"));
	}
	/** Mean of each colour image. */
	std::vector<double> brightnessOf(const std::string& rawlog) const
	{
		std::vector<double> means;
		for (const auto& scan : readAll<mrpt::obs::CObservation3DRangeScan>(folder_.file(rawlog)))
		{
			const auto mean = cv::mean(rgbdFrameFrom(*scan).color);
			means.push_back((mean[0] + mean[1] + mean[2]) / 3);
		}
		return means;
	}
};

/** Of the numbers in the matrices of two trajectories, metres and cosines. */
double largestDifference(const Trajectory& a, const Trajectory& b)
{
	const auto matrix = [](const StampedPose& pose) -> Eigen::Matrix4d
	{ return pose.pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen(); };
	double largest = 0;
	for (std::size_t i = 0; i < a.size(); ++i)
		largest = std::max(largest, (matrix(a[i]) - matrix(b.at(i))).cwiseAbs().maxCoeff());
	return largest;
}
}  // namespace

TEST_F(RawlogSimulateTruth, TheDepthOfEveryObjectLiesInItsBox)
{
	ASSERT_EQ(run(kAllInView + " --no-color --set depth_sensor.noise=false"), 0) << err_;
	const auto objects = boxes();
	const auto scans = readAll<mrpt::obs::CObservation3DRangeScan>(folder_.file("x.rawlog"));
	const auto truth = instances("truth_instances");
	const auto poses = readTumTrajectory(folder_.file("x_groundtruth.tum"));
	std::map<ObjectId, int> points;
	std::map<ObjectId, double> farthest;
	for (std::size_t i = 0; i < scans.size(); ++i)
	{
		const auto frame = rgbdFrameFrom(*scans[i]);
		for (const auto& instance : truth.at(i)->instances)
			for (const auto& run : instance.mask.runs())
				for (int x = run.begin; x < run.end; ++x)
				{
					if (frame.depth.at<float>(run.row, x) == 0) continue;
					const auto id = instance.trueObject.value();
					const auto p = poses.at(i).pose.composePoint(pointAt(frame, x, run.row));
					++points[id];
					farthest[id] = std::max(farthest[id], objects.at(id).outside(p));
				}
	}
	for (const auto& [id, box] : objects)
	{
		EXPECT_GT(points[id], 100) << id;
		// Depth is rounded to millimetres; half a pixel at 2 m would be 15.
		EXPECT_LT(farthest[id], 0.002) << id;
	}
}

TEST_F(RawlogSimulateTruth, TheBoxesBoundTheMeshesTightly)
{
	ASSERT_EQ(run(kAllInView + " --frames 1 --no-color"), 0) << err_;
	for (const auto& vertex : SemanticGraph::load(folder_.file("x_objects.json")).vertices)
	{
		const OrientedBox box(vertex);
		const auto name = "x_objects/" + std::to_string(vertex.id) + "_" + vertex.label + ".ply";
		Eigen::Vector3d least = Eigen::Vector3d::Constant(1e9), most = -least;
		for (const auto& v : readPly(folder_.file(name)).vertices)
		{
			const auto p = box.inside({v.x(), v.y(), v.z()});
			least = least.cwiseMin(p);
			most = most.cwiseMax(p);
		}
		EXPECT_LT((most - box.half()).cwiseAbs().maxCoeff(), 1e-3) << name;
		EXPECT_LT((least + box.half()).cwiseAbs().maxCoeff(), 1e-3) << name;
	}
}

TEST_F(RawlogSimulateTruth, TheDeskHasItsBackAtAWall)
{
	std::set<long> quarters;
	for (const int seed : {3, 4})
	{
		ASSERT_EQ(run("--frames 1 --no-color --seed " + std::to_string(seed)), 0) << err_;
		const OrientedBox desk = boxes().at(1);
		// A piece's back is +y. The room reaches from (0, 0) to (4, 3).
		const auto away = desk.T_world_box.rotateVector({0, 1, 0});
		const auto back = desk.T_world_box.composePoint({0, desk.extent.y / 2, 0});
		const double x = away.x > 0 ? 4 - back.x : back.x, y = away.y > 0 ? 3 - back.y : back.y;
		EXPECT_NEAR(std::abs(away.x) > 0.5 ? x : y, 0.02, 1e-3) << "seed " << seed;
		const double quarter = desk.T_world_box.yaw() / (M_PI / 2);
		EXPECT_NEAR(quarter, std::round(quarter), 1e-4) << "seed " << seed;
		quarters.insert(std::lround(quarter));
	}
	EXPECT_GE(quarters.size(), 2u) << "no test of the orientation otherwise";
}

TEST_F(RawlogSimulateTruth, TheAttributionNamesTheAuthorAndTheLicence)
{
	ASSERT_EQ(run("--frames 1 --no-color"), 0) << err_;
	EXPECT_THAT(
		readBytes(folder_.file("x_attribution.txt")),
		HasSubstr("Scopia#wooden_table_office: Table, by Scopia. "
				  "Creative Commons Attribution 3.0 Unported license"));
}

TEST_F(RawlogSimulateTruth, WithoutNoiseTheOdometryIsTheTruth)
{
	const auto error = [&]
	{
		return largestDifference(
			readTumTrajectory(folder_.file("x_odometry.tum")),
			readTumTrajectory(folder_.file("x_groundtruth.tum")));
	};
	ASSERT_EQ(run("--no-color"), 0) << err_;
	EXPECT_GT(error(), 1e-3);
	std::string options = "--no-color";
	for (const std::string key : {"translation", "rotation", "yaw_bias", "scale_bias", "tilt"})
		options += " --set odometry." + key + "=0";
	ASSERT_EQ(run(options), 0) << err_;
	EXPECT_LT(error(), 1e-8) << "the files have 9 digits";
}

TEST_F(RawlogSimulateTruth, ADetectorThatDoesNotErrReportsTheTruth)
{
	ASSERT_EQ(
		runWithSections("[detector]\nminimum_area = 0\nmiss_rate = 0\nmiss_area = 0\n"
						"miss_hidden = 100\nboundary_noise = 0\nsplit_rate = 0\nmerge_rate = 0\n"
						"false_rate = 0\nconfusion_rate = 0\n"),
		0)
		<< err_;
	const auto truth = instances("truth_instances"), seen = instances("instances");
	std::size_t compared = 0;
	ASSERT_EQ(seen.size(), truth.size());
	for (std::size_t i = 0; i < truth.size(); ++i)
	{
		EXPECT_EQ(seen[i]->instances.size(), truth[i]->instances.size());
		for (const auto& object : truth[i]->instances)
		{
			const auto& all = seen[i]->instances;
			EXPECT_EQ(
				std::count_if(
					all.begin(), all.end(),
					[&](const Instance& one)
					{ return one.mask == object.mask && one.label() == object.label(); }),
				1)
				<< "frame " << i << ", object " << object.trueObject.value();
			++compared;
		}
	}
	EXPECT_GT(compared, truth.size());
}

TEST_F(RawlogSimulateTruth, ADetectorThatMissesEverythingReportsNothing)
{
	ASSERT_EQ(runWithSections("[detector]\nmiss_rate = 1\nfalse_rate = 0\n"), 0) << err_;
	std::size_t there = 0;
	for (const auto& frame : instances("truth_instances")) there += frame->instances.size();
	EXPECT_GT(there, 0u);
	for (const auto& frame : instances("instances")) EXPECT_TRUE(frame->instances.empty());
}

TEST_F(RawlogSimulateTruth, TheExposureSwingsWithItsPeriod)
{
	ASSERT_EQ(runWithSections("[color_sensor]\nexposure_drift = 0\n", "steady.rawlog"), 0) << err_;
	ASSERT_EQ(runWithSections("[color_sensor]\nexposure_drift = 0.5\nexposure_period = 1.6\n"), 0)
		<< err_;
	const auto steady = brightnessOf("steady.rawlog"), swinging = brightnessOf("x.rawlog");
	ASSERT_EQ(steady.size(), 11u);
	ASSERT_EQ(swinging.size(), 11u);
	// At 5 Hz a quarter of the period is two frames.
	for (const std::size_t same : {0, 4, 8}) EXPECT_NEAR(swinging[same], steady[same], 0.1) << same;
	// In the image 1.5 times the light is 1.5^(1/2.4) = 1.18, half of it 0.75 times the value.
	for (const std::size_t brighter : {2, 10})
		EXPECT_GT(swinging[brighter], 1.08 * steady[brighter]) << brighter;
	EXPECT_LT(swinging[6], 0.85 * steady[6]);
}

#include <benchmark/benchmark.h>
#include <mrpt/config/CConfigFile.h>
#include <mrpt/poses/Lie/SO.h>
#include <semloop/loop_closure/ObjectAligner.h>
#include <semloop/simulation/DepthSensor.h>
#include <semloop/simulation/SceneBuilder.h>
#include <semloop/simulation/SceneRenderer.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <random>

#include "SyntheticScene.h"

// Five neighbouring pieces of furniture of config_ini/scenes/apartment.ini without their room, mapped twice from
// six views of a noisy depth camera each, the second time from 60 to 100 degrees further round and under a drift;
// then aligned from a semantic pose that is wrong by 0.2 m and 10 degrees.
namespace
{
using namespace semloop;
using mrpt::poses::CPose3D;

constexpr std::size_t kObjects = 5, kViews = 6;
constexpr std::size_t kLeastPixels = 200;
constexpr double kHalfArc = 12 * M_PI / 180, kEyeHeight = 1.5;
constexpr double kWrongBy = 0.2, kWrongYaw = 10 * M_PI / 180;        // of the start
constexpr double kRightWithin = 0.1, kRightAngle = 10 * M_PI / 180;  // of the result
const CPose3D kDrift = CPose3D::FromXYZYawPitchRoll(0.6, -0.4, 0.1, 0.3, 0, 0);

struct Problem
{
	CObjectMap map;
	std::vector<std::pair<ObjectId, ObjectId>> matches;  //!< query first
	mrpt::math::TPoint3D centre;  //!< of the query's objects, where it believes to be
	CPose3D T_start;
};

Eigen::Vector3d centreOf(const SceneObject& object)
{
	Eigen::AlignedBox3d box;
	for (const auto& p : object.mesh->vertices)
	{
		const auto q = object.T_world_object.composePoint(
			mrpt::math::TPoint3D(double(p.x()), double(p.y()), double(p.z())));
		box.extend(Eigen::Vector3d(q.x, q.y, q.z));
	}
	return box.center();
}

mrpt::math::TPoint3D pointOf(const Eigen::Vector3d& p)
{
	return {p.x(), p.y(), p.z()};
}

/** The object and its nearest; empty when they are spread over more than a few metres. */
std::optional<Scene> clusterOf(const Scene& all, std::size_t object)
{
	std::vector<std::pair<double, std::size_t>> byDistance;
	for (std::size_t i = 0; i < all.objects.size(); ++i)
		byDistance.emplace_back(
			(centreOf(all.objects[i]) - centreOf(all.objects[object])).norm(), i);
	std::sort(byDistance.begin(), byDistance.end());
	if (byDistance.size() < kObjects || byDistance[kObjects - 1].first > 2) return {};
	Scene scene;
	scene.labels = all.labels;
	for (std::size_t i = 0; i < kObjects; ++i)
	{
		scene.objects.push_back(all.objects[byDistance[i].second]);
		scene.objects.back().id = uint32_t(i + 1);
	}
	return scene;
}

/** Into the map, by cameras that believe to be at wrong * truth; ids by object, 0 for what was not seen. */
std::vector<ObjectId> mapFrom(
	const Scene& scene, const mrpt::img::TCamera& camera, double azimuth, const CPose3D& wrong,
	uint64_t seed, CObjectMap& map)
{
	const SceneRenderer renderer(scene);
	Eigen::Vector3d middle = Eigen::Vector3d::Zero();
	for (const auto& object : scene.objects) middle += centreOf(object) / double(kObjects);
	double radius = 0;
	for (const auto& object : scene.objects)
		radius = std::max(radius, (centreOf(object) - middle).norm());

	std::vector<ObjectId> ids(kObjects, 0);
	for (std::size_t i = 0; i < kViews; ++i)
	{
		const double angle = azimuth + kHalfArc * (2 * double(i) / (kViews - 1) - 1);
		const Eigen::Vector3d eye(
			middle.x() + (radius + 1.5) * std::cos(angle),
			middle.y() + (radius + 1.5) * std::sin(angle), kEyeHeight);
		const auto pose = synthetic::lookAt(pointOf(eye), pointOf(middle));
		const auto view = renderer.render(camera, pose, false);
		RgbdFrame frame;
		frame.camera = camera;
		frame.color = cv::Mat::zeros(view.depth.size(), CV_8UC3);
		senseDepth(view, {}, seed * kViews + i).convertTo(frame.depth, CV_32F, 0.001);
		for (std::size_t k = 0; k < kObjects; ++k)
		{
			const cv::Mat pixels = view.object == int(k + 1);

			Instance instance;
			instance.mask = InstanceMask::encode(pixels);
			if (instance.mask.area() < kLeastPixels) continue;
			instance.box = instance.mask.boundingBox();
			instance.labelScores = {{scene.objects[k].label, 1.0F}};
			instance.confidence = 1;
			if (ids[k] == 0)
				ids[k] = map.addObject(frame, instance, wrong + pose).value_or(0);
			else
				map.fuse(ids[k], frame, instance, wrong + pose);
		}
	}
	return ids;
}

std::optional<Problem> problemOf(
	const Scene& scene, const mrpt::img::TCamera& camera, uint64_t seed)
{
	std::mt19937_64 random(seed);
	std::uniform_real_distribution<double> unit(0, 1);
	std::normal_distribution<double> normal;
	Problem problem;
	problem.map.setLabels(scene.labels);
	const double azimuth = 2 * M_PI * unit(random);
	const double apart = (60 + 40 * unit(random)) * M_PI / 180;
	const auto target = mapFrom(scene, camera, azimuth, CPose3D(), 2 * seed, problem.map);
	const auto query = mapFrom(scene, camera, azimuth + apart, kDrift, 2 * seed + 1, problem.map);
	for (std::size_t k = 0; k < kObjects; ++k)
	{
		if (query[k] == 0 || target[k] == 0) return {};
		problem.matches.emplace_back(query[k], target[k]);
		problem.centre += problem.map.object(query[k]).centre() * (1.0 / kObjects);
	}
	const auto there = (-kDrift).composePoint(problem.centre);
	const Eigen::Vector3d off =
		kWrongBy * Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
	const double turn = unit(random) < 0.5 ? kWrongYaw : -kWrongYaw;
	problem.T_start = CPose3D::FromXYZYawPitchRoll(
						  there.x + off.x(), there.y + off.y(), there.z + off.z(), turn, 0, 0) +
					  CPose3D::FromTranslation(-there.x, -there.y, -there.z) + (-kDrift);
	return problem;
}

const std::vector<Problem>& problems()
{
	static const auto all = []
	{
		const mrpt::config::CConfigFile config(SEMLOOP_SOURCE_DIR
											   "/config_ini/scenes/apartment.ini");
		const auto description = SceneDescription::load(
			config, {"depth_sensor", "color_sensor", "detector", "odometry"});
		const auto camera = cameraOf(description.camera);
		std::vector<Problem> result;
		uint64_t number = 0;
		for (uint64_t seed = 1; seed <= 4; ++seed)
		{
			const auto built = buildScene(description, FurnitureCatalog::open(), seed);
			for (std::size_t i = 0; i < built.scene.objects.size(); ++i, ++number)
				if (const auto scene = clusterOf(built.scene, i))
					if (auto problem = problemOf(*scene, camera, number))
						result.push_back(std::move(*problem));
		}
		return result;
	}();
	return all;
}

bool isRight(const Problem& problem, const CPose3D& T)
{
	const auto there = (-kDrift).composePoint(problem.centre);
	return (T.composePoint(problem.centre) - there).norm() < kRightWithin &&
		   mrpt::poses::Lie::SO<3>::log((T + kDrift).getRotationMatrix()).norm() < kRightAngle;
}

/** d^T covariance^-1 d of the error d of the joint pose. */
double normalizedError(const Problem& problem, const ObjectAlignment& result)
{
	const CPose3D M = CPose3D::FromTranslation(problem.centre);
	const CPose3D error = (-kDrift + M) - (result.T_target_query + M);
	Eigen::Matrix<double, 6, 1> d;
	const auto rotation = mrpt::poses::Lie::SO<3>::log(error.getRotationMatrix());
	for (int i = 0; i < 3; ++i)
	{
		d[i] = error[std::size_t(i)];
		d[3 + i] = rotation[i];
	}
	return d.dot(result.covariance.inverse() * d);
}

/** Counters in percent: right among all; accepted; right among the accepted. */
void fiveObjectsFromTwoSides(benchmark::State& state, const std::string& method)
{
	if (!std::filesystem::exists(FurnitureCatalog::kDefaultFolder))
	{
		state.SkipWithError("sweethome3d-furniture is not installed");
		return;
	}
	ObjectAligner aligner;
	aligner.options.method = method;
	std::vector<double> errors;
	std::size_t right = 0, accepted = 0, rightAccepted = 0;
	const auto& all = problems();
	// One iteration solves all of them; its time is their mean.
	for (auto _ : state)
	{
		std::chrono::duration<double> time{0};
		for (const Problem& problem : all)
		{
			const auto begin = std::chrono::steady_clock::now();
			const auto result = aligner.align(problem.map, problem.matches, problem.T_start);
			time += std::chrono::steady_clock::now() - begin;
			const bool good = isRight(problem, result.T_target_query);
			right += good;
			accepted += result.accepted;
			rightAccepted += good && result.accepted;
			if (good) errors.push_back(normalizedError(problem, result));
		}
		state.SetIterationTime(time.count() / double(all.size()));
	}
	const double done = double(all.size());
	state.counters["right"] = 100.0 * double(right) / done;
	state.counters["accepted"] = 100.0 * double(accepted) / done;
	state.counters["right_of_accepted"] =
		100.0 * double(rightAccepted) / double(std::max<std::size_t>(1, accepted));
	std::sort(errors.begin(), errors.end());
	// Of chi squared with six degrees of freedom it is 5.3.
	state.counters["median_nees"] = errors.empty() ? 0 : errors[errors.size() / 2];
	state.counters["problems"] = double(all.size());
}
void onceOverAll(benchmark::internal::Benchmark* benchmark)
{
	benchmark->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(1);
}
BENCHMARK_CAPTURE(fiveObjectsFromTwoSides, semantic_pose, "semantic_pose")->Apply(onceOverAll);
BENCHMARK_CAPTURE(fiveObjectsFromTwoSides, per_object_fpfh, "per_object_fpfh")->Apply(onceOverAll);
BENCHMARK_CAPTURE(fiveObjectsFromTwoSides, fpfh_ransac, "fpfh_ransac")->Apply(onceOverAll);
}  // namespace

BENCHMARK_MAIN();

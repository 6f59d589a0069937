#include <benchmark/benchmark.h>
#include <semloop/pose_graph/CeresPoseGraph.h>
#include <semloop/pose_graph/PoseResidual.h>

#include <cmath>
#include <random>

namespace semloop
{
namespace
{
constexpr int kCameras = 600;
constexpr int kObjects = 40;
constexpr int kSightings = 25;  //!< frames in which an object was seen
constexpr int kLoops = 10;

RigidTransform noise(std::mt19937& random, double translation, double rotation)
{
	std::normal_distribution<double> normal;
	Vector6 xi;
	for (int i = 0; i < 6; ++i) xi[i] = normal(random) * (i < 3 ? translation : rotation);
	return exponential(xi);
}

Matrix6 information(double translation, double rotation)
{
	Matrix6 m = Matrix6::Zero();
	m.diagonal().head<3>().setConstant(1 / (translation * translation));
	m.diagonal().tail<3>().setConstant(1 / (rotation * rotation));
	return m;
}

/** Two rounds of a circle of 3 m: odometry that drifts, objects along the way seen once in each
 *  half, and loop edges from the second round to the objects of the first. */
CeresPoseGraph twoRounds()
{
	std::mt19937 random(1);
	const auto truth = [](int camera)
	{
		const double angle = 4 * M_PI * camera / kCameras;
		return mrpt::poses::CPose3D(
			3 * std::cos(angle), 3 * std::sin(angle), 1.5, angle + M_PI / 2, 0, -M_PI / 2);
	};
	CeresPoseGraph graph;
	mrpt::poses::CPose3D T = truth(0);
	graph.setNode(NodeId::camera(0), T);
	for (int i = 1; i < kCameras; ++i)
	{
		const auto Z = (-truth(i - 1) + truth(i)) + noise(random, 0.004, 0.002).toPose();
		T = T + Z;
		graph.setNode(NodeId::camera(i), T);
		graph.addEdge(
			{PoseEdge::Kind::Odometry, NodeId::camera(i - 1), NodeId::camera(i), Z,
			 information(0.004, 0.002)});
	}
	const auto see = [&](int object, int camera, PoseEdge::Kind kind)
	{
		const int home = object * kCameras / (2 * kObjects);
		const auto T_world_object = truth(home) + mrpt::poses::CPose3D(0.2, 0, 1.5, 0, 0, 0);
		const auto Z = (-T_world_object + truth(camera)) + noise(random, 0.02, 0.05).toPose();
		if (!graph.has(NodeId::object(object)))
			graph.setNode(NodeId::object(object), graph.pose(NodeId::camera(camera)) + (-Z));
		graph.addEdge(
			{kind, NodeId::object(object), NodeId::camera(camera), Z, information(0.02, 0.05)});
	};
	for (int object = 0; object < kObjects; ++object)
		for (int i = 0; i < kSightings; ++i)
			see(object, object * kCameras / (2 * kObjects) + i, PoseEdge::Kind::Observation);
	for (int loop = 0; loop < kLoops; ++loop)
	{
		const int object = loop * kObjects / kLoops;
		see(object, kCameras / 2 + object * kCameras / (2 * kObjects), PoseEdge::Kind::Loop);
	}
	return graph;
}

void OptimizeTwoRounds(benchmark::State& state)
{
	const CeresPoseGraph start = twoRounds();
	OptimizationReport report;
	for (auto _ : state)
	{
		CeresPoseGraph graph = start;
		report = graph.optimize();
	}
	state.counters["iterations"] = report.iterations;
	state.counters["initial_cost"] = report.initialCost;
	state.counters["final_cost"] = report.finalCost;
}
BENCHMARK(OptimizeTwoRounds)->Unit(benchmark::kMillisecond);

void ResidualWithJacobians(benchmark::State& state)
{
	std::mt19937 random(2);
	const RigidTransform Z = noise(random, 1, 0.5), a = noise(random, 1, 0.5),
						 b = a * Z * noise(random, 0.1, 0.1);
	Matrix6 J_a, J_b;
	for (auto _ : state)
	{
		benchmark::DoNotOptimize(poseResidual(Z, a, b, &J_a, &J_b));
		benchmark::DoNotOptimize(J_a);
	}
}
BENCHMARK(ResidualWithJacobians);
}  // namespace
}  // namespace semloop

BENCHMARK_MAIN();

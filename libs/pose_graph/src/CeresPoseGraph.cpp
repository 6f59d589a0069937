#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <mrpt/core/initializer.h>
#include <semloop/pose_graph/CeresPoseGraph.h>

#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "CeresTerms.h"
#include "Components.h"

IMPLEMENTS_MRPT_OBJECT(CeresPoseGraph, PoseGraph, semloop)

namespace semloop
{
namespace
{
MRPT_INITIALIZER(registerCeresPoseGraph)
{
	mrpt::rtti::registerClass(CLASS_ID(semloop::CeresPoseGraph));
}

std::unique_ptr<ceres::LossFunction> makeLoss(const CeresPoseGraphOptions& options)
{
	const double scale = options.loopLossScale;
	if (options.loopLoss == "huber") return std::make_unique<ceres::HuberLoss>(scale);
	if (options.loopLoss == "cauchy") return std::make_unique<ceres::CauchyLoss>(scale);
	if (options.loopLoss == "tukey") return std::make_unique<ceres::TukeyLoss>(scale);
	return nullptr;
}

/** The manifold and the loss are ours, not the problem's. */
ceres::Problem::Options borrowing()
{
	ceres::Problem::Options options;
	options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
	options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
	return options;
}

ceres::Solver::Options solverOptions(const CeresPoseGraphOptions& options)
{
	ceres::Solver::Options solver;
	solver.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
	solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
	solver.max_num_iterations = options.maxIterations;
	solver.function_tolerance = options.functionTolerance;
	solver.gradient_tolerance = options.gradientTolerance;
	solver.parameter_tolerance = options.parameterTolerance;
	solver.num_threads = 1;
	solver.logging_type = ceres::SILENT;
	return solver;
}

bool isFinite(const ceres::Solver::Summary& summary, const std::map<NodeId, State>& states)
{
	if (!summary.IsSolutionUsable() || !std::isfinite(summary.final_cost)) return false;
	for (const auto& [id, state] : states)
		for (const double value : state)
			if (!std::isfinite(value)) return false;
	return true;
}
/** The first edge whose cost is beyond the range of numbers, or null. Ceres would print about it. */
const PoseEdge* overflowingEdge(
	const std::vector<PoseEdge>& edges, const std::map<NodeId, State>& states)
{
	for (const PoseEdge& edge : edges)
	{
		const Vector6 e = poseResidual(
			RigidTransform::fromPose(edge.Z_a_b), transformOf(states.at(edge.a).data()),
			transformOf(states.at(edge.b).data()));
		if (!std::isfinite(e.dot(edge.information * e))) return &edge;
	}
	return nullptr;
}
}  // namespace

void CeresPoseGraphOptions::describe(OptionFields& fields)
{
	fields.integer(
		"max_iterations", maxIterations, 1, 10000, "steps of Levenberg-Marquardt at most");
	fields.choice(
		"loop_loss", loopLoss, {"none", "huber", "cauchy", "tukey"},
		"robust loss on edges that come from loop closures");
	fields.number(
		"loop_loss_scale", loopLossScale, 1e-3, 1e6,
		"length of a whitened loop residual from which on the loss flattens it [standard "
		"deviations]");
	fields.number(
		"function_tolerance", functionTolerance, 0, 1,
		"stops when the cost falls by less than this share");
	fields.number(
		"gradient_tolerance", gradientTolerance, 0, 1, "stops when no gradient entry is larger");
	fields.number(
		"parameter_tolerance", parameterTolerance, 0, 1,
		"stops when the step is smaller than this share");
}

void CeresPoseGraph::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	options.loadFromConfigFile(config, section);
}

OptimizationReport CeresPoseGraph::optimize()
{
	OptimizationReport report;
	if (edges_.empty())
	{
		report.converged = true;
		report.message = "nothing to optimise: the graph has no edges";
		return report;
	}

	std::map<NodeId, State> states;
	for (const auto& [id, pose] : nodes_) store(RigidTransform::fromPose(pose), states[id].data());
	if (const PoseEdge* edge = overflowingEdge(edges_, states))
	{
		report.message = "the poses stay as they were: the residual of the edge from " +
						 toString(edge->a) + " to " + toString(edge->b) + " is not finite";
		return report;
	}
	const std::set<NodeId> held = nodesToHold(nodes_, edges_, fixedCamera_);
	PoseManifold manifold;
	const auto loss = makeLoss(options);

	ceres::Problem problem(borrowing());
	for (auto& [id, state] : states)
	{
		problem.AddParameterBlock(state.data(), 7, &manifold);
		if (held.count(id)) problem.SetParameterBlockConstant(state.data());
	}
	for (const PoseEdge& edge : edges_)
		problem.AddResidualBlock(
			new RelativePoseCost(edge), edge.kind == PoseEdge::Kind::Loop ? loss.get() : nullptr,
			states.at(edge.a).data(), states.at(edge.b).data());

	ceres::Solver::Summary summary;
	ceres::Solve(solverOptions(options), &problem, &summary);
	report.iterations = summary.num_successful_steps + summary.num_unsuccessful_steps;
	report.milliseconds = 1e3 * summary.total_time_in_seconds;
	report.message = summary.message + describeParts(held, fixedCamera_);
	if (!isFinite(summary, states))
	{
		const bool known = std::isfinite(summary.initial_cost) && summary.initial_cost >= 0;
		report.initialCost = report.finalCost = known ? summary.initial_cost : 0.0;
		report.message = "the poses stay as they were: " + report.message;
		return report;
	}
	report.initialCost = summary.initial_cost;
	report.finalCost = summary.final_cost;
	report.converged = summary.termination_type == ceres::CONVERGENCE;
	for (auto& [id, pose] : nodes_)
		if (!held.count(id)) pose = transformOf(states.at(id).data()).toPose();
	return report;
}

}  // namespace semloop

#include <mrpt/core/format.h>
#include <semloop/loop_closure/ObjectAligner.h>

#include <cmath>

#include "SurfaceClouds.h"

namespace semloop
{
namespace
{
SurfacePair surfacesOf(const Object& query, const Object& target)
{
	const auto inWorld = [](const Object& object)
	{
		std::vector<SurfacePoint> surface;
		if (object.volume) surface = object.volume->surface();
		for (auto& point : surface)
		{
			const auto p = object.T_world_object.composePoint(mrpt::math::TPoint3D(point.position));
			const auto n = object.T_world_object.rotateVector(mrpt::math::TVector3D(point.normal));
			point.position = mrpt::math::TPoint3Df(p);
			point.normal = mrpt::math::TVector3Df(n);
		}
		return surface;
	};
	return {inWorld(query), inWorld(target), query.centre(), target.centre()};
}

/** Root mean square over the query's points of the distance between where two poses put them. */
double correctionOf(
	const AlignmentProblem& problem, const Eigen::Isometry3d& a, const Eigen::Isometry3d& b)
{
	double sum = 0;
	for (const auto& pair : problem.pairs)
		sum += (a * pair.query.points - b * pair.query.points).squaredNorm();
	return std::sqrt(sum / static_cast<double>(problem.all().queryPoints()));
}

/** Empty when nothing speaks against the result. */
std::string objection(
	const ObjectAlignment& result, double correction, const ObjectAlignerOptions& options)
{
	if (result.fitness < options.minFitness)
		return mrpt::format(
			"only %.0f %% of the surface points align, needed are %.0f %%", 100 * result.fitness,
			100 * options.minFitness);
	if (result.rmse > options.maxRmse)
		return mrpt::format(
			"surfaces align to %.3f m only, needed are %.3f m", result.rmse, options.maxRmse);
	if (correction > options.maxCorrection)
		return mrpt::format(
			"surfaces align %.2f m away from the objects' centres, allowed are %.2f m", correction,
			options.maxCorrection);
	return {};
}

/** Only the centres are known: they coincide, under the joint rotation. */
MatchAlignment alignCentres(
	const SurfacePair& pair, const mrpt::poses::CPose3D& T_joint,
	const ObjectAlignerOptions& options)
{
	MatchAlignment result;
	result.T_target_query = T_joint;
	const auto shift = pair.targetCentre - T_joint.composePoint(pair.queryCentre);
	for (int axis = 0; axis < 3; ++axis)
	{
		result.T_target_query.m_coords[axis] += shift[axis];
		result.information(axis, axis) = 1 / mrpt::square(options.centreSigma);
		result.information(3 + axis, 3 + axis) = 1 / mrpt::square(options.rotationSigma);
	}
	return result;
}

std::vector<MatchAlignment> alignPairByPair(
	const AlignmentProblem& problem, const std::vector<SurfacePair>& pairs,
	const Eigen::Isometry3d& joint, const ObjectAlignerOptions& options)
{
	const auto T_joint = problem.toWorld(joint);
	const RotationPrior prior{joint.linear(), Eigen::Vector3d::Constant(options.rotationSigma)};
	std::vector<MatchAlignment> result;
	for (const auto& pair : pairs) result.push_back(alignCentres(pair, T_joint, options));
	for (const auto& pair : problem.pairs)
	{
		MatchAlignment& alignment = result[pair.index];
		const CloudPairs alone{&pair, &pair + 1};
		const auto refined = refine(alone, joint, prior, options);
		const auto aligned =
			findCorrespondences(alone, refined.T, options.endDistance, options.maxNormalAngle);
		const auto fitness =
			static_cast<double>(aligned.items.size()) / static_cast<double>(alone.queryPoints());
		const double moved = (refined.T * pair.queryCentre - joint * pair.queryCentre).norm();
		if (fitness < options.minFitness || aligned.rmse() > options.maxRmse ||
			moved > options.startDistance)
			continue;
		alignment.T_target_query = problem.toWorld(refined.T);
		alignment.information = informationOf(pair, refined.T, options);
	}
	return result;
}
}  // namespace

void ObjectAlignerOptions::describe(OptionFields& fields)
{
	fields.choice(
		"method", method, {"semantic_pose", "fpfh_ransac"},
		"start of the refinement: matched centres, or the paper's FPFH + RANSAC");
	fields.number("query_voxel", queryVoxel, 0.001, 1, "thinning of the query's surfaces [m]");
	fields.number("target_voxel", targetVoxel, 0.001, 1, "thinning of the target's surfaces [m]");
	fields.integer("max_query_points", maxQueryPoints, 10, 1000000, "of all objects together");
	fields.number(
		"start_distance", startDistance, 0.001, 10, "search distance of the first iteration [m]");
	fields.number(
		"end_distance", endDistance, 0.001, 10,
		"search distance of the last iterations, and of fitness and rmse [m]");
	fields.degrees(
		"max_normal_angle_deg", maxNormalAngle, 1, 180, "between normals of corresponding points");
	fields.integer("max_iterations", maxIterations, 1, 1000, "of the refinement");
	fields.number(
		"centre_sigma", centreSigma, 0.001, 100,
		"how well matched centres agree when the views differ [m]");
	fields.number("surface_sigma", surfaceSigma, 0.0001, 1, "how well aligned surfaces agree [m]");
	fields.degrees(
		"tilt_sigma_deg", tiltSigma, 0.1, 180, "roll and pitch of the correction, gravity known");
	fields.degrees(
		"rotation_sigma_deg", rotationSigma, 0.1, 180,
		"how far one object's rotation is from that of all");
	fields.number("min_fitness", minFitness, 0, 1, "aligned share of the query's surface points");
	fields.number("max_rmse", maxRmse, 0.0001, 1, "of the aligned points [m]");
	fields.number(
		"max_correction", maxCorrection, 0, 100,
		"distance from the pose of the centres, RMS over the query's points [m]");
	fields.number("feature_radius", featureRadius, 0.001, 10, "of an FPFH [m]");
	fields.number("ransac_distance", ransacDistance, 0.001, 10, "of an inlier [m]");
	fields.integer("ransac_iterations", ransacIterations, 1, 10000000, "number of samples");
	fields.integer("seed", seed, 0, 1000000000, "of the RANSAC");
}

void ObjectAligner::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	options.loadFromConfigFile(config, section);
}

ObjectAlignment ObjectAligner::align(
	const std::vector<SurfacePair>& pairs, const mrpt::poses::CPose3D& T_semantic) const
{
	ObjectAlignment result;
	result.T_target_query = T_semantic;
	const auto problem = makeProblem(pairs, options);
	if (problem.pairs.empty())
	{
		result.reason = "none of the " + std::to_string(pairs.size()) +
						" matched pairs has a surface on both sides";
		return result;
	}
	const Eigen::Isometry3d semantic = problem.toLocal(T_semantic);
	Eigen::Isometry3d start = semantic;
	if (options.method == "fpfh_ransac")
	{
		const auto found = alignFeatures(problem, options);
		if (!found)
		{
			result.reason = "FPFH + RANSAC found no pose; the views may be too different";
			return result;
		}
		start = *found;
	}
	constexpr double kAnyYaw = 10;
	const RotationPrior upright{semantic.linear(), {options.tiltSigma, options.tiltSigma, kAnyYaw}};
	const auto refined = refine(problem.all(), start, upright, options);
	const auto aligned =
		findCorrespondences(problem.all(), refined.T, options.endDistance, options.maxNormalAngle);

	result.T_target_query = problem.toWorld(refined.T);
	result.iterations = refined.iterations;
	result.fitness = static_cast<double>(aligned.items.size()) /
					 static_cast<double>(problem.all().queryPoints());
	result.rmse = aligned.rmse();
	result.reason = objection(result, correctionOf(problem, refined.T, semantic), options);
	result.accepted = result.reason.empty();
	if (!result.accepted) return result;
	result.reason = mrpt::format(
		"%.0f %% of the surface points align to %.3f m", 100 * result.fitness, result.rmse);
	result.pairs = alignPairByPair(problem, pairs, refined.T, options);
	return result;
}

ObjectAlignment ObjectAligner::align(
	const CObjectMap& map, const std::vector<std::pair<ObjectId, ObjectId>>& matches,
	const mrpt::poses::CPose3D& T_semantic) const
{
	std::vector<SurfacePair> pairs;
	for (const auto& [query, target] : matches)
		pairs.push_back(surfacesOf(map.object(query), map.object(target)));
	return align(pairs, T_semantic);
}

}  // namespace semloop

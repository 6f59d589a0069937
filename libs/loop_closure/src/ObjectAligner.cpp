#include <mrpt/core/format.h>
#include <semloop/loop_closure/ObjectAligner.h>

#include <algorithm>
#include <cmath>

#include "SurfaceClouds.h"

namespace semloop
{
namespace
{
constexpr const char *kSemantic = "semantic_pose", *kFeatures = "fpfh_ransac",
					 *kPerObject = "per_object_fpfh";
constexpr double kAnyAngle = 10;  // [rad]

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
	return {
		inWorld(query), inWorld(target), query.centre(), target.centre(),
		ObjectAligner::centreVariance(query, target)};
}

/** Root mean square over the query's points of the distance between where two poses put them. */
double correctionOf(const CloudPairs& pairs, const Eigen::Isometry3d& a, const Eigen::Isometry3d& b)
{
	double sum = 0;
	for (const auto& pair : pairs)
		sum += (a * pair.query.points - b * pair.query.points).squaredNorm();
	return std::sqrt(sum / static_cast<double>(pairs.queryPoints()));
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
		result.information(axis, axis) =
			1 / (mrpt::square(options.centreSigma) + pair.centreVariance);
		result.information(3 + axis, 3 + axis) = 1 / mrpt::square(options.rotationSigma);
	}
	return result;
}

/** One pair on its own, if its surfaces align; what they do not see of the rotation stays that of the joint pose. */
std::optional<MatchAlignment> alignAlone(
	const AlignmentProblem& problem, const CloudPair& pair, const Eigen::Isometry3d& joint,
	const ObjectAlignerOptions& options)
{
	constexpr double kKept = 1e-4;  // [rad]
	const CloudPairs alone{&pair, &pair + 1};
	const RotationSeen seen = rotationSeen(pair, joint, options);
	const double tilt = seen == RotationSeen::None ? kKept : options.rotationSigma;
	const double yaw = seen == RotationSeen::All ? options.rotationSigma : kKept;
	const auto refined = refine(alone, joint, {joint.linear(), {tilt, tilt, yaw}}, options);
	const auto aligned =
		findCorrespondences(alone, refined.T, options.endDistance, options.maxNormalAngle);
	const auto fitness =
		static_cast<double>(aligned.items.size()) / static_cast<double>(alone.queryPoints());
	const double moved = (refined.T * pair.queryCentre - joint * pair.queryCentre).norm();
	if (fitness < options.minFitness || aligned.rmse() > options.maxRmse ||
		moved > options.startDistance)
		return {};
	return MatchAlignment{
		problem.toWorld(refined.T), informationOf(pair, refined.T, seen, options)};
}

std::vector<MatchAlignment> alignPairByPair(
	const AlignmentProblem& problem, const std::vector<SurfacePair>& pairs,
	const Eigen::Isometry3d& joint, const ObjectAlignerOptions& options)
{
	const auto T_joint = problem.toWorld(joint);
	std::vector<MatchAlignment> result;
	for (const auto& pair : pairs) result.push_back(alignCentres(pair, T_joint, options));
	for (const auto& pair : problem.pairs)
		if (const auto alone = alignAlone(problem, pair, joint, options))
			result[pair.index] = *alone;
	return result;
}

/** How these pairs align at a pose. */
ObjectAlignment measured(
	const AlignmentProblem& problem, const CloudPairs& pairs, const Refinement& refined,
	const Eigen::Isometry3d& semantic, const ObjectAlignerOptions& options)
{
	ObjectAlignment result;
	const auto aligned =
		findCorrespondences(pairs, refined.T, options.endDistance, options.maxNormalAngle);
	result.T_target_query = problem.toWorld(refined.T);
	Eigen::Vector3d middle = Eigen::Vector3d::Zero();
	for (const auto& pair : problem.pairs) middle += pair.queryCentre / problem.all().count();
	result.covariance = jointCovariance(pairs, refined.T, middle, options);
	result.iterations = refined.iterations;
	result.fitness =
		static_cast<double>(aligned.items.size()) / static_cast<double>(pairs.queryPoints());
	result.rmse = aligned.rmse();
	result.reason = objection(result, correctionOf(pairs, refined.T, semantic), options);
	result.accepted = result.reason.empty();
	if (result.accepted)
		result.reason = mrpt::format(
			"%.0f %% of the surface points align to %.3f m", 100 * result.fitness, result.rmse);
	return result;
}

/** The joint refinement from a start. */
ObjectAlignment alignFrom(
	const Eigen::Isometry3d& start, const AlignmentProblem& problem,
	const std::vector<SurfacePair>& pairs, const Eigen::Isometry3d& semantic,
	const ObjectAlignerOptions& options)
{
	const RotationPrior upright{
		semantic.linear(), {options.tiltSigma, options.tiltSigma, kAnyAngle}};
	const auto refined = refine(problem.all(), start, upright, options);
	auto result = measured(problem, problem.all(), refined, semantic, options);
	if (result.accepted) result.pairs = alignPairByPair(problem, pairs, refined.T, options);
	return result;
}

ObjectAlignment alignByFeatures(
	const AlignmentProblem& problem, const std::vector<SurfacePair>& pairs,
	const Eigen::Isometry3d& semantic, const ObjectAlignerOptions& options)
{
	if (const auto start = alignFeatures(problem.all(), options))
		return alignFrom(*start, problem, pairs, semantic, options);
	ObjectAlignment result;
	result.T_target_query = problem.toWorld(semantic);
	result.reason = "FPFH + RANSAC found no pose; the views may be too different";
	return result;
}

/** The paper's: no object knows of the others. */
ObjectAlignment alignEach(
	const AlignmentProblem& problem, const std::vector<SurfacePair>& pairs,
	const Eigen::Isometry3d& semantic, const ObjectAlignerOptions& options)
{
	ObjectAlignerOptions plain = options;
	plain.centreSigma = 1e3;
	const RotationPrior any{semantic.linear(), Eigen::Vector3d::Constant(kAnyAngle)};
	ObjectAlignment best;
	best.T_target_query = problem.toWorld(semantic);
	best.reason = "FPFH + RANSAC found no pose of any object; the views may be too different";
	std::vector<std::optional<MatchAlignment>> found(pairs.size());
	for (const auto& pair : problem.pairs)
	{
		const CloudPairs alone{&pair, &pair + 1};
		const auto start = alignFeatures(alone, options);
		if (!start) continue;
		const auto refined = refine(alone, *start, any, plain);
		const auto result = measured(problem, alone, refined, semantic, options);
		if (result.accepted)
			found[pair.index] = MatchAlignment{
				result.T_target_query,
				informationOf(pair, refined.T, rotationSeen(pair, refined.T, options), options)};
		if (best.iterations == 0 || result.accepted > best.accepted ||
			(result.accepted == best.accepted && result.fitness > best.fitness))
			best = result;
	}
	if (!best.accepted) return best;
	for (std::size_t i = 0; i < pairs.size(); ++i)
		best.pairs.push_back(
			found[i].value_or(alignCentres(pairs[i], best.T_target_query, options)));
	return best;
}
}  // namespace

void ObjectAlignerOptions::describe(OptionFields& fields)
{
	fields.choice(
		"method", method, {kSemantic, kFeatures, kPerObject},
		"start of the refinement: matched centres, FPFH + RANSAC over all objects, or the paper's, "
		"each "
		"object alone by FPFH + RANSAC + ICP");
	fields.integer(
		"fallback_below", fallbackBelow, 0, 1000000,
		"fewer objects than this are aligned by FPFH + RANSAC, too, and the better result is "
		"taken");
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

double ObjectAligner::centreVariance(const Object& query, const Object& target)
{
	const auto variance = [](const Object& object)
	{
		const auto extent = object.extent();
		return mrpt::square(
			centreSigma(object.seenSides.completeness(), std::max(extent.x, extent.y)));
	};
	return variance(query) + variance(target);
}

void ObjectAligner::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	options.loadFromConfigFile(config, section);
}

ObjectAlignment ObjectAligner::align(
	const std::vector<SurfacePair>& pairs, const mrpt::poses::CPose3D& T_semantic) const
{
	const auto problem = makeProblem(pairs, options);
	if (problem.pairs.empty())
	{
		ObjectAlignment result;
		result.T_target_query = T_semantic;
		result.reason = "none of the " + std::to_string(pairs.size()) +
						" matched pairs has a surface on both sides";
		return result;
	}
	const Eigen::Isometry3d semantic = problem.toLocal(T_semantic);
	if (options.method == kPerObject) return alignEach(problem, pairs, semantic, options);
	if (options.method == kFeatures) return alignByFeatures(problem, pairs, semantic, options);

	auto result = alignFrom(semantic, problem, pairs, semantic, options);
	// Two centres tell little of the yaw, and one nothing.
	if (int(problem.pairs.size()) < options.fallbackBelow)
	{
		auto other = alignByFeatures(problem, pairs, semantic, options);
		if (other.accepted && (!result.accepted || other.fitness > result.fitness)) return other;
	}
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

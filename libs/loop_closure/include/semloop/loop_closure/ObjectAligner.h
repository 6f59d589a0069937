#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/math/TPoint3D.h>
#include <mrpt/poses/CPose3D.h>
#include <semloop/config/Options.h>
#include <semloop/loop_closure/LoopDetector.h>
#include <semloop/object_map/CObjectMap.h>

#include <string>
#include <utility>
#include <vector>

namespace semloop
{
struct ObjectAlignerOptions : Options
{
	std::string method = "semantic_pose";  //!< where the refinement starts
	int fallbackBelow = 3;                 //!< with fewer objects FPFH + RANSAC is tried, too
	double queryVoxel = 0.03;    //!< the query's surface is thinned to a point per voxel [m]
	double targetVoxel = 0.015;  //!< same, of the target's surface [m]
	int maxQueryPoints = 2000;   //!< of all objects together
	double startDistance = 0.3;  //!< of corresponding points, in the first iteration [m]
	double endDistance = 0.05;   //!< in the last iterations and for fitness and rmse [m]
	double maxNormalAngle = 1.0471975511965976;  //!< between corresponding normals [rad]
	int maxIterations = 40;
	double centreSigma = 0.3;      //!< how well matched centres agree when their views differ [m]
	double surfaceSigma = 0.01;    //!< how well aligned surfaces agree [m]
	double tiltSigma = 0.05;       //!< of the correction's roll and pitch: gravity is known [rad]
	double rotationSigma = 0.2;    //!< how far an object's rotation is from the joint one [rad]
	double minFitness = 0.3;       //!< aligned share of the query's points
	double maxRmse = 0.025;        //!< of the aligned points, along the target's normals [m]
	double maxCorrection = 0.7;    //!< from the semantic pose, RMS over the query's points [m]
	double featureRadius = 0.12;   //!< of an FPFH [m]
	double ransacDistance = 0.06;  //!< of an inlier [m]
	int ransacIterations = 20000;
	int seed = 1;  //!< of the RANSAC

protected:
	void describe(OptionFields& fields) override;
};

/** Surfaces of two matched objects, each in its own world [m]; a side may be empty. */
struct SurfacePair
{
	std::vector<SurfacePoint> query, target;
	mrpt::math::TPoint3D queryCentre, targetCentre;
	double centreVariance = 0;  //!< of their difference per axis, for what was not seen [m^2]
};

struct ObjectAlignment
{
	bool accepted = false;
	std::string reason;                   //!< one line with the numbers
	mrpt::poses::CPose3D T_target_query;  //!< the best found, also when not accepted
	double fitness = 0.0;  //!< query points with an aligned partner / query points, [0, 1]
	double rmse = 0.0;     //!< of those, along the target's normals [m]
	int iterations = 0;    //!< of the refinement
	/** Of a small motion d = (translation [m], rotation vector [rad]) of the query about the mean M of its
	 *  matched centres: T_target_query M exp(d), M with the axes of the query's world. */
	Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
	std::vector<MatchAlignment> pairs;  //!< each pair on its own, in the order given; see align()
};

/** Aligns the surfaces of all matched objects at once (Sec. III-C, Object Alignment).
 *
 *  method = semantic_pose starts where the matched centres say; fpfh_ransac where FPFH (R. Rusu et al., ICRA
 *  2009) matched within each pair of objects say, by RANSAC over three points: it needs views of the objects
 *  that are not too different. Of fewer than fallbackBelow objects, whose centres say little of the yaw, both
 *  are tried, and the one with the better fitness is taken. per_object_fpfh is the paper's: each object alone by
 *  FPFH + RANSAC + ICP, without the centres; the joint pose is that of the object whose surfaces align best.
 *
 *  The other two are refined by point-to-plane ICP (Y. Chen and G. Medioni, 1992) with correspondences within
 *  matched objects only, at a distance that shrinks from startDistance to endDistance and with
 *  Tukey's weights. The cost is
 *      mean of (n . (T q - t))^2 / surfaceSigma^2
 *      +  mean of |T c_q - c_t|^2 / (centreSigma^2 + centreVariance)
 *      +  tilt^2 / tiltSigma^2,
 *  whose second part, over the matched centres, decides what the surfaces leave open, such as sliding
 *  along flat ones, and whose third keeps up up. The yaw of a single round object stays open.
 *
 *  Not accepted: no surface on one side, no RANSAC model, too little overlap, too large a residual,
 *  or a result too far from the semantic pose. The same input gives the same output. */
class ObjectAligner
{
public:
	void configure(const mrpt::config::CConfigFileBase& config, const std::string& section);

	/** T_semantic is the T_target_query of the matched centres.
	 *
	 *  After an accepted result each pair is aligned by itself, for between two objects of the query
	 *  there is drift too; it starts at the joint pose. The cost is the joint one of that pair alone,
	 *  with |log R R_joint^T|^2 / rotationSigma^2 in place of the tilt for what its surface leaves open,
	 *  as a flat object does its yaw; a pair whose surfaces do not align has its centres only. The
	 *  information is the cost's Hessian. The yaw of a rotationally symmetric pair, and the rotation of a pair
	 *  that is barely seen, stay those of the joint pose: the surface has no say, only rotationSigma.
	 *
	 *  The joint covariance is the inverse of the joint cost's Hessian, scaled so that alignment_benchmark's
	 *  errors are what it says. */
	ObjectAlignment align(
		const std::vector<SurfacePair>& pairs, const mrpt::poses::CPose3D& T_semantic) const;

	/** Of matched objects (query first) of one map, both in its world. */
	ObjectAlignment align(
		const CObjectMap& map, const std::vector<std::pair<ObjectId, ObjectId>>& matches,
		const mrpt::poses::CPose3D& T_semantic) const;

	/** SurfacePair's, of two objects of the map; see centreSigma(). */
	static double centreVariance(const Object& query, const Object& target);

	ObjectAlignerOptions options;
};

}  // namespace semloop

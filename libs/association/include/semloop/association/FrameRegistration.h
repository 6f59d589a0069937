#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/association/MatchingCost.h>
#include <semloop/config/Options.h>

#include <Eigen/Core>
#include <vector>

namespace semloop
{
struct FrameRegistrationOptions : Options
{
	bool enabled = true;
	double sigmaCentre = 0.03;    //!< of a small object's centre [m]
	double sigmaPerRadius = 0.2;  //!< of a large one's, in radii of what is visible of it
	double minSimilarity = 0.5;   //!< of embeddings, for a pair to count
	int minPairs = 3;             //!< that have to agree

protected:
	void describe(OptionFields& fields) override;
};

/** Standard deviations of a camera's pose, the same in every direction. */
struct PoseSigma
{
	double translation = 0;  //!< [m]
	double rotation = 0;     //!< [rad]
};

/** Of independent errors, one after the other: the variances add. */
PoseSigma operator+(const PoseSigma& a, const PoseSigma& b);

/** Of a covariance in the order (translation, rotation): the mean variance of each. */
PoseSigma sigmaOf(const Eigen::Matrix<double, 6, 6>& covariance);

/** What the detections say about the camera's pose. */
struct FrameRegistration
{
	mrpt::poses::CPose3D T_seen_expected;  //!< identity: as expected
	PoseSigma sigma;                       //!< of the pose with this correction
	int pairs = 0;                         //!< that agree; 0: nothing is known
};

/** The error of the camera's pose, as far as what is in the picture agrees on it: an error of the pose
 *  moves everything together, so it can be told from a change of the scene before Eq. (3) compares masks
 *  that it has driven apart. Of all pairs of a landmark j and a detection k whose embeddings agree
 *  (without embeddings: best labels), two at a time propose the maximum a posteriori motion (R, t) of
 *
 *      sum |c_k - (R c_j + t)|^2 / sigma_jk^2 + |t|^2 / sigma_t^2 + |log R|^2 / sigma_r^2,
 *      sigma_jk^2 = sigma_centre^2 + (sigma_per_radius max(r_j, r_k))^2 + (r_j - r_k)^2,
 *
 *  c and r being centre and radius of the visible surfaces: what moves the centre of a large one is that
 *  other parts of it are seen. The one with the least sum over one-to-one pairs, each truncated at 11.3
 *  (99 % of chi^2 with three degrees of freedom), wins and is fitted to its inliers. Pairs
 *  beyond the 40 most similar do not count.
 *
 *  The pose stays as expected when fewer than minPairs agree, or when the motion explains what is seen by
 *  less than 22.5 better (99.9 % with six) than no motion does, or than one that pairs all differently: a
 *  row of chairs that all look alike. Throws InputError when embeddings differ in size.
 *  @param prior sigma_t [m] and sigma_r [rad] */
FrameRegistration registerFrame(
	const std::vector<AssociationItem>& landmarks, const std::vector<AssociationItem>& detections,
	const PoseSigma& prior, const FrameRegistrationOptions& options);

}  // namespace semloop

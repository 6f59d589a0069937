#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/association/MatchingCost.h>
#include <semloop/config/Options.h>

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

/** Of independent errors, one after the other. */
PoseSigma operator+(const PoseSigma& a, const PoseSigma& b);

/** What the detections say about the camera's pose. */
struct FrameRegistration
{
	mrpt::poses::CPose3D T_seen_expected;  //!< identity: as expected
	PoseSigma sigma;                       //!< after it
	int pairs = 0;                         //!< that agree; 0: nothing is known
};

/** The error of the camera's pose, as far as all that is in the picture agrees on it: an error of the
 *  pose moves everything together, so it can be told from a change of the scene before Eq. (3)
 *  compares masks that it has driven apart. Of all pairs of a landmark and a detection with centres
 *  whose embeddings agree (without embeddings: best labels), two at a time propose the maximum a
 *  posteriori motion (R, t) of
 *
 *      sum_i |c_k - (R c_j + t)|^2 / sigma_centre^2 + |t|^2 / sigma_t^2 + |log R|^2 / sigma_r^2 ;
 *
 *  the one with the least truncated sum over one-to-one pairs wins and is fitted to all its inliers.
 *  The pose stays as expected when fewer than minPairs agree, or when that explains what is seen about
 *  as well.
 *  @param prior sigma_t and sigma_r */
FrameRegistration registerFrame(
	const std::vector<AssociationItem>& landmarks, const std::vector<AssociationItem>& detections,
	const PoseSigma& prior, const FrameRegistrationOptions& options);

}  // namespace semloop

#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/rtti/CObject.h>
#include <semloop/association/ConfusionMatrix.h>
#include <semloop/association/SurfaceExtent.h>
#include <semloop/config/Options.h>
#include <semloop/observations/CObservationInstances.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace semloop
{
/** One side of an association, as seen from the current camera: a detection, a track moved by the
 *  odometry, or an object's prediction. Points into its owner's data. */
struct AssociationItem
{
	const InstanceMask* mask = nullptr;        //!< m_j or m_k; null: not in the picture
	const LabelScores* labelScores = nullptr;  //!< never null
	/** E_j, or the one e_k: each of unit length, all of one size (empty ones are passed over); may be
	 *  null or empty */
	const std::vector<std::vector<float>>* embeddings = nullptr;
	/** What is, or should be, visible of it, in the camera's frame; empty when no depth tells. */
	std::optional<SurfaceExtent> surface;
};

/** Cost of matching detection k to landmark j: a module ("the association's cost"). */
class MatchingCost : public mrpt::rtti::CObject
{
	DEFINE_VIRTUAL_MRPT_OBJECT(MatchingCost)

public:
	virtual void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) = 0;
	virtual void setConfusionMatrix(ConfusionMatrix confusion) = 0;
	/** In [0, 1], or +infinity when the pair is impossible. */
	virtual double cost(
		const AssociationItem& landmark, const AssociationItem& detection) const = 0;
};

struct SemanticMatchingCostOptions : Options
{
	double lambda = 0.5;             //!< weight of IoU against the embeddings [0, 1]
	double maxCentreDistance = 0.5;  //!< [m]

protected:
	void describe(OptionFields& fields) override;
};

/** The paper's cost, Eq. (3): L = 1 - W p(l_k | l_j), W = lambda IoU + (1 - lambda) d_f,
 *  IoU = |m_k and m_j| / (|m_k| + |m_j| - |m_k and m_j|), d_f = max over e_j in E_j of e_j . e_k
 *  (clipped to [0, 1]). (The paper prints |m_k| twice in the denominator.) p is the agreement of the
 *  two label distributions, each scaled to a sum of 1: a weak score is not a disagreement. Without embeddings on both sides W = IoU; a mask that is null or empty has IoU
 *  0. A pair whose centres are both known and further apart than maxCentreDistance is impossible.
 *
 *  Throws UsageError before setConfusionMatrix(); InputError when labels are not in the confusion
 *  matrix, image sizes differ or embeddings differ in size. */
class SemanticMatchingCost : public MatchingCost
{
	DEFINE_MRPT_OBJECT(SemanticMatchingCost, semloop)

public:
	void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;
	void setConfusionMatrix(ConfusionMatrix confusion) override
	{
		confusion_ = std::move(confusion);
	}
	double cost(const AssociationItem& landmark, const AssociationItem& detection) const override;

	SemanticMatchingCostOptions options;

private:
	std::optional<ConfusionMatrix> confusion_;
};

/** p(l_k | l_j) of two label distributions, each scaled to a sum of 1: what is left to "anything else" says
 *  nothing about their agreement. In [0, 1]. Throws InputError when a label is not in the matrix. */
double labelAgreement(
	const ConfusionMatrix& confusion, const LabelScores& observed, const LabelScores& truth);

/** max over e in set, f in other of e . f; none when either side has no embedding. Throws InputError
 *  when their sizes differ. */
std::optional<double> embeddingSimilarity(
	const std::vector<std::vector<float>>& set, const std::vector<std::vector<float>>& other);

}  // namespace semloop

#include <mrpt/core/initializer.h>
#include <semloop/association/MatchingCost.h>
#include <semloop/config/Error.h>

#include <Eigen/Core>
#include <algorithm>
#include <limits>

namespace semloop
{
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(MatchingCost, mrpt::rtti::CObject, semloop)
IMPLEMENTS_MRPT_OBJECT(SemanticMatchingCost, MatchingCost, semloop)

MRPT_INITIALIZER(registerSemanticMatchingCost)
{
	mrpt::rtti::registerClass(CLASS_ID(semloop::SemanticMatchingCost));
}

namespace
{
double maskOverlap(const InstanceMask* a, const InstanceMask* b)
{
	if (!a || !b) return 0;
	if (a->imageSize() == b->imageSize() && (a->boundingBox() & b->boundingBox()).empty()) return 0;
	return intersectionOverUnion(*a, *b);
}
}  // namespace

void SemanticMatchingCostOptions::describe(OptionFields& fields)
{
	fields.number(
		"lambda", lambda, 0, 1, "Weight of the masks' IoU against the embeddings, Eq. (3)");
	fields.number(
		"max_centre_distance", maxCentreDistance, 0, std::numeric_limits<double>::infinity(),
		"Centres further apart than this [m] are not of one object");
}

void SemanticMatchingCost::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	options.loadFromConfigFile(config, section);
}

double SemanticMatchingCost::cost(
	const AssociationItem& landmark, const AssociationItem& detection) const
{
	if (!confusion_)
		throw UsageError(
			"SemanticMatchingCost: no confusion matrix; call setConfusionMatrix() first");
	if (landmark.surface && detection.surface &&
		(landmark.surface->centre - detection.surface->centre).norm() > options.maxCentreDistance)
		return std::numeric_limits<double>::infinity();

	const double p = labelAgreement(*confusion_, *detection.labelScores, *landmark.labelScores);
	if (p <= 0) return 1;
	double similarity = maskOverlap(landmark.mask, detection.mask);
	if (options.lambda < 1 && landmark.embeddings && detection.embeddings)
		if (const auto d_f = embeddingSimilarity(*landmark.embeddings, *detection.embeddings))
			similarity =
				options.lambda * similarity + (1 - options.lambda) * std::clamp(*d_f, 0.0, 1.0);
	return 1 - similarity * p;
}

// The paper's l_k and l_j are certain, its confidence c_k is not in Eq. (3).
double labelAgreement(
	const ConfusionMatrix& confusion, const LabelScores& observed, const LabelScores& truth)
{
	const auto sum = [](const LabelScores& scores)
	{
		double total = 0;
		for (const auto& s : scores) total += s.score;
		return total;
	};
	const double mass = sum(observed) * sum(truth);
	if (mass <= 0) return 0;
	return std::min(1.0, confusion.agreement(observed, truth) / mass);
}

std::optional<double> embeddingSimilarity(
	const std::vector<std::vector<float>>& set, const std::vector<std::vector<float>>& other)
{
	using Vector = Eigen::Map<const Eigen::VectorXf>;
	std::optional<double> best;
	for (const auto& f : other)
		for (const auto& e : set)
		{
			if (e.empty() || f.empty()) continue;
			if (e.size() != f.size())
				throw InputError(
					"embeddings of " + std::to_string(e.size()) + " and " +
					std::to_string(f.size()) + " numbers cannot be compared; use one network");
			const auto size = Eigen::Index(e.size());
			const double dot = Vector(e.data(), size).dot(Vector(f.data(), size));
			if (!best || dot > *best) best = dot;
		}
	return best;
}

}  // namespace semloop

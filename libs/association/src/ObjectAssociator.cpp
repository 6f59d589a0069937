#include <mrpt/core/initializer.h>
#include <semloop/association/ObjectAssociator.h>
#include <semloop/config/Error.h>

namespace semloop
{
IMPLEMENTS_MRPT_OBJECT(ObjectAssociator, Associator, semloop)

MRPT_INITIALIZER(registerObjectAssociator)
{
	mrpt::rtti::registerClass(CLASS_ID(semloop::ObjectAssociator));
}

void ObjectAssociatorOptions::describe(OptionFields& fields)
{
	fields.number("gate", gate, 0, 1, "Largest matching cost of a match, Eq. (1)");
}

void ObjectAssociator::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	options.loadFromConfigFile(config, section);
}

AssignmentResult ObjectAssociator::associate(
	const std::vector<AssociationItem>& landmarks,
	const std::vector<AssociationItem>& detections) const
{
	if (!cost_)
		throw UsageError("ObjectAssociator: no matching cost; call setMatchingCost() first");
	return solveAssignment(matchingCosts(*cost_, landmarks, detections), options.gate);
}

CostMatrix matchingCosts(
	const MatchingCost& cost, const std::vector<AssociationItem>& landmarks,
	const std::vector<AssociationItem>& detections)
{
	CostMatrix costs(landmarks.size(), detections.size());
	for (std::size_t j = 0; j < landmarks.size(); ++j)
		for (std::size_t k = 0; k < detections.size(); ++k)
			costs(j, k) = cost.cost(landmarks[j], detections[k]);
	return costs;
}

}  // namespace semloop

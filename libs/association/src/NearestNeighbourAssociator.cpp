#include <mrpt/core/initializer.h>
#include <semloop/association/NearestNeighbourAssociator.h>

#include <algorithm>
#include <limits>

namespace semloop
{
IMPLEMENTS_MRPT_OBJECT(NearestNeighbourAssociator, Associator, semloop)

MRPT_INITIALIZER(registerNearestNeighbourAssociator)
{
	mrpt::rtti::registerClass(CLASS_ID(semloop::NearestNeighbourAssociator));
}

namespace
{
/** Infinite when the pair is not compatible. */
double centreDistance(const AssociationItem& landmark, const AssociationItem& detection)
{
	if (!landmark.surface || !detection.surface || landmark.labelScores->empty() ||
		detection.labelScores->empty() ||
		landmark.labelScores->front().label != detection.labelScores->front().label)
		return std::numeric_limits<double>::infinity();
	return (landmark.surface->centre - detection.surface->centre).norm();
}
}  // namespace

void NearestNeighbourAssociatorOptions::describe(OptionFields& fields)
{
	fields.number(
		"max_centre_distance", maxCentreDistance, 0, std::numeric_limits<double>::infinity(),
		"Largest distance between the centres of a match [m]");
}

void NearestNeighbourAssociator::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	options.loadFromConfigFile(config, section);
}

AssignmentResult NearestNeighbourAssociator::associate(
	const std::vector<AssociationItem>& landmarks,
	const std::vector<AssociationItem>& detections) const
{
	AssignmentResult result;
	std::vector<bool> taken(landmarks.size(), false);
	for (std::size_t k = 0; k < detections.size(); ++k)
	{
		double nearest = std::numeric_limits<double>::infinity();
		std::size_t best = 0;
		for (std::size_t j = 0; j < landmarks.size(); ++j)
		{
			if (taken[j]) continue;
			const double distance = centreDistance(landmarks[j], detections[k]);
			if (distance < nearest)
			{
				nearest = distance;
				best = j;
			}
		}
		if (!(nearest <= options.maxCentreDistance)) continue;
		taken[best] = true;
		result.matches.emplace_back(best, k);
		result.cost += nearest;
	}
	std::sort(result.matches.begin(), result.matches.end());
	return result;
}

}  // namespace semloop

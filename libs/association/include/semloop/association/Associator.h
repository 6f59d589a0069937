#pragma once

#include <mrpt/rtti/CObject.h>
#include <semloop/association/Assignment.h>
#include <semloop/association/MatchingCost.h>

#include <memory>
#include <vector>

namespace semloop
{
/** Detections -> landmarks. Matches are (landmark, detection), each at most once, by landmark;
 *  everything else is unmatched. A module with two implementations, so that the paper's experiment
 *  (Sec. IV-A) can be run. */
class Associator : public mrpt::rtti::CObject
{
	DEFINE_VIRTUAL_MRPT_OBJECT(Associator)

public:
	virtual void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) = 0;
	virtual void setMatchingCost(std::shared_ptr<const MatchingCost> cost) = 0;
	virtual AssignmentResult associate(
		const std::vector<AssociationItem>& landmarks,
		const std::vector<AssociationItem>& detections) const = 0;
};

}  // namespace semloop

#pragma once

#include <semloop/association/Associator.h>
#include <semloop/config/Options.h>

#include <memory>
#include <string>
#include <vector>

namespace semloop
{
struct ObjectAssociatorOptions : Options
{
	double gate = 0.55;  //!< largest matching cost of a match

protected:
	void describe(OptionFields& fields) override;
};

/** The paper's association (Sec. III-B): Eq. (1) over the matching costs of all pairs, solved as a
 *  whole; a pair dearer than the gate is not matched. The result's cost sums the matches'. */
class ObjectAssociator : public Associator
{
	DEFINE_MRPT_OBJECT(ObjectAssociator, semloop)

public:
	void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;
	void setMatchingCost(std::shared_ptr<const MatchingCost> cost) override
	{
		cost_ = std::move(cost);
	}
	/** Throws UsageError before setMatchingCost(). */
	AssignmentResult associate(
		const std::vector<AssociationItem>& landmarks,
		const std::vector<AssociationItem>& detections) const override;

	ObjectAssociatorOptions options;

private:
	std::shared_ptr<const MatchingCost> cost_;
};

/** L(j, k) of every row item j and column item k. */
CostMatrix matchingCosts(
	const MatchingCost& cost, const std::vector<AssociationItem>& landmarks,
	const std::vector<AssociationItem>& detections);

}  // namespace semloop

#pragma once

#include <semloop/association/Associator.h>
#include <semloop/config/Options.h>

#include <memory>
#include <string>
#include <vector>

namespace semloop
{
struct NearestNeighbourAssociatorOptions : Options
{
	double maxCentreDistance = 0.5;  //!< the gate [m]

protected:
	void describe(OptionFields& fields) override;
};

/** The baseline of the paper's experiment (Sec. IV-A): each detection, in the order given, takes the
 *  nearest landmark of its own most probable label by the distance of the centres, within the gate
 *  and not taken before. An item without a centre is never matched; of equally near landmarks the
 *  first is taken. The result's cost sums the distances [m].
 *
 *  Individually compatible nearest neighbour (Neira and Tardós, "Data association in stochastic
 *  mapping using the joint compatibility test", IEEE TRA 17(6), 2001) with a fixed gate and the label
 *  as the compatibility test. The matching cost plays no part. */
class NearestNeighbourAssociator : public Associator
{
	DEFINE_MRPT_OBJECT(NearestNeighbourAssociator, semloop)

public:
	void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;
	/** Accepted, and not used. */
	void setMatchingCost(std::shared_ptr<const MatchingCost>) override {}
	AssignmentResult associate(
		const std::vector<AssociationItem>& landmarks,
		const std::vector<AssociationItem>& detections) const override;

	NearestNeighbourAssociatorOptions options;
};

}  // namespace semloop

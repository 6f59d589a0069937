#pragma once

#include <semloop/association/ConfusionMatrix.h>

#include <Eigen/Core>
#include <string>

namespace semloop
{
/** p(a | b): how probably an object is called a in one map when it is called b in another.
 *
 *  With a confusion matrix p(l | t), l observed and t true, and no true label more probable than another,
 *      p(a | b) = sum over t of p(a | t) p(b | t) / sum over t of p(b | t);
 *  without one, or for labels that it does not have, `accuracy` when a is b, and else the rest evenly. */
class LabelAgreement
{
public:
	explicit LabelAgreement(double accuracy = 0.92) : accuracy_(accuracy) {}
	LabelAgreement(double accuracy, const ConfusionMatrix& confusion);

	/** `labels`: among how many the rest is spread. */
	double probability(const std::string& a, const std::string& b, std::size_t labels) const;

private:
	double accuracy_;
	LabelSet labels_;
	Eigen::MatrixXd p_;  //!< row b, column a
};

}  // namespace semloop

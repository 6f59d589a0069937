#include <semloop/loop_closure/LabelAgreement.h>

#include <algorithm>

namespace semloop
{
LabelAgreement::LabelAgreement(double accuracy, const ConfusionMatrix& confusion)
	: accuracy_(accuracy), labels_(confusion.labels())
{
	const auto n = Eigen::Index(labels_.size());
	Eigen::MatrixXd observed(n, n);  // row: true
	for (Eigen::Index t = 0; t < n; ++t)
		for (Eigen::Index l = 0; l < n; ++l)
			observed(t, l) = confusion.probability(uint32_t(l), uint32_t(t));
	p_.noalias() = observed.transpose() * observed;
	const Eigen::VectorXd sums = observed.colwise().sum();
	for (Eigen::Index b = 0; b < n; ++b)
		if (sums[b] > 0) p_.row(b) /= sums[b];
}

double LabelAgreement::probability(
	const std::string& a, const std::string& b, std::size_t labels) const
{
	if (labels_.size() > 0)
	{
		const auto i = labels_.find(a), k = labels_.find(b);
		if (i && k) return p_(Eigen::Index(*k), Eigen::Index(*i));
	}
	if (a == b) return accuracy_;
	return (1 - accuracy_) / double(std::max<std::size_t>(2, labels) - 1);
}

}  // namespace semloop

#pragma once

#include <semloop/observations/LabelSet.h>

#include <Eigen/Core>
#include <string>

namespace semloop
{
/** How often each pair of labels stands in a CSV file; row: true, column: observed. Its lines are
 *  `true,observed` or `true,observed,count` by label name; blank lines and lines beginning with #
 *  are passed over. Throws InputError naming file and line. */
Eigen::MatrixXd countLabelPairs(const std::string& path, const LabelSet& labels);

}  // namespace semloop

#pragma once

#include <semloop/evaluation/TrajectoryError.h>
#include <semloop/evaluation/TrueFrames.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace semloop
{
/** Path of a file that semloop-slam leaves behind; throws InputError, with the remedy, when it or the
 *  folder is missing. */
std::string runFile(const std::string& folder, const std::string& name);

/** The frames of a run with their truth; errors name the files. See readTrueFrames() for the images. */
std::vector<RunFrame> runWithTruth(
	const std::string& folder, const std::string& truthRawlog, const std::string& images = {});

/** A number, or null. */
nlohmann::ordered_json numberOrNull(const std::optional<double>& value);

/** Count, rmse, mean, median and max times `scale`; null where there is nothing to tell. */
nlohmann::ordered_json toJson(const ErrorSummary& errors, double scale = 1);

/** Four decimals, or "-". */
std::string toText(const std::optional<double>& value);

}  // namespace semloop

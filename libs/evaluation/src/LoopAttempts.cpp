#include <semloop/config/Error.h>
#include <semloop/evaluation/LoopAttempts.h>

#include <fstream>
#include <nlohmann/json.hpp>

namespace semloop
{
namespace
{
LoopAttempt parseAttempt(const nlohmann::json& line)
{
	LoopAttempt attempt;
	line.at("frame").get_to(attempt.frame);
	line.at("local_map_since").get_to(attempt.localMapSince);
	line.at("graphs_match").get_to(attempt.detected);
	line.at("candidates").get_to(attempt.candidates);
	line.at("matches").get_to(attempt.matches);
	for (const auto& match : line.value("cameras", nlohmann::json::array()))
		attempt.cameras.emplace_back(
			match.at(0).get<std::size_t>(), match.at(1).get<std::size_t>());
	attempt.accepted = line.at("decision").get<std::string>() == "accepted";
	return attempt;
}

/** nlohmann's message behind its "[json.exception...] ". */
std::string reasonOf(const nlohmann::json::exception& error)
{
	const std::string what = error.what();
	const auto end = what.find("] ");
	return end == std::string::npos ? what : what.substr(end + 2);
}
}  // namespace

std::vector<LoopAttempt> readLoopAttempts(const std::string& path)
{
	std::ifstream file(path);
	if (!file) throw InputError(path + ": cannot be read; give what semloop-slam wrote");
	std::vector<LoopAttempt> attempts;
	std::string line;
	for (std::size_t number = 1; std::getline(file, line); number++)
	{
		try
		{
			attempts.push_back(parseAttempt(nlohmann::json::parse(line)));
		}
		catch (const nlohmann::json::exception& error)
		{
			throw InputError(
				path + ":" + std::to_string(number) + ": " + reasonOf(error) +
				"; run semloop-slam again");
		}
	}
	return attempts;
}

}  // namespace semloop

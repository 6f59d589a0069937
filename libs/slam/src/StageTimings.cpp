#include <semloop/config/Error.h>
#include <semloop/slam/StageTimings.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

namespace semloop
{
namespace
{
/** Nearest rank: the smallest sample that at least this share of the samples does not exceed. */
double percentile(const std::vector<float>& sorted, double share)
{
	const auto rank = std::size_t(std::ceil(share * double(sorted.size())));
	return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}
}  // namespace

StageTimings::Scope::~Scope()
{
	const auto elapsed = std::chrono::steady_clock::now() - start_;
	timings_.add(stage_, std::chrono::duration<double, std::milli>(elapsed).count());
}

void StageTimings::add(const std::string& stage, double milliseconds)
{
	const std::lock_guard lock(mutex_);
	Stage& s = stages_[stage];
	s.samples.push_back(float(milliseconds));
	s.total += milliseconds;
}

std::map<std::string, StageTimings::Total> StageTimings::totals() const
{
	const std::lock_guard lock(mutex_);
	std::map<std::string, Total> result;
	for (const auto& [name, stage] : stages_) result[name] = {stage.samples.size(), stage.total};
	return result;
}

std::map<std::string, StageTimings::Summary> StageTimings::summaries() const
{
	const std::lock_guard lock(mutex_);
	std::map<std::string, Summary> result;
	for (const auto& [name, stage] : stages_)
	{
		std::vector<float> sorted = stage.samples;
		std::sort(sorted.begin(), sorted.end());
		Summary& s = result[name];
		s.count = sorted.size();
		s.milliseconds = stage.total;
		s.mean = s.milliseconds / double(s.count);
		s.p50 = percentile(sorted, 0.50);
		s.p95 = percentile(sorted, 0.95);
		s.max = sorted.back();
	}
	return result;
}

void StageTimings::writeCsv(const std::string& path) const
{
	std::ofstream out(path);
	out << "stage,count,mean_ms,p50_ms,p95_ms,max_ms\n";
	for (const auto& [stage, s] : summaries())
	{
		char line[256];
		std::snprintf(
			line, sizeof(line), "%s,%zu,%.3f,%.3f,%.3f,%.3f\n", stage.c_str(), s.count, s.mean,
			s.p50, s.p95, s.max);
		out << line;
	}
	if (!out.flush()) throw InputError(path + ": cannot be written; is the disk full?");
}

}  // namespace semloop

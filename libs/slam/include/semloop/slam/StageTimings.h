#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace semloop
{
/** Wall time per stage of the pipeline. Safe to use from several threads. */
class StageTimings
{
public:
	struct Total
	{
		std::size_t count = 0;
		double milliseconds = 0.0;
	};
	struct Summary : Total
	{
		double mean = 0.0, p50 = 0.0, p95 = 0.0, max = 0.0;  //!< [ms]
	};

	/** Adds its own lifetime to a stage. */
	class Scope
	{
	public:
		Scope(StageTimings& timings, const char* stage)
			: timings_(timings), stage_(stage), start_(std::chrono::steady_clock::now())
		{
		}
		~Scope();
		Scope(const Scope&) = delete;
		Scope& operator=(const Scope&) = delete;

	private:
		StageTimings& timings_;
		const char* stage_;
		std::chrono::steady_clock::time_point start_;
	};

	void add(const std::string& stage, double milliseconds);
	/** By stage name. */
	std::map<std::string, Total> totals() const;
	/** Same, sorting all samples. Percentiles by the nearest-rank rule. */
	std::map<std::string, Summary> summaries() const;
	/** stage,count,mean_ms,p50_ms,p95_ms,max_ms; throws InputError when the file cannot be written. */
	void writeCsv(const std::string& path) const;

private:
	struct Stage
	{
		std::vector<float> samples;  //!< [ms]
		double total = 0.0;          //!< of them, before they were rounded [ms]
	};

	mutable std::mutex mutex_;
	std::map<std::string, Stage> stages_;
};

}  // namespace semloop

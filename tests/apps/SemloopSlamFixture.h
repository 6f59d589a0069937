#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semloop/observations/RawlogReader.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>

#include "../slam/SyntheticRun.h"

namespace semloop::synthetic
{
/** Runs semloop-slam, the program, on a short recording in a folder of its own. */
class SemloopSlamFixture : public testing::Test
{
protected:
	static constexpr const char* kProgram = SEMLOOP_BINARY_DIR "/bin/semloop-slam";
	static constexpr const char* kConfig = SEMLOOP_SOURCE_DIR "/config_ini/recorded_odometry.ini";

	/** The exit code; what was printed is in files out and err. */
	int run(const std::string& arguments) const
	{
		const std::string command = "'" + std::string(kProgram) + "' " + arguments + " > '" +
									folder_.file("out") + "' 2> '" + folder_.file("err") + "'";
		const int status = std::system(command.c_str());
		return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
	}
	std::string messages() const { return readBytes(folder_.file("err")); }
	std::size_t messageLines() const
	{
		const std::string text = messages();
		return std::size_t(std::count(text.begin(), text.end(), '\n'));
	}
	nlohmann::json summary() const
	{
		return nlohmann::json::parse(readBytes(folder_.file("result/summary.json")));
	}

	RecordedRun recordShortRun() const
	{
		RunOptions options;
		options.degrees = 40;
		return recordRun(folder_, options);
	}
	/** With the recorded instances of this rawlog. */
	std::string arguments(const RecordedRun& recorded, const std::string& instances) const
	{
		return "-c '" + std::string(kConfig) + "' -i '" + recorded.rawlog + "' -o '" +
			   folder_.file("result") + "' --set 'odometry.file=" + recorded.truth +
			   "' --instances '" + instances + "'";
	}
	std::string arguments(const RecordedRun& recorded) const
	{
		return arguments(recorded, recorded.rawlog);
	}

	using ChangeScan = std::function<void(int index, mrpt::obs::CObservation3DRangeScan&)>;
	/** The same recording with changed scans, and without the instances in it. */
	RecordedRun changed(const RecordedRun& recorded, const ChangeScan& change) const
	{
		RecordedRun result = recorded;
		result.rawlog = folder_.file("changed.rawlog");
		RawlogReader reader(recorded.rawlog);
		RawlogWriter writer(result.rawlog);
		for (int index = 0; const auto observation = reader.next();)
			if (const auto scan =
					std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(observation))
			{
				change(index++, *scan);
				writer.write(*scan);
			}
		writer.close();
		return result;
	}

	const TemporaryFolder folder_;
};

}  // namespace semloop::synthetic

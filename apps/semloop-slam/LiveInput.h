#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <semloop/sensors/SensorRecorder.h>
#include <semloop/sensors/SensorSource.h>
#include <semloop/slam/LiveOptions.h>

#include <memory>
#include <string>

#include "MappingLoop.h"

namespace semloop
{
/** A sensor that grabs, and the rawlog that keeps what it gives. */
class LiveInput
{
public:
	/** record may be empty. Throws as SensorSource and SensorRecorder do. */
	LiveInput(
		const mrpt::config::CConfigFileBase& config, const std::string& section,
		const std::string& record);

	const SensorSource& sensor() const { return *sensor_; }
	/** What ended the run early because of bad input, or spoiled the recording; empty otherwise. */
	std::string run(
		MappingLoop& loop, const FrontEnd& frontEnd, SemanticSlam& slam, StageTimings& timings,
		RunInfo& info);
	/** The sensor's driver does not return: no destructor may run under it (leaveAtOnce). */
	bool isStuck() const;

private:
	LiveOptions options_;
	std::shared_ptr<SensorRecorder> recorder_;
	std::shared_ptr<News> news_ = std::make_shared<News>();
	std::unique_ptr<SensorSource> sensor_;
};

}  // namespace semloop

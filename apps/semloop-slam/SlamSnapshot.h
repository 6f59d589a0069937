#pragma once

#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>
#include <semloop/object_map/CObjectMap.h>
#include <semloop/observations/Trajectory.h>
#include <semloop/slam/SemanticSlam.h>
#include <semloop/slam/SlamFrame.h>
#include <semloop/slam/StageTimings.h>

#include <chrono>
#include <cstddef>
#include <map>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

namespace semloop
{
/** What the window shows and cannot know from the run's data. */
struct WindowNews
{
	std::size_t dropped = 0;  //!< SensorCounts::dropped: not only frames; 0 without a sensor
	std::string status;  //!< one line for a person, e.g. "no frame for 2 s"; empty: nothing to tell
};

/** How a stage of the pipeline does, over the last second or two. */
struct StageRate
{
	double milliseconds = 0.0;  //!< mean of a call; of the last ones when there was none
	double perSecond = 0.0;
};

/** The map and how it came about; costs more the longer the run is. */
struct MapSnapshot
{
	CObjectMap map;  //!< shares its volumes with the run's map
	Trajectory trajectory, odometryTrajectory;
	std::size_t loopsAccepted = 0, loopsAmbiguous = 0, loopsRejected = 0;
	std::optional<std::size_t> lastLoopFrame;  //!< of the last accepted loop
	std::vector<MatchedObjects> lastLoop;      //!< its matches
	double framesPerSecond = 0.0;              //!< mapped, over the last second or two
	std::map<std::string, StageRate> stages;
};

/** What the camera saw last; shares its images with the frame. */
struct PictureSnapshot
{
	cv::Mat color;
	CObservationInstances::Ptr instances;  //!< null: not segmented
	mrpt::img::TCamera camera;
	double progress = 0.0;  //!< share of the rawlog; 0: there is none
};

/** The state of a run. */
struct SlamSnapshot
{
	PictureSnapshot picture;
	mrpt::poses::CPose3D T_world_camera;
	std::size_t frames = 0, notSegmented = 0, lost = 0;
	WindowNews news;
	std::optional<MapSnapshot> map;  //!< not with every frame
};

/** Takes snapshots of a run, in the thread that runs it. The map comes along a few times a second, and
 *  so seldom that taking it costs a small share of the run's time. */
class SnapshotTaker
{
public:
	/** @param frame null: there was none since the last snapshot
	 *  @param withMap whether or not the map's turn has come */
	SlamSnapshot take(
		const SlamFrame* frame, const SemanticSlam& slam, const StageTimings& timings,
		const WindowNews& news, bool withMap);

private:
	using Clock = std::chrono::steady_clock;

	MapSnapshot takeMap(const SemanticSlam& slam, const StageTimings& timings);
	void updateRates(const SemanticSlam& slam, const StageTimings& timings);

	PictureSnapshot picture_;
	Clock::time_point mapDue_ = Clock::now();
	Clock::time_point ratesSince_ = mapDue_;
	std::size_t framesThen_ = 0;
	std::map<std::string, StageTimings::Total> totalsThen_;
	double framesPerSecond_ = 0.0;
	std::map<std::string, StageRate> stages_;
};

}  // namespace semloop

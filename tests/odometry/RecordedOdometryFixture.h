#pragma once

#include <semloop/odometry/RecordedOdometry.h>

#include "OdometryFixtures.h"
#include "TemporaryFolder.h"

namespace semloop::test
{
/** Only the time matters here. */
inline RgbdFrame frameOf(double seconds)
{
	RgbdFrame frame;
	frame.time = at(seconds);
	return frame;
}

/** A curve in the file's world, far from its origin. */
inline CPose3D recorded(double seconds)
{
	return CPose3D(5 + 0.3 * seconds, -2 + 0.1 * seconds * seconds, 1, 0.2 * seconds, 0.1, -1.5);
}

class RecordedOdometryFile : public ::testing::Test
{
protected:
	/** The curve from a time to another, ten poses a second. */
	RecordedOdometryOptions optionsWithFile(double from, double to)
	{
		Trajectory trajectory;
		for (int i = 0; i <= int(std::lround((to - from) * 10)); i++)
			trajectory.push_back({at(from + 0.1 * i), recorded(from + 0.1 * i)});
		RecordedOdometryOptions options;
		options.file = folder_.file("odometry.tum");
		writeTumTrajectory(options.file, trajectory);
		return options;
	}

	TemporaryFolder folder_;
};
}  // namespace semloop::test

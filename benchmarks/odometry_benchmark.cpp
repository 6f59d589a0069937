#include <benchmark/benchmark.h>
#include <semloop/odometry/OpenCvOdometry.h>

#include <chrono>
#include <string>
#include <vector>

#include "../tests/common/SyntheticScene.h"

namespace
{
using semloop::synthetic::lookAt;

/** 640x480 frames of a textured room, a centimetre apart. */
std::vector<semloop::RgbdFrame> frames()
{
	semloop::synthetic::Scene room;
	room.planes.push_back({{0, 0, 1}, 0, {200, 200, 200}, 0, 0.11});
	room.planes.push_back({{1, 0, 0}, 2.5, {180, 200, 160}, 0, 0.13});
	room.spheres.push_back({{1.2, 0.3, 0.35}, 0.3, {200, 200, 90}, 0, 0.06});
	std::vector<semloop::RgbdFrame> result;
	for (int i = 0; i < 8; i++)
	{
		result.push_back(semloop::synthetic::renderFrame(
			room, semloop::synthetic::vgaCamera(),
			lookAt({-0.5 + 0.01 * i, 0.01 * i, 0.9}, {1.5, 0.1, 0.4})));
		semloop::synthetic::addDepthNoise(result.back(), 0.002, unsigned(i));
	}
	return result;
}

/** Milliseconds a frame; there and back, so that the motion never jumps. */
void track(benchmark::State& state, const std::string& method, int refineIterations)
{
	semloop::OpenCvOdometryOptions options;
	options.method = method;
	options.refineIterations = refineIterations;
	semloop::OpenCvOdometry odometry(options);
	const auto all = frames();
	const int last = int(all.size()) - 1;
	int i = 0, direction = 1;
	mrpt::Clock::time_point time;
	for (auto _ : state)
	{
		auto frame = all[std::size_t(i)];
		frame.time = time;
		benchmark::DoNotOptimize(odometry.track(frame));
		if (i + direction < 0 || i + direction > last) direction = -direction;
		i += direction;
		time += std::chrono::milliseconds(33);
	}
}

BENCHMARK_CAPTURE(track, rgbd_icp, std::string("rgbd_icp"), 10)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(track, rgbd, std::string("rgbd"), 10)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(track, icp, std::string("icp"), 10)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(track, rgbd_without_refinement, std::string("rgbd"), 0)
	->Unit(benchmark::kMillisecond);
}  // namespace

BENCHMARK_MAIN();

#include <mrpt/core/format.h>
#include <semloop/config/Error.h>
#include <semloop/observations/CameraFrames.h>
#include <semloop/simulation/CameraPath.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "Random.h"

namespace semloop
{
namespace
{
using Eigen::Vector2d;

constexpr double kStep = 0.02;      // of the way [m]
constexpr double kLookAhead = 0.6;  // a carrier's heading is that of the next steps [m]
constexpr double kEase = 1.0;       // constant of smoothing the heading [s]

/** Barry and Goldman's pyramid for centripetal knots. */
Vector2d catmullRom(const std::array<Vector2d, 4>& p, double share)
{
	std::array<double, 4> t{};
	for (int i = 1; i < 4; ++i)
		t[i] = t[i - 1] + std::max(1e-6, std::sqrt((p[i] - p[i - 1]).norm()));
	const double at = t[1] + share * (t[2] - t[1]);
	const auto blend = [&](const Vector2d& a, const Vector2d& b, int i, int j) -> Vector2d
	{ return ((t[j] - at) * a + (at - t[i]) * b) / (t[j] - t[i]); };
	const Vector2d a1 = blend(p[0], p[1], 0, 1), a2 = blend(p[1], p[2], 1, 2),
				   a3 = blend(p[2], p[3], 2, 3);
	return blend(blend(a1, a2, 0, 2), blend(a2, a3, 1, 3), 1, 2);
}

/** Points on a polyline from its begin to its end, kStep apart or a little less. */
std::vector<Vector2d> inEqualSteps(const std::vector<Vector2d>& line)
{
	double length = 0;
	for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
	if (length < kLookAhead)
		throw InputError(mrpt::format(
			"a way of %.2f m is too short to walk; give waypoints further apart", length));
	const auto steps = std::size_t(std::ceil(length / kStep));
	std::vector<Vector2d> points{line.front()};
	double walked = 0;  // to line[i - 1]
	for (std::size_t i = 1; i < line.size(); ++i)
	{
		const Vector2d piece = line[i] - line[i - 1];
		const auto next = [&] { return double(points.size()) * length / double(steps); };
		for (; points.size() < steps && next() <= walked + piece.norm();)
			points.push_back(line[i - 1] + (next() - walked) / piece.norm() * piece);
		walked += piece.norm();
	}
	points.push_back(line.back());
	return points;
}

/** Sum of a few sines of standard deviation 1: smooth, and looks random. */
class Wobble
{
public:
	Wobble(RandomStream& random, double slowest, double fastest)
	{
		for (auto& wave : waves_)
			wave = {random.uniform(slowest, fastest), random.uniform(0, 2 * M_PI)};
	}
	double at(double time) const
	{
		double sum = 0;
		for (const auto& [frequency, phase] : waves_)
			sum += std::sin(2 * M_PI * frequency * time + phase);
		return sum * std::sqrt(2.0 / double(waves_.size()));
	}

private:
	std::array<std::pair<double, double>, 5> waves_;  // [Hz], [rad]
};

/** Where the carrier is, and where he looks, without swaying. */
struct Step
{
	Vector2d place;
	double heading = 0;  //!< [rad], not wrapped
};

double headingAt(const std::vector<Vector2d>& way, std::size_t i)
{
	const auto ahead = std::size_t(kLookAhead / kStep);
	const std::size_t to = std::min(way.size() - 1, i + ahead);
	const std::size_t from = to == way.size() - 1 ? to - std::min(to, ahead) : i;
	const Vector2d d = way[to] - way[from];
	return std::atan2(d.y(), d.x());
}

double unwrapped(double angle, double previous)
{
	return previous + std::remainder(angle - previous, 2 * M_PI);
}

void walk(const std::vector<Vector2d>& way, double speed, double rate, std::vector<Step>& steps)
{
	const double length = kStep * double(way.size() - 1);
	const auto count = std::size_t(length / speed * rate);
	for (std::size_t i = 0; i <= count; ++i)
	{
		const double at = double(i) / rate * speed / kStep;
		const std::size_t index = std::min(std::size_t(at), way.size() - 2);
		Step step;
		step.place = way[index] + (at - double(index)) * (way[index + 1] - way[index]);
		step.heading = headingAt(way, index);
		if (!steps.empty()) step.heading = unwrapped(step.heading, steps.back().heading);
		steps.push_back(step);
	}
}

void turnRound(double duration, double rate, std::vector<Step>& steps)
{
	const Step last = steps.back();
	const auto count = std::size_t(duration * rate);
	for (std::size_t i = 1; i <= count; ++i)
	{
		const double share = double(i) / double(count);
		steps.push_back({last.place, last.heading + M_PI * (0.5 - 0.5 * std::cos(M_PI * share))});
	}
}

/** Forward and backward exponential smoothing: no lag. */
void smoothHeadings(std::vector<Step>& steps, double rate)
{
	const double keep = std::exp(-1.0 / (kEase * rate));
	for (std::size_t i = 1; i < steps.size(); ++i)
		steps[i].heading = keep * steps[i - 1].heading + (1 - keep) * steps[i].heading;
	for (std::size_t i = steps.size() - 1; i-- > 0;)
		steps[i].heading = keep * steps[i + 1].heading + (1 - keep) * steps[i].heading;
}
}  // namespace

std::vector<Vector2d> splineThrough(const std::vector<Vector2d>& waypoints, bool closed)
{
	const auto n = int(waypoints.size());
	const auto point = [&](int i) -> Vector2d
	{
		if (closed) return waypoints[(i + n) % n];
		// Beyond the ends it goes straight on.
		if (i < 0) return 2 * waypoints[0] - waypoints[1];
		if (i >= n) return 2 * waypoints[n - 1] - waypoints[n - 2];
		return waypoints[i];
	};
	std::vector<Vector2d> dense;
	constexpr int kSamples = 400;
	for (int i = 0; i < (closed ? n : n - 1); ++i)
		for (int sample = 0; sample < kSamples; ++sample)
			dense.push_back(catmullRom(
				{point(i - 1), point(i), point(i + 1), point(i + 2)}, double(sample) / kSamples));
	dense.push_back(point(closed ? 0 : n - 1));

	return inEqualSteps(dense);
}

void requireFreeWay(const std::vector<Vector2d>& way, const FloorPlan& plan, double radius)
{
	for (const auto& place : way)
		if (!plan.isFree(place, radius))
			throw InputError(mrpt::format(
				"the way goes through a wall, or closer than %g m to one, at (%.2f, %.2f); move "
				"the "
				"waypoints beside it or make a door",
				radius, place.x(), place.y()));
}

Trajectory carriedCamera(
	const std::vector<Vector2d>& way, const PathOptions& options, double rate,
	mrpt::Clock::time_point start, uint64_t seed)
{
	std::vector<Step> steps;
	walk(way, options.speed, rate, steps);
	if (options.returns)
	{
		turnRound(options.turn, rate, steps);
		walk({way.rbegin(), way.rend()}, options.speed, rate, steps);
	}
	smoothHeadings(steps, rate);

	RandomStream random(seed);
	const double phase = random.uniform(0, 2 * M_PI);
	const Wobble height(random, 0.05, 0.4), x(random, 0.5, 2.5), y(random, 0.5, 2.5),
		yaw(random, 0.3, 2.0), pitch(random, 0.3, 2.0), roll(random, 0.3, 2.0);
	const double middle = (options.minimumHeight + options.maximumHeight) / 2;
	const double range = (options.maximumHeight - options.minimumHeight) / 2;
	Trajectory trajectory;
	trajectory.reserve(steps.size());
	for (std::size_t i = 0; i < steps.size(); ++i)
	{
		const double t = double(i) / rate;
		const double look = options.sway * std::sin(2 * M_PI * t / options.swayPeriod + phase);
		// MRPT's sensor frame looks along x; its pitch is positive downwards.
		const mrpt::poses::CPose3D T_world_sensor(
			steps[i].place.x() + options.jitterTranslation * x.at(t),
			steps[i].place.y() + options.jitterTranslation * y.at(t),
			middle + range * std::clamp(0.6 * height.at(t), -1.0, 1.0),
			steps[i].heading + look + options.jitterRotation * yaw.at(t),
			-options.pitch + options.jitterRotation * pitch.at(t),
			options.jitterRotation * roll.at(t));
		const auto sinceStart =
			std::chrono::duration_cast<mrpt::Clock::duration>(std::chrono::duration<double>(t));
		trajectory.push_back({start + sinceStart, T_world_sensor + sensorFromCamera()});
	}
	return trajectory;
}

}  // namespace semloop

#include <mrpt/math/CQuaternion.h>
#include <mrpt/math/slerp.h>
#include <semloop/config/Error.h>
#include <semloop/observations/Trajectory.h>
#include <semloop/observations/UnixTime.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace semloop
{
namespace
{
using Quaternion = mrpt::math::CQuaternionDouble;

constexpr double kUnitTolerance = 0.01;

std::vector<std::string> words(const std::string& line)
{
	std::istringstream in(line);
	std::vector<std::string> result;
	for (std::string word; in >> word;) result.push_back(word);
	return result;
}

std::optional<double> parseNumber(const std::string& text)
{
	double value = 0;
	const char* const last = text.data() + text.size();
	const auto [end, error] = std::from_chars(text.data(), last, value);
	if (error != std::errc() || end != last || !std::isfinite(value)) return std::nullopt;
	return value;
}

Quaternion quaternionOf(const mrpt::poses::CPose3D& pose)
{
	Quaternion q;
	pose.getAsQuaternion(q);
	return q;
}

mrpt::poses::CPose3D makePose(const Quaternion& q, double x, double y, double z)
{
	return mrpt::poses::CPose3D(q, x, y, z);
}

/** what(): why the line is not a stamped pose. */
StampedPose parseLine(const std::string& line)
{
	const auto columns = words(line);
	if (columns.size() != 8)
		throw InputError(
			std::to_string(columns.size()) + " columns where 8 are needed: t tx ty tz qx qy qz qw");
	const auto time = parseUnixTime(columns[0]);
	if (!time) throw InputError("'" + columns[0] + "' is not a time in seconds");

	std::array<double, 7> v{};
	for (std::size_t i = 0; i < v.size(); i++)
	{
		const auto value = parseNumber(columns[i + 1]);
		if (!value) throw InputError("'" + columns[i + 1] + "' is not a number");
		v[i] = *value;
	}
	const double norm = std::sqrt(v[3] * v[3] + v[4] * v[4] + v[5] * v[5] + v[6] * v[6]);
	if (!(std::abs(norm - 1) <= kUnitTolerance))
		throw InputError("quaternion of length " + std::to_string(norm) + ", not 1");
	const Quaternion q(v[6] / norm, v[3] / norm, v[4] / norm, v[5] / norm);
	return {*time, makePose(q, v[0], v[1], v[2])};
}

bool isCommentOrBlank(const std::string& line)
{
	const auto first = line.find_first_not_of(" \t\r");
	return first == std::string::npos || line[first] == '#';
}

double seconds(mrpt::Clock::duration d)
{
	return std::chrono::duration<double>(d).count();
}

}  // namespace

Trajectory readTumTrajectory(const std::string& path)
{
	std::ifstream in(path);
	if (!in) throw InputError(path + ": cannot be read: give a trajectory in TUM format");

	Trajectory trajectory;
	std::size_t lineNumber = 0;
	for (std::string line; std::getline(in, line);)
	{
		lineNumber++;
		if (isCommentOrBlank(line)) continue;
		const auto fail = [&](const std::string& why)
		{ throw InputError(path + ":" + std::to_string(lineNumber) + ": " + why); };
		try
		{
			trajectory.push_back(parseLine(line));
		}
		catch (const InputError& e)
		{
			fail(e.what());
		}
		if (trajectory.size() > 1 &&
			trajectory.back().time < trajectory[trajectory.size() - 2].time)
			fail("time goes backwards: sort the lines by time");
	}
	if (in.bad()) throw InputError(path + ": cannot be read to its end");
	return trajectory;
}

void writeTumTrajectory(const std::string& path, const Trajectory& trajectory)
{
	std::ofstream out(path);
	for (const StampedPose& stamped : trajectory)
	{
		const auto& p = stamped.pose;
		const Quaternion q = quaternionOf(p);
		char numbers[200];
		std::snprintf(
			numbers, sizeof(numbers), " %.9f %.9f %.9f %.9f %.9f %.9f %.9f\n", p.x(), p.y(), p.z(),
			q.x(), q.y(), q.z(), q.r());
		out << formatUnixTime(stamped.time) << numbers;
	}
	out.close();
	if (!out)
		throw InputError(path + ": cannot be written: check that the folder exists and has space");
}

std::optional<mrpt::poses::CPose3D> interpolate(
	const Trajectory& trajectory, mrpt::Clock::time_point t, double maxGap)
{
	const auto after = std::lower_bound(
		trajectory.begin(), trajectory.end(), t,
		[](const StampedPose& s, mrpt::Clock::time_point time) { return s.time < time; });
	if (after == trajectory.end()) return std::nullopt;
	if (after->time == t) return after->pose;
	if (after == trajectory.begin()) return std::nullopt;

	const auto before = std::prev(after);
	const double gap = seconds(after->time - before->time);
	if (gap > maxGap) return std::nullopt;

	const double s = seconds(t - before->time) / gap;
	Quaternion q;
	mrpt::math::slerp(quaternionOf(before->pose), quaternionOf(after->pose), s, q);
	q.normalize();
	const auto& a = before->pose;
	const auto& b = after->pose;
	return makePose(
		q, a.x() + s * (b.x() - a.x()), a.y() + s * (b.y() - a.y()), a.z() + s * (b.z() - a.z()));
}

}  // namespace semloop

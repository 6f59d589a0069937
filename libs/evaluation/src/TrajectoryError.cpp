#include <mrpt/math/CMatrixFixed.h>
#include <semloop/config/Error.h>
#include <semloop/evaluation/TrajectoryError.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <tuple>

namespace semloop
{
namespace
{
constexpr std::size_t kMinimumPairs = 3;

double seconds(mrpt::Clock::duration d)
{
	return std::chrono::duration<double>(d).count();
}

void requireEnoughPairs(const std::vector<PosePair>& pairs)
{
	if (pairs.size() < kMinimumPairs)
		throw InputError(
			"only " + std::to_string(pairs.size()) + " poses have a true one near in time and " +
			std::to_string(kMinimumPairs) +
			" are needed: check that both trajectories use one clock");
}

/** Two poses, one of each trajectory, that lie close enough in time. */
struct Candidate
{
	mrpt::Clock::duration difference;
	std::size_t estimate;
	std::size_t truth;
};

std::vector<Candidate> candidates(
	const Trajectory& estimate, const Trajectory& truth, double maxTimeDifference)
{
	std::vector<Candidate> result;
	std::size_t first = 0;  // both are in order of time
	for (std::size_t i = 0; i < estimate.size(); i++)
	{
		const auto time = estimate[i].time;
		while (first < truth.size() && seconds(time - truth[first].time) > maxTimeDifference)
			first++;
		for (std::size_t j = first; j < truth.size(); j++)
		{
			if (seconds(truth[j].time - time) > maxTimeDifference) break;
			result.push_back({std::chrono::abs(truth[j].time - time), i, j});
		}
	}
	return result;
}

mrpt::poses::CPose3D alignPositions(const std::vector<PosePair>& pairs)
{
	Eigen::Matrix3Xd source(3, pairs.size());
	Eigen::Matrix3Xd target(3, pairs.size());
	for (std::size_t i = 0; i < pairs.size(); i++)
	{
		const auto& p = pairs[i].estimate;
		const auto& q = pairs[i].truth;
		source.col(i) << p.x(), p.y(), p.z();
		target.col(i) << q.x(), q.y(), q.z();
	}
	const Eigen::Matrix4d T = Eigen::umeyama(source, target, /*with_scaling=*/false);
	return mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(T));
}

/** How far along the trajectory every pair is, in the unit. */
std::vector<double> positionsAlong(const std::vector<PosePair>& pairs, IntervalUnit unit)
{
	std::vector<double> along;
	for (std::size_t i = 0; i < pairs.size(); i++)
	{
		if (unit == IntervalUnit::Seconds)
			along.push_back(pairs[i].time);
		else
			along.push_back(
				i == 0 ? 0.0 : along.back() + pairs[i].estimate.distanceTo(pairs[i - 1].estimate));
	}
	return along;
}

/** Index of the value nearest to x in a sorted, non-empty list; the first of equals. */
std::size_t nearestIndex(const std::vector<double>& sorted, double x)
{
	const auto after = std::lower_bound(sorted.begin(), sorted.end(), x);
	if (after == sorted.begin()) return 0;
	const bool before = after == sorted.end() || x - *(after - 1) <= *after - x;
	return std::size_t(after - sorted.begin()) - (before ? 1 : 0);
}

/** atan2 keeps its precision near 0, where acos of the trace loses half of the digits. */
double rotationAngle(const mrpt::poses::CPose3D& pose)
{
	const auto& m = pose.getRotationMatrix();
	const double sine = std::hypot(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1));
	return std::atan2(sine, m(0, 0) + m(1, 1) + m(2, 2) - 1);
}
}  // namespace

std::vector<PosePair> associateByTime(
	const Trajectory& estimate, const Trajectory& truth, double maxTimeDifference)
{
	auto all = candidates(estimate, truth, maxTimeDifference);
	std::sort(
		all.begin(), all.end(),
		[](const Candidate& a, const Candidate& b)
		{
			return std::tie(a.difference, a.estimate, a.truth) <
				   std::tie(b.difference, b.estimate, b.truth);
		});

	constexpr std::size_t kFree = std::size_t(-1);
	std::vector<std::size_t> partner(estimate.size(), kFree);
	std::vector<char> taken(truth.size(), 0);
	for (const auto& c : all)
	{
		if (partner[c.estimate] != kFree || taken[c.truth]) continue;
		partner[c.estimate] = c.truth;
		taken[c.truth] = 1;
	}

	std::vector<PosePair> pairs;
	mrpt::Clock::time_point start;
	for (std::size_t i = 0; i < estimate.size(); i++)
	{
		if (partner[i] == kFree) continue;
		if (pairs.empty()) start = estimate[i].time;
		pairs.push_back(
			{seconds(estimate[i].time - start), estimate[i].pose, truth[partner[i]].pose});
	}
	return pairs;
}

ErrorSummary summarizeErrors(std::vector<double> errors)
{
	ErrorSummary summary;
	summary.count = errors.size();
	if (errors.empty()) return summary;

	std::sort(errors.begin(), errors.end());
	double sum = 0;
	double sumOfSquares = 0;
	for (const double e : errors)
	{
		sum += e;
		sumOfSquares += e * e;
	}
	const std::size_t n = errors.size();
	summary.rmse = std::sqrt(sumOfSquares / double(n));
	summary.mean = sum / double(n);
	summary.median = (errors[(n - 1) / 2] + errors[n / 2]) / 2;
	summary.max = errors.back();
	return summary;
}

AbsoluteTrajectoryError absoluteTrajectoryError(
	const std::vector<PosePair>& pairs, TrajectoryAlignment alignment)
{
	requireEnoughPairs(pairs);
	AbsoluteTrajectoryError result;
	if (alignment == TrajectoryAlignment::Se3) result.T_truth_estimate = alignPositions(pairs);
	for (const auto& pair : pairs)
	{
		const auto aligned = result.T_truth_estimate + pair.estimate;
		result.errors.push_back(aligned.distanceTo(pair.truth));
	}
	result.translation = summarizeErrors(result.errors);
	return result;
}

RelativePoseError relativePoseError(
	const std::vector<PosePair>& pairs, double interval, IntervalUnit unit)
{
	requireEnoughPairs(pairs);
	if (!(interval > 0) || !std::isfinite(interval))
		throw UsageError(
			"interval of the relative pose error " + std::to_string(interval) +
			": not allowed; use a positive number");

	const auto along = positionsAlong(pairs, unit);
	std::vector<double> translations;
	std::vector<double> rotations;
	for (std::size_t i = 0; i < pairs.size(); i++)
	{
		// As the benchmark's script, which cannot tell "at the last pose" from "beyond it".
		const std::size_t j = nearestIndex(along, along[i] + interval);
		if (j + 1 == pairs.size()) continue;
		const auto& a = pairs[i];
		const auto& b = pairs[j];
		const auto error = (a.truth - b.truth) - (a.estimate - b.estimate);
		translations.push_back(error.norm());
		rotations.push_back(rotationAngle(error));
	}
	RelativePoseError result;
	result.interval = interval;
	result.unit = unit;
	result.translation = summarizeErrors(std::move(translations));
	result.rotation = summarizeErrors(std::move(rotations));
	return result;
}

}  // namespace semloop

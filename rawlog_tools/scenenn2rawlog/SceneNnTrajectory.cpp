#include "SceneNnTrajectory.h"

#include <semloop/config/Error.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include "SceneNnWorld.h"

namespace semloop
{
namespace
{
constexpr double kRotationTolerance = 0.01;  // files have six digits
constexpr int64_t kMostFrames = 1000000;     // nine hours at 30 Hz: beyond is a broken number

/** Lines with something in them, cut into words. */
class Lines
{
public:
	explicit Lines(const std::string& path) : path_(path), in_(path)
	{
		if (!in_) throw InputError(path + ": cannot be read; does it exist?");
	}

	/** False at the end. */
	bool next()
	{
		words_.clear();
		for (std::string line; words_.empty() && std::getline(in_, line);)
		{
			number_++;
			std::istringstream words(line);
			for (std::string word; words >> word;) words_.push_back(word);
		}
		return !words_.empty();
	}

	template <typename Number>
	std::vector<Number> numbers(std::size_t count, const std::string& what) const
	{
		if (words_.size() != count)
			fail(
				std::to_string(words_.size()) + " words where " + what + " of " +
				std::to_string(count) + " numbers is needed");
		std::vector<Number> result;
		for (const std::string& word : words_)
		{
			Number value{};
			const char* const last = word.data() + word.size();
			const auto [end, error] = std::from_chars(word.data(), last, value);
			if (error != std::errc() || end != last || !std::isfinite(double(value)))
				fail("'" + word + "' is not a number for " + what);
			result.push_back(value);
		}
		return result;
	}

	[[noreturn]] void fail(const std::string& why) const
	{
		throw InputError(
			path_ + ":" + std::to_string(number_) + ": " + why +
			"; give SceneNN's trajectory.log as it was published");
	}

private:
	const std::string path_;
	std::ifstream in_;
	std::size_t number_ = 0;
	std::vector<std::string> words_;
};

std::size_t readFrameNumber(const Lines& lines, std::size_t least)
{
	const auto index = lines.numbers<int64_t>(3, "an index line 'i i i+1'");
	if (index[1] != index[0] || index[2] != index[0] + 1) lines.fail("not an index line 'i i i+1'");
	if (index[0] < int64_t(least) || index[0] >= kMostFrames)
		lines.fail(
			"frame " + std::to_string(index[0]) + " where " + std::to_string(least) +
			" or later is due");
	return std::size_t(index[0]);
}

Eigen::Matrix4d readMatrix(Lines& lines)
{
	Eigen::Matrix4d matrix;
	for (int row = 0; row < 4; row++)
	{
		if (!lines.next()) lines.fail("ends inside a matrix");
		const auto numbers = lines.numbers<double>(4, "a matrix row");
		for (int column = 0; column < 4; column++) matrix(row, column) = numbers[column];
	}
	return matrix;
}

/** Empty for a lost camera. */
std::optional<mrpt::poses::CPose3D> poseOf(const Eigen::Matrix4d& matrix, const Lines& lines)
{
	const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
	if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
		lines.fail("the matrix is no rigid motion: its last row is not 0 0 0 1");
	if (R.isZero(0)) return std::nullopt;
	const double error = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
	if (!(error <= kRotationTolerance) || R.determinant() < 0)
		lines.fail("the matrix above is no rigid motion: its upper left 3x3 is no rotation");
	const Eigen::Quaterniond q = Eigen::Quaterniond(R).normalized();
	const mrpt::math::CQuaternionDouble rotation(q.w(), q.x(), q.y(), q.z());
	return worldFromSceneNn() +
		   mrpt::poses::CPose3D(rotation, matrix(0, 3), matrix(1, 3), matrix(2, 3));
}

}  // namespace

SceneNnTrajectory readSceneNnTrajectory(const std::string& path)
{
	Lines lines(path);
	SceneNnTrajectory trajectory;
	while (lines.next())
	{
		const std::size_t frame = readFrameNumber(lines, trajectory.poses.size());
		const Eigen::Matrix4d matrix = readMatrix(lines);
		trajectory.poses.resize(frame);
		trajectory.poses.push_back(poseOf(matrix, lines));
	}
	const auto known = [](const auto& pose) { return pose.has_value(); };
	if (std::none_of(trajectory.poses.begin(), trajectory.poses.end(), known))
		throw InputError(path + ": has no pose; give SceneNN's trajectory.log of this recording");
	return trajectory;
}

}  // namespace semloop

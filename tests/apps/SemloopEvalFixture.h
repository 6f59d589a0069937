#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/RawlogWriter.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "TemporaryFolder.h"

namespace semloop
{
struct Outcome
{
	int exitCode = -1;
	std::string output;
	std::string errors;
};

/** Runs semloop-eval on files in a folder of its own. */
class SemloopEval : public ::testing::Test
{
protected:
	std::string path(const std::string& name) const { return folder_.file(name); }

	std::string write(const std::string& name, const std::string& content) const
	{
		return folder_.write(name, content);
	}

	Outcome run(const std::string& arguments) const
	{
		const std::string command = SEMLOOP_BINARY_DIR "/bin/semloop-eval " + arguments + " >" +
									path("stdout") + " 2>" + path("stderr");
		const int status = std::system(command.c_str());
		return {
			WIFEXITED(status) ? WEXITSTATUS(status) : -1, readBytes(path("stdout")),
			readBytes(path("stderr"))};
	}

	/** Runs with --json, which must succeed. */
	nlohmann::json json(const std::string& arguments) const
	{
		const auto result = run(arguments + " --json");
		EXPECT_EQ(result.exitCode, 0) << result.errors;
		return nlohmann::json::parse(result.output, nullptr, /*allow_exceptions=*/false);
	}

	/** The arguments are of no use: one line that says all of this, and this exit code. */
	void expectError(
		const std::string& arguments, int exitCode, const std::vector<std::string>& says) const
	{
		const auto result = run(arguments);
		EXPECT_EQ(result.exitCode, exitCode) << arguments;
		EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1)
			<< arguments << ": " << result.errors;
		for (const auto& text : says) EXPECT_THAT(result.errors, ::testing::HasSubstr(text));
		EXPECT_EQ(result.output, "") << arguments;
	}

private:
	TemporaryFolder folder_;
};

/** Four corners of a unit square, a second apart, lifted by z and shifted by dx. */
inline std::string square(double dx, double z)
{
	const std::array<std::array<double, 2>, 4> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
	std::ostringstream out;
	out << "# t tx ty tz qx qy qz qw\n";
	for (std::size_t i = 0; i < corners.size(); i++)
		out << 100 + i << " " << corners[i][0] + dx << " " << corners[i][1] << " " << z
			<< " 0 0 0 1\n";
	return out.str();
}

/** Real objects 1, 2, ... in boxes of 10 x 10 pixels beside each other; one frame a second from 100 on. */
inline std::string writeTrueInstances(
	const std::string& rawlog, const std::vector<std::vector<uint32_t>>& objectsOfFrames,
	double start = 100)
{
	RawlogWriter writer(rawlog);
	for (std::size_t i = 0; i < objectsOfFrames.size(); i++)
	{
		CObservationInstances frame;
		frame.timestamp = mrpt::Clock::fromDouble(start + double(i));
		frame.camera.ncols = 200;
		frame.camera.nrows = 20;
		frame.labels = LabelSet({"cup"});
		for (const uint32_t object : objectsOfFrames[i])
		{
			Instance instance;
			instance.box = {20 * int(object), 0, 10, 10};
			instance.mask = InstanceMask::encode(
				cv::Mat(10, 10, CV_8UC1, cv::Scalar(1)), instance.box.tl(), frame.imageSize());
			instance.labelScores = {{0, 1.0f}};
			instance.trueObject = object;
			frame.instances.push_back(instance);
		}
		writer.write(frame);
	}
	writer.close();
	return rawlog;
}

/** A detection of real object i in frame f as a line of associations.csv. */
inline std::string associationLine(int frame, int trueObject, int object, int firstObject)
{
	std::ostringstream out;
	out << 100 + frame << ".000000," << frame << ",0," << 20 * trueObject << ",0,10,10," << object
		<< "," << firstObject << "\n";
	return out.str();
}

const char* const kAssociationHeading = "time,frame,instance,x,y,w,h,object,first_object\n";

}  // namespace semloop

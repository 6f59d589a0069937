#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/observations/RawlogReader.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "TemporaryFolder.h"

namespace semloop
{
/** The observations of one class in a rawlog. */
template <class Observation>
std::vector<std::shared_ptr<Observation>> readAll(const std::string& path)
{
	RawlogReader reader(path);
	std::vector<std::shared_ptr<Observation>> all;
	while (const auto observation = reader.next())
		if (auto one = std::dynamic_pointer_cast<Observation>(observation)) all.push_back(one);
	return all;
}

/** rawlog-simulate in a folder with a small scene, den.ini: a room with a desk, a book and a box, 2 s. */
class RawlogSimulate : public testing::Test
{
protected:
	static constexpr const char* kProgram = SEMLOOP_BINARY_DIR "/bin/rawlog-simulate";

	void SetUp() override
	{
		folder_.write("models.ini", kModels);
		scene_ = folder_.write("den.ini", kScene);
		if (runWith("--help") != 0) GTEST_SKIP() << "built without simulation";
		if (!std::filesystem::exists("/usr/share/sweethome3d/furniture"))
			GTEST_SKIP() << "sweethome3d-furniture is not installed";
	}

	/** Exit code; what was printed is in out_ and err_. */
	int run(const std::string& options = "", const std::string& rawlog = "x.rawlog")
	{
		return runWith("'" + scene_ + "' '" + folder_.file(rawlog) + "' " + options);
	}
	int runWith(const std::string& arguments)
	{
		const std::string command = "'" + std::string(kProgram) + "' " + arguments + " > '" +
									folder_.file("out") + "' 2> '" + folder_.file("err") + "'";
		const int status = std::system(command.c_str());
		out_ = readBytes(folder_.file("out"));
		err_ = readBytes(folder_.file("err"));
		return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
	}

	/** That code and one line that says all this. */
	void expectFailure(int code, int expected, const std::vector<std::string>& saying)
	{
		EXPECT_EQ(code, expected) << err_;
		EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
		for (const auto& words : saying) EXPECT_THAT(err_, testing::HasSubstr(words));
	}
	/** Runs the scene with some text replaced. */
	void expectFailureOf(
		const std::string& from, const std::string& to, int expected,
		const std::vector<std::string>& saying)
	{
		folder_.write("den.ini", replaced(kScene, from, to));
		folder_.write("models.ini", replaced(kModels, from, to));
		expectFailure(run(), expected, saying);
	}

	/** Content of every file of a run, by its name behind the prefix. */
	std::map<std::string, std::string> filesOf(const std::string& prefix) const
	{
		std::map<std::string, std::string> files;
		for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path()))
		{
			const auto name = entry.path().lexically_relative(folder_.path()).string();
			if (entry.is_regular_file() && name.rfind(prefix, 0) == 0)
				files[name.substr(prefix.size())] = readBytes(entry.path().string());
		}
		return files;
	}

	static std::string replaced(std::string text, const std::string& from, const std::string& to)
	{
		const auto at = text.find(from);
		return at == std::string::npos ? text : text.replace(at, from.size(), to);
	}

	static constexpr const char* kModels =
		"[desk]\nlabel = desk\nmodels = Scopia#wooden_table_office\nplace = wall\n"
		"[book]\nlabel = book\nmodels = primitive:book\nplace = top\n"
		"[box]\nlabel = box\nmodels = primitive:box\nplace = floor\n";
	static constexpr const char* kScene =
		"[room.den]\ncorner = 0, 0\nsize = 4, 3\nfurniture = desk + book, box\n"
		"[path]\nwaypoints = 0.5 0.6, 1.3 0.6\n"
		"[camera]\nwidth = 160\nheight = 120\nrate = 5\n";

	const TemporaryFolder folder_;
	std::string scene_, out_, err_;
};
}  // namespace semloop

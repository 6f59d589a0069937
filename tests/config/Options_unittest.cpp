#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFile.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <semloop/config/Error.h>
#include <semloop/config/Options.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

using mrpt::config::CConfigFileMemory;
using namespace semloop;
using testing::HasSubstr;

namespace
{
struct ExampleOptions : Options
{
	bool enabled = true;
	int count = 3;
	double share = 0.5;
	double angle = 0.0;  // [rad]
	std::string name = "none";
	std::string mode = "fast";
	std::vector<std::string> plugins;

protected:
	void describe(OptionFields& f) override
	{
		f.flag("enabled", enabled, "whether");
		f.integer("count", count, 1, 10, "how many");
		f.number("share", share, 0, 1, "how much");
		f.degrees("angle_deg", angle, -180, 180, "how far round");
		f.text("name", name, "who");
		f.choice("mode", mode, {"fast", "good"}, "how");
		f.list("plugins", plugins, "what else");
	}
};

std::string errorOf(const std::string& ini)
{
	ExampleOptions options;
	try
	{
		options.loadFromConfigFile(CConfigFileMemory(ini), "example");
	}
	catch (const UsageError& e)
	{
		return e.what();
	}
	return "";
}
}  // namespace

TEST(Options, LoadingReadsEveryKindOfValue)
{
	ExampleOptions o;
	o.loadFromConfigFile(
		CConfigFileMemory(std::string(
			"[example]\nenabled = false ; a comment\ncount = 7\nshare = 0.25\nangle_deg = 90\n"
			"name = a b\nmode = good\nplugins = /x.so, /y.so\n")),
		"example");
	EXPECT_FALSE(o.enabled);
	EXPECT_EQ(o.count, 7);
	EXPECT_DOUBLE_EQ(o.share, 0.25);
	EXPECT_NEAR(o.angle, std::acos(0.0), 1e-12);
	EXPECT_EQ(o.name, "a b");
	EXPECT_EQ(o.mode, "good");
	EXPECT_EQ(o.plugins, (std::vector<std::string>{"/x.so", "/y.so"}));
}

TEST(Options, AMissingKeyOrSectionKeepsTheDefault)
{
	ExampleOptions o;
	o.loadFromConfigFile(CConfigFileMemory(std::string("[other]\nx = 1\n")), "example");
	EXPECT_EQ(o.count, 3);
	EXPECT_DOUBLE_EQ(o.share, 0.5);
}

TEST(Options, AnUnknownKeyIsRefusedWithTheKnownOnes)
{
	const auto error = errorOf("[example]\ncuont = 7\n");
	EXPECT_THAT(error, HasSubstr("[example] cuont"));
	EXPECT_THAT(error, HasSubstr("count"));
}

TEST(Options, AValueOutOfRangeIsRefusedWithTheRange)
{
	EXPECT_THAT(errorOf("[example]\ncount = 11\n"), HasSubstr("integer in [1, 10]"));
	EXPECT_THAT(errorOf("[example]\nshare = -0.1\n"), HasSubstr("number in [0, 1]"));
	EXPECT_THAT(errorOf("[example]\nangle_deg = 181\n"), HasSubstr("number in [-180, 180]"));
}

TEST(Options, AValueOfTheWrongTypeIsRefused)
{
	EXPECT_THAT(errorOf("[example]\ncount = 2.5\n"), HasSubstr("count = 2.5"));
	EXPECT_THAT(errorOf("[example]\nshare = nan\n"), HasSubstr("share = nan"));
	EXPECT_THAT(errorOf("[example]\nshare = 0.5m\n"), HasSubstr("share = 0.5m"));
	EXPECT_THAT(errorOf("[example]\nshare =\n"), HasSubstr("share"));
	EXPECT_THAT(errorOf("[example]\nenabled = maybe\n"), HasSubstr("true, false"));
	EXPECT_THAT(errorOf("[example]\nmode = slow\n"), HasSubstr("fast, good"));
}

TEST(Options, AnErrorNamesTheFile)
{
	const std::string path = testing::TempDir() + "options_unittest.ini";
	std::ofstream(path) << "[example]\ncount = many\n";
	ExampleOptions o;
	try
	{
		o.loadFromConfigFile(mrpt::config::CConfigFile(path), "example");
		FAIL() << "accepted";
	}
	catch (const UsageError& e)
	{
		EXPECT_THAT(e.what(), HasSubstr(path));
	}
	std::remove(path.c_str());
}

TEST(Options, WhatIsSavedLoadsAgain)
{
	ExampleOptions saved;
	saved.count = 9;
	saved.angle = 1.0;
	saved.mode = "good";
	saved.plugins = {"a", "b"};
	CConfigFileMemory file;
	saved.saveToConfigFile(file, "example");
	ExampleOptions loaded;
	loaded.loadFromConfigFile(file, "example");
	EXPECT_EQ(loaded.count, 9);
	EXPECT_NEAR(loaded.angle, 1.0, 1e-9);
	EXPECT_EQ(loaded.mode, "good");
	EXPECT_EQ(loaded.plugins, saved.plugins);
}

TEST(Options, TheManualHasARowForEveryKey)
{
	const auto table = ExampleOptions().markdownTable();
	EXPECT_THAT(table, HasSubstr("| `share` | `0.5` | number in [0, 1] | how much |"));
	EXPECT_THAT(table, HasSubstr("| `angle_deg` | `0` | number in [-180, 180] | how far round |"));
}

TEST(Options, AnUnknownSectionIsRefused)
{
	const CConfigFileMemory file(std::string("[example]\ncount = 1\n[exmaple]\ncount = 2\n"));
	EXPECT_NO_THROW(requireKnownSections(file, {"example", "exmaple"}));
	EXPECT_THROW(requireKnownSections(file, {"example"}), UsageError);
}

TEST(Options, AKeyOutsideAnySectionIsRefused)
{
	const CConfigFileMemory file(std::string("count = 1\n[example]\ncount = 2\n"));
	EXPECT_THROW(requireKnownSections(file, {"example"}), UsageError);
}

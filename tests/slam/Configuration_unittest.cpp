#include <gtest/gtest.h>
#include <mrpt/config/CConfigFile.h>
#include <semloop/slam/Configuration.h>
#include <semloop/slam/SemanticSlam.h>

#include <filesystem>

#include "TemporaryFolder.h"

using namespace semloop;

namespace
{
const std::filesystem::path root = SEMLOOP_SOURCE_DIR;
}

TEST(Configuration, TheManualIsWhatTheProgramPrints)
{
	// Remake it with: semloop-slam --help-config > doc/configuration.md
	EXPECT_EQ(readBytes((root / "doc/configuration.md").string()), configurationReference());
}

TEST(Configuration, EverySectionOfTheReferenceIsKnown)
{
	const std::string page = configurationReference();
	for (const auto& section : configurationSections())
		EXPECT_NE(page.find("### `[" + section + "]`"), std::string::npos) << section;
}

TEST(Configuration, EveryExampleConfigurationMakesItsModules)
{
	int count = 0;
	for (const auto& entry : std::filesystem::directory_iterator(root / "config_ini"))
	{
		if (entry.path().extension() != ".ini") continue;
		++count;
		SCOPED_TRACE(entry.path());
		const mrpt::config::CConfigFile config(entry.path().string());
		StageTimings timings;
		mrpt::system::COutputLogger logger;
		EXPECT_NO_THROW(SemanticSlam(config, logger, timings));
	}
	EXPECT_GE(count, 2);
}

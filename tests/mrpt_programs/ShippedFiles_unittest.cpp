#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

/** MRPT takes what stands behind a text for a part of it: "name = x  ; why" is the text "x  ; why". */
TEST(ShippedFiles, HaveNoCommentsBehindTexts)
{
	const std::regex numberOrFlag(R"([-+0-9.eE]+|true|false)");
	const std::regex commented(R"(\s*([^;=]+?)\s*=\s*(.*?)\s+;.*)");
	int lines = 0;
	for (const auto& entry :
		 std::filesystem::directory_iterator(SEMLOOP_SOURCE_DIR "/config_ini/mrpt"))
	{
		std::ifstream file(entry.path());
		for (std::string line; std::getline(file, line);)
		{
			std::smatch match;
			if (!std::regex_match(line, match, commented)) continue;
			++lines;
			EXPECT_TRUE(std::regex_match(match[2].str(), numberOrFlag))
				<< entry.path() << ": " << line;
		}
	}
	EXPECT_GT(lines, 5);
}

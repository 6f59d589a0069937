#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace
{
namespace fs = std::filesystem;
using Names = std::set<std::string>;

const fs::path kSource = SEMLOOP_SOURCE_DIR;

std::vector<std::string> linesOf(const fs::path& file)
{
	std::ifstream in(file);
	std::vector<std::string> lines;
	for (std::string line; std::getline(in, line);) lines.push_back(line);
	return lines;
}

std::vector<std::string> split(const std::string& text, char separator)
{
	std::vector<std::string> parts;
	std::istringstream in(text);
	for (std::string part; std::getline(in, part, separator);)
	{
		part.erase(0, part.find_first_not_of(' '));
		part.erase(part.find_last_not_of(' ') + 1);
		if (!part.empty()) parts.push_back(part);
	}
	return parts;
}

/** The rows of the table "| library | layer | may use | ..." in doc/architecture.md: library ->
 *  libraries in its third cell, in the table's order. */
std::vector<std::pair<std::string, std::vector<std::string>>> layerTable()
{
	std::vector<std::pair<std::string, std::vector<std::string>>> rows;
	const std::regex row(R"(\| ([a-z_]+) \| L\d \|([^|]*)\|.*)");
	for (const auto& line : linesOf(kSource / "doc/architecture.md"))
		if (std::smatch match; std::regex_match(line, match, row))
			rows.emplace_back(match[1], split(match[2], ','));
	return rows;
}

/** What a library may include: itself, its row, and what those may include. */
std::map<std::string, Names> allowedIncludes()
{
	std::map<std::string, Names> allowed;
	for (const auto& [library, uses] : layerTable())
	{
		Names& names = allowed[library];
		names.insert(library);
		for (const auto& used : uses)
			if (const auto lower = allowed.find(used); lower != allowed.end() && used != library)
				names.insert(lower->second.begin(), lower->second.end());
	}
	return allowed;
}

Names libraryFolders()
{
	Names names;
	for (const auto& entry : fs::directory_iterator(kSource / "libs"))
		if (entry.is_directory()) names.insert(entry.path().filename());
	return names;
}

/** Calls visit(place, path in <> or "") for every #include of C++ files under a folder. */
template <class Visit>
void forEachInclude(const fs::path& folder, const Visit& visit)
{
	const std::regex include(R"(\s*#\s*include\s*[<"]([^>"]+)[>"].*)");
	for (const auto& entry : fs::recursive_directory_iterator(folder))
	{
		const auto extension = entry.path().extension();
		if (extension != ".h" && extension != ".cpp") continue;
		const auto lines = linesOf(entry.path());
		for (std::size_t i = 0; i < lines.size(); ++i)
			if (std::smatch match; std::regex_match(lines[i], match, include))
				visit(
					fs::relative(entry.path(), kSource).string() + ":" + std::to_string(i + 1),
					match[1].str());
	}
}

TEST(Layers, TheTableNamesEveryLibraryAndOnlyRowsAbove)
{
	Names above;
	for (const auto& [library, uses] : layerTable())
	{
		for (const auto& used : uses)
			EXPECT_TRUE(above.count(used)) << library << " uses " << used << ", not a row above it";
		EXPECT_TRUE(above.insert(library).second) << library << " has two rows";
	}
	EXPECT_EQ(above, libraryFolders());
}

TEST(Layers, LibrariesIncludeOnlyWhatTheTableAllows)
{
	const auto allowed = allowedIncludes();
	std::size_t checked = 0;
	for (const auto& library : libraryFolders())
	{
		ASSERT_TRUE(allowed.count(library)) << library << " is not in doc/architecture.md";
		forEachInclude(
			kSource / "libs" / library,
			[&](const std::string& place, const std::string& path)
			{
				if (path.rfind("semloop/", 0) != 0) return;
				const auto parts = split(path, '/');
				ASSERT_GE(parts.size(), 3u) << place;
				EXPECT_TRUE(allowed.at(library).count(parts[1]))
					<< place << ": " << library << " must not use " << parts[1];
				++checked;
			});
	}
	EXPECT_GT(checked, 50u) << "the includes were not found";
}

TEST(Layers, LibrariesDoNotReachIntoAnotherLibrarysSources)
{
	forEachInclude(
		kSource / "libs", [](const std::string& place, const std::string& path)
		{ EXPECT_EQ(path.find("../"), std::string::npos) << place << ": " << path; });
}

TEST(Layers, PublicHeadersKeepHeavyLibrariesOut)
{
	const std::regex heavy(R"((pcl|ceres|Spectra|nlohmann|embree\d?|openni2?)/.*|)"
						   R"(opencv2/(dnn|rgbd|opencv|features2d|calib3d).*|OpenNI\.h|rtcore\.h)");
	for (const auto& library : libraryFolders())
		forEachInclude(
			kSource / "libs" / library / "include",
			[&](const std::string& place, const std::string& path)
			{
				EXPECT_FALSE(std::regex_match(path, heavy))
					<< place << ": " << path << " belongs into a .cpp file";
			});
}
}  // namespace

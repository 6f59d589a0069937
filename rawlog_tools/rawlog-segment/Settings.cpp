#include "Settings.h"

#include <mrpt/config/CConfigFileMemory.h>
#include <semloop/config/Error.h>
#include <semloop/segmentation/ColorHistogramEmbedder.h>
#include <semloop/segmentation/DnnEmbedder.h>
#include <semloop/segmentation/DnnSegmenter.h>

#include <array>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace semloop
{
namespace
{
using nlohmann::json;

const char* const kSegmentation = "segmentation";
const char* const kEmbedding = "embedding";

/** Of the 64-bit hash FNV-1a (Fowler, Noll, Vo), as 16 digits. */
std::string contentHash(const std::string& path)
{
	std::ifstream file(path, std::ios::binary);
	uint64_t hash = 14695981039346656037u;
	std::array<char, 1 << 16> block{};
	while (file.read(block.data(), block.size()) || file.gcount() > 0)
		for (std::streamsize i = 0; i < file.gcount(); i++)
			hash = (hash ^ static_cast<unsigned char>(block[std::size_t(i)])) * 1099511628211u;
	std::array<char, 17> digits{};
	std::snprintf(digits.data(), digits.size(), "%016" PRIx64, hash);
	return digits.data();
}

/** A file by its content: it may move. */
json fileIdentity(const std::string& path)
{
	return {
		{"name", std::filesystem::path(path).filename().string()},
		{"bytes", std::filesystem::file_size(path)},
		{"fnv1a", contentHash(path)}};
}

/** Options by key, files among them by their content. */
json optionValues(const Options& options, const std::vector<std::string>& fileKeys)
{
	std::ostringstream dump;
	options.dumpToTextStream(dump);
	std::istringstream lines(dump.str());
	json values = json::object();
	for (std::string line; std::getline(lines, line);)
	{
		const auto equals = line.find(" = ");
		values[line.substr(0, equals)] = line.substr(equals + 3);
	}
	for (const auto& key : fileKeys)
		if (const auto path = values[key].get<std::string>(); !path.empty())
			values[key] = fileIdentity(path);
	return values;
}

mrpt::config::CConfigFileMemory configFrom(const Arguments& arguments)
{
	mrpt::config::CConfigFileMemory config;
	const auto set = [&](const char* section, const char* key, const std::string& value)
	{
		if (!value.empty()) config.write(section, key, value);
	};
	set(kSegmentation, "model", arguments.model);
	set(kSegmentation, "model_config", arguments.modelConfig);
	set(kSegmentation, "labels", arguments.labels);
	set(kEmbedding, "model", arguments.embeddingModel);
	if (arguments.minScore >= 0)
		config.write(kSegmentation, "min_score", std::to_string(arguments.minScore));
	for (const auto& text : arguments.overrides)
	{
		const auto dot = text.find('.'), equals = text.find('=');
		if (dot == std::string::npos || equals == std::string::npos || dot > equals)
			throw UsageError("--set " + text + ": write it as section.key=value");
		config.write(
			text.substr(0, dot), text.substr(dot + 1, equals - dot - 1), text.substr(equals + 1));
	}
	requireKnownSections(config, {kSegmentation, kEmbedding});
	return config;
}

/** Loads the options, hands them to a new module and notes them in the settings. */
template <class Module, class ModuleOptions>
std::shared_ptr<Module> makeModule(
	const mrpt::config::CConfigFileBase& config, const std::string& section,
	const std::vector<std::string>& fileKeys, json& settings)
{
	ModuleOptions options;
	options.loadFromConfigFile(config, section);
	auto module = Module::Create();
	module->configure(options);
	settings[section] = optionValues(options, fileKeys);
	settings[section]["module"] = module->GetRuntimeClass()->className;
	return module;
}
}  // namespace

Networks loadNetworks(const Arguments& arguments)
{
	const auto config = configFrom(arguments);
	Networks networks;
	networks.settings = {
		{"format", "semloop.instances/1"},
		{"rawlog_bytes", std::filesystem::file_size(arguments.rawlog)},
		{"every", arguments.every},
		{"depth_crops", arguments.depthCrops}};
	networks.segmenter = makeModule<DnnSegmenter, DnnSegmenterOptions>(
		config, kSegmentation, {"model", "model_config", "labels"}, networks.settings);
	if (arguments.embeddingModel.empty())
		networks.embedder = makeModule<ColorHistogramEmbedder, ColorHistogramEmbedderOptions>(
			config, kEmbedding, {}, networks.settings);
	else
		networks.embedder = makeModule<DnnEmbedder, DnnEmbedderOptions>(
			config, kEmbedding, {"model"}, networks.settings);
	return networks;
}

}  // namespace semloop

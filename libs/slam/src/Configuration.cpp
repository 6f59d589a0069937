#include <semloop/association/InstanceTracker.h>
#include <semloop/association/NearestNeighbourAssociator.h>
#include <semloop/association/ObjectAssociator.h>
#include <semloop/config/ModuleFactory.h>
#include <semloop/loop_closure/AppearanceLoopDetector.h>
#include <semloop/loop_closure/CliqueMatcher.h>
#include <semloop/loop_closure/DescriptorMatchers.h>
#include <semloop/loop_closure/ObjectAligner.h>
#include <semloop/loop_closure/SemanticLoopDetector.h>
#include <semloop/loop_closure/SpectralMatcher.h>
#include <semloop/object_map/CObjectMap.h>
#include <semloop/odometry/OpenCvOdometry.h>
#include <semloop/odometry/RecordedOdometry.h>
#include <semloop/pose_graph/CeresPoseGraph.h>
#include <semloop/segmentation/ColorHistogramEmbedder.h>
#include <semloop/segmentation/DnnEmbedder.h>
#include <semloop/segmentation/DnnSegmenter.h>
#include <semloop/segmentation/RecordedSegmenter.h>
#include <semloop/slam/Configuration.h>
#include <semloop/slam/LiveOptions.h>
#include <semloop/slam/OtherMaps.h>
#include <semloop/slam/SemanticSlam.h>

namespace semloop
{
namespace
{
std::string modulePlace(const mrpt::config::CConfigFileBase& config, const char* key)
{
	return configFileName(config) + ": [modules] " + key;
}

template <class Module>
std::shared_ptr<Module> makeConfigured(
	const mrpt::config::CConfigFileBase& config, const std::string& className, const char* key,
	const char* section)
{
	const auto module = makeModule<Module>(className, modulePlace(config, key));
	module->configure(config, section);
	return module;
}

void requireSlamSections(const mrpt::config::CConfigFileBase& config)
{
	auto known = configurationSections();
	const auto maps = otherMapsSections(config);
	known.insert(known.end(), maps.begin(), maps.end());
	const auto sensors = sensorSections(config);
	known.insert(known.end(), sensors.begin(), sensors.end());
	requireKnownSections(config, known);
}

std::string table(const char* section, const std::string& what, const Options& options)
{
	return "\n### `[" + std::string(section) + "]` " + what + "\n\n" + options.markdownTable();
}
}  // namespace

const std::vector<std::string>& configurationSections()
{
	static const std::vector<std::string> sections = {
		"modules",
		"slam",
		"segmentation",
		"embedding",
		"odometry",
		"tracking",
		"matching_cost",
		"association",
		"frame_registration",
		"object_map",
		"object_map_maintenance",
		"local_map",
		"loop_detection",
		"graph_matching",
		"appearance",
		"alignment",
		"pose_graph",
		"semloop_map",
		"live"};
	return sections;
}

FrontEnd makeFrontEnd(const mrpt::config::CConfigFileBase& config)
{
	requireSlamSections(config);
	ModuleNames names;
	names.loadFromConfigFile(config, "modules");
	loadPlugins(names.plugins, modulePlace(config, "plugins"));

	FrontEnd frontEnd;
	frontEnd.segmenter =
		makeConfigured<Segmenter>(config, names.segmenter, "segmenter", "segmentation");
	if (!names.embedder.empty())
		frontEnd.embedder =
			makeConfigured<Embedder>(config, names.embedder, "embedder", "embedding");
	return frontEnd;
}

void SemanticSlam::makeModules(const mrpt::config::CConfigFileBase& config)
{
	requireSlamSections(config);
	modules_.loadFromConfigFile(config, "modules");
	options_.loadFromConfigFile(config, "slam");
	keyFrames_ = std::make_unique<KeyFrames>(
		options_.keyPoseDistance, options_.keyPoseAngle, std::size_t(options_.maxKeyPoses));
	loadPlugins(modules_.plugins, modulePlace(config, "plugins"));

	odometry_ = makeConfigured<Odometry>(config, modules_.odometry, "odometry", "odometry");
	poseGraph_ = makeConfigured<PoseGraph>(config, modules_.poseGraph, "pose_graph", "pose_graph");
	loopDetector_ = makeConfigured<LoopDetector>(
		config, modules_.loopDetector, "loop_detector", "loop_detection");
	const auto cost = makeConfigured<MatchingCost>(
		config, modules_.matchingCost, "matching_cost", "matching_cost");
	const auto associator =
		makeConfigured<Associator>(config, modules_.associator, "associator", "association");
	associator->setMatchingCost(cost);
	matchingCost_ = cost;

	InstanceTrackerOptions tracking;
	tracking.loadFromConfigFile(config, "tracking");
	FrameRegistrationOptions registration;
	registration.loadFromConfigFile(config, "frame_registration");
	tracker_ = std::make_unique<InstanceTracker>(tracking, cost, registration);
	mapper_ = std::make_unique<ObjectMapper>(map_, associator, timings_, registration);
	loopCloser_ = std::make_unique<LoopCloser>(map_, poseGraph_, loopDetector_, timings_);
}

void SemanticSlam::makeMap(const mrpt::config::CConfigFileBase& config)
{
	map_->insertionOptions.loadFromConfigFile(config, "object_map");
	map_->maintenanceOptions.loadFromConfigFile(config, "object_map_maintenance");
	LocalMapOptions local;
	local.loadFromConfigFile(config, "local_map");
	localMap_ = LocalMap(local);
}

std::string configurationReference()
{
	std::string page =
		"# Configuration\n\n"
		"An ini file in MRPT's syntax configures a run; `semloop-slam --set section.key=value`\n"
		"overrides single keys. A section or key that is missing keeps its default, one that is "
		"not in\n"
		"these tables is an error. Angles are in degrees and their keys say so.\n\n"
		"This page is printed by `semloop-slam --help-config`; a test compares the two.\n\n"
		"## Modules\n"
		"\nEach of these can be replaced by a class of a plug-in (doc/architecture.md).\n";
	page += table("modules", "which class does what", ModuleNames());
	page += table("slam", "what belongs to no single module", SlamOptions());
	page += "\n## Front end\n";
	page += table("segmentation", "of semloop::RecordedSegmenter", RecordedSegmenterOptions());
	page += table("segmentation", "of semloop::DnnSegmenter", DnnSegmenterOptions());
	page +=
		table("embedding", "of semloop::ColorHistogramEmbedder", ColorHistogramEmbedderOptions());
	page += table("embedding", "of semloop::DnnEmbedder", DnnEmbedderOptions());
	page += table("odometry", "of semloop::OpenCvOdometry", OpenCvOdometryOptions());
	page += table("odometry", "of semloop::RecordedOdometry", RecordedOdometryOptions());
	page += "\n## Mapping (Sec. III-B)\n";
	page += table("tracking", "multi-frame instance tracking", InstanceTrackerOptions());
	page += table(
		"matching_cost", "of semloop::SemanticMatchingCost, Eq. (3)",
		SemanticMatchingCostOptions());
	page +=
		table("association", "of semloop::ObjectAssociator, Eq. (1)", ObjectAssociatorOptions());
	page += table(
		"association", "of semloop::NearestNeighbourAssociator",
		NearestNeighbourAssociatorOptions());
	page += table(
		"frame_registration", "the camera's pose before association; not in the paper",
		FrameRegistrationOptions());
	page += table("object_map", "how objects are built", ObjectMapInsertionOptions());
	page += table(
		"object_map_maintenance", "when objects are dropped or united",
		ObjectMapMaintenanceOptions());
	page += table("local_map", "what counts as here and now", LocalMapOptions());
	page += "\n## Loop closure (Sec. III-C) and pose graph (Sec. III-D)\n";
	page +=
		table("loop_detection", "of semloop::SemanticLoopDetector", SemanticLoopDetectorOptions());
	page += table(
		"graph_matching",
		"of semloop::SpectralMatcher, when the matcher is spectral or spectral-verified, Eq. "
		"(4)-(6)",
		SpectralMatcherOptions());
	page += table(
		"graph_matching", "of semloop::CliqueMatcher, when the matcher is clique",
		CliqueMatcherOptions());
	page += table(
		"graph_matching", "of semloop::RandomWalkMatcher, when the matcher is random-walk",
		RandomWalkMatcherOptions());
	page += table(
		"appearance", "of semloop::BagOfWordsLoopDetector; semloop::OrbLoopDetector has no words",
		BagOfWordsLoopDetectorOptions());
	page += table("alignment", "of the matched objects' surfaces", ObjectAlignerOptions());
	page += table("pose_graph", "of semloop::CeresPoseGraph, Eq. (7)", CeresPoseGraphOptions());
	page +=
		"\n## Other maps\n"
		"\nMaps of MRPT or of a plug-in beside the object map, made at the end from the key frames "
		"at "
		"their\noptimised poses and written to `OUT/maps`. `<map>_count = N` in `[semloop_map]` "
		"asks for "
		"them, as in\nthe programs of MRPT, and `[semloop_map_<map>_NN_creationOpts]`, "
		"`[..._insertOpts]` and so on configure\neach (doc/mrpt-programs.md).\n";
	page +=
		"\n### `[semloop_map]` which other maps\n\n"
		"| key | default | allowed | meaning |\n| --- | --- | --- | --- |\n"
		"| `<map>_count` | `0` | integer in [0, 99] | how many maps of this class, for example "
		"`occupancyGrid_count` |\n";
	page +=
		"\n## Sensors\n"
		"\n`semloop-slam --live SECTION` grabs from the sensor of this section, which is written "
		"as "
		"for\nrawlog-grabber: `driver` is the sensor's class, the other keys are its own "
		"(config_ini/live_openni2.ini).\n";
	page +=
		table("live", "how a live run copes with what comes too fast or not at all", LiveOptions());
	return page;
}

}  // namespace semloop

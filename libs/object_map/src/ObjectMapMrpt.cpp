#include <mrpt/opengl/CBox.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CText.h>
#include <semloop/object_map/CObjectMap.h>
#include <semloop/object_map/MeshVisualization.h>

#include <sstream>

namespace semloop
{
MAP_DEFINITION_REGISTER("objectMap,semloop::CObjectMap", semloop::CObjectMap)

namespace
{
mrpt::opengl::CBox::Ptr frameOf(const mrpt::math::TBoundingBox& box)
{
	auto frame = mrpt::opengl::CBox::Create(box.min, box.max, true, 1.0f);
	frame->setColor_u8(mrpt::img::TColor(40, 110, 220));
	return frame;
}

mrpt::opengl::CText::Ptr nameAbove(const mrpt::math::TBoundingBox& box, const std::string& name)
{
	auto text = mrpt::opengl::CText::Create(name);
	text->setColor_u8(mrpt::img::TColor(20, 20, 20));
	const auto middle = (box.min + box.max) * 0.5;
	text->setLocation(middle.x, middle.y, box.max.z);
	return text;
}
}  // namespace

std::string CObjectMap::asString() const
{
	std::set<uint32_t> labels;
	std::size_t bytes = 0;
	for (const auto& [id, object] : objects_)
	{
		labels.insert(object.label());
		bytes += object.volume->memoryBytes();
	}
	std::ostringstream out;
	out << "CObjectMap: " << objects_.size() << " objects of " << labels.size() << " labels, "
		<< bytes / 1024 << " KiB";
	return out.str();
}

void CObjectMap::getVisualizationInto(mrpt::opengl::CSetOfObjects& out) const
{
	if (!genericMapParams.enableSaveAs3DObject) return;
	auto edges = mrpt::opengl::CSetOfLines::Create();
	edges->setName("co-visible");
	edges->setColor_u8(mrpt::img::TColor(90, 90, 90));
	for (const auto& [id, object] : objects_)
	{
		auto group = mrpt::opengl::CSetOfObjects::Create();
		group->setName(labelName(object) + " " + std::to_string(id));
		group->setPose(object.T_world_object);
		if (visualizationOptions.meshes) group->insert(trianglesOf(object.volume->mesh()));
		if (const auto box = object.volume->boundingBox())
		{
			if (visualizationOptions.boxes) group->insert(frameOf(*box));
			if (visualizationOptions.names) group->insert(nameAbove(*box, group->getName()));
		}
		out.insert(group);
		for (const auto& [other, times] : object.covisible)
			if (id < other)
			{
				const auto a = object.centre(), b = objects_.at(other).centre();
				edges->appendLine(a.x, a.y, a.z, b.x, b.y, b.z);
			}
	}
	if (!objects_.empty() && visualizationOptions.edges) out.insert(edges);
}

void ObjectMapVisualizationOptions::describe(OptionFields& fields)
{
	fields.flag("meshes", meshes, "the objects' surfaces");
	fields.flag("boxes", boxes, "boxes round the objects");
	fields.flag("names", names, "labels and ids of the objects");
	fields.flag("edges", edges, "lines between objects that were seen together");
}

CObjectMap::TMapDefinition::TMapDefinition() = default;

void CObjectMap::TMapDefinition::loadFromConfigFile_map_specific(
	const mrpt::config::CConfigFileBase& source, const std::string& sectionNamePrefix)
{
	insertOpts.loadFromConfigFile(source, sectionNamePrefix + "_insertOpts");
	likelihoodOpts.loadFromConfigFile(source, sectionNamePrefix + "_likelihoodOpts");
	maintenanceOpts.loadFromConfigFile(source, sectionNamePrefix + "_maintenanceOpts");
	visualizationOpts.loadFromConfigFile(source, sectionNamePrefix + "_visualizationOpts");
}

void CObjectMap::TMapDefinition::dumpToTextStream_map_specific(std::ostream& out) const
{
	insertOpts.dumpToTextStream(out);
	likelihoodOpts.dumpToTextStream(out);
	maintenanceOpts.dumpToTextStream(out);
	visualizationOpts.dumpToTextStream(out);
}

mrpt::maps::CMetricMap* CObjectMap::internal_CreateFromMapDefinition(
	const mrpt::maps::TMetricMapInitializer& def)
{
	const auto& definition = dynamic_cast<const TMapDefinition&>(def);
	auto* map = new CObjectMap();
	map->insertionOptions = definition.insertOpts;
	map->likelihoodOptions = definition.likelihoodOpts;
	map->maintenanceOptions = definition.maintenanceOpts;
	map->visualizationOptions = definition.visualizationOpts;
	return map;
}

}  // namespace semloop

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/containers/CDynamicGrid.h>
#include <mrpt/core/initializer.h>
#include <mrpt/maps/CMetricMap.h>
#include <mrpt/maps/TMetricMapInitializer.h>
#include <mrpt/maps/TMetricMapTypesRegistry.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <fstream>
#include <iostream>

namespace examples
{
/** How many measured points have been above each place of the floor. */
class CoverageMap : public mrpt::maps::CMetricMap
{
	DEFINE_SERIALIZABLE(CoverageMap, examples)

public:
	bool isEmpty() const override { return points_ == 0; }
	std::string asString() const override
	{
		return "coverage of " + std::to_string(points_) + " points";
	}

	/** filNamePrefix.pgm: a grey value a cell, north up, the brightest the most seen. */
	void saveMetricMapRepresentationToFile(const std::string& filNamePrefix) const override
	{
		uint32_t most = 1;
		for (const auto count : grid_) most = std::max(most, count);
		std::ofstream file(filNamePrefix + ".pgm", std::ios::binary);
		file << "P5\n" << grid_.getSizeX() << " " << grid_.getSizeY() << "\n255\n";
		for (std::size_t y = grid_.getSizeY(); y-- > 0;)
			for (std::size_t x = 0; x < grid_.getSizeX(); ++x)
				file.put(char(255 * uint64_t(*grid_.cellByIndex(x, y)) / most));
	}

	void getVisualizationInto(mrpt::opengl::CSetOfObjects&) const override {}

	/** [m] */
	double resolution() const { return grid_.getResolution(); }

protected:
	void internal_clear() override { setEmpty(grid_.getResolution()); }

	bool internal_insertObservation(
		const mrpt::obs::CObservation& observation,
		const std::optional<const mrpt::poses::CPose3D>& robotPose) override
	{
		const auto* scan = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation);
		if (!scan || !scan->hasPoints3D) return false;
		const auto T_map_sensor = robotPose.value_or(mrpt::poses::CPose3D()) + scan->sensorPose;
		for (std::size_t i = 0; i < scan->points3D_x.size(); ++i)
		{
			const auto p = T_map_sensor.composePoint(mrpt::math::TPoint3D(
				scan->points3D_x[i], scan->points3D_y[i], scan->points3D_z[i]));
			const double r = grid_.getResolution();
			grid_.resize(p.x - r, p.x + r, p.y - r, p.y + r, 0, 2.0);
			auto* const cell = grid_.cellByPos(p.x, p.y);
			if (!cell) continue;
			++*cell;
			++points_;
		}
		return !scan->points3D_x.empty();
	}

	double internal_computeObservationLikelihood(
		const mrpt::obs::CObservation&, const mrpt::poses::CPose3D&) const override
	{
		return 0;
	}
	bool internal_canComputeObservationLikelihood(const mrpt::obs::CObservation&) const override
	{
		return false;
	}

private:
	void setEmpty(double resolution)
	{
		const uint32_t none = 0;
		grid_.setSize(-1, 1, -1, 1, resolution, &none);
		points_ = 0;
	}

	mrpt::containers::CDynamicGrid<uint32_t> grid_{-1, 1, -1, 1, 0.1};
	uint64_t points_ = 0;

	MAP_DEFINITION_START(CoverageMap)
	double resolution = 0.1;  //!< [m]
	MAP_DEFINITION_END(CoverageMap)
};

MAP_DEFINITION_REGISTER("coverageMap,examples::CoverageMap", examples::CoverageMap)

CoverageMap::TMapDefinition::TMapDefinition() = default;

void CoverageMap::TMapDefinition::loadFromConfigFile_map_specific(
	const mrpt::config::CConfigFileBase& source, const std::string& sectionNamePrefix)
{
	resolution = source.read_double(sectionNamePrefix + "_creationOpts", "resolution", resolution);
}

void CoverageMap::TMapDefinition::dumpToTextStream_map_specific(std::ostream& out) const
{
	out << "resolution = " << resolution << " m\n";
}

mrpt::maps::CMetricMap* CoverageMap::internal_CreateFromMapDefinition(
	const mrpt::maps::TMetricMapInitializer& base)
{
	const auto& definition = dynamic_cast<const TMapDefinition&>(base);
	ASSERT_GT_(definition.resolution, 0);
	ASSERT_LT_(definition.resolution, 1);
	auto* map = new CoverageMap();
	map->setEmpty(definition.resolution);
	return map;
}

uint8_t CoverageMap::serializeGetVersion() const
{
	return 0;
}

void CoverageMap::serializeTo(mrpt::serialization::CArchive& out) const
{
	out << grid_.getXMin() << grid_.getXMax() << grid_.getYMin() << grid_.getYMax()
		<< grid_.getResolution() << points_;
	for (const auto count : grid_) out << count;
}

void CoverageMap::serializeFrom(mrpt::serialization::CArchive& in, uint8_t version)
{
	if (version != 0) MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);
	double xMin = 0, xMax = 0, yMin = 0, yMax = 0, resolution = 0;
	in >> xMin >> xMax >> yMin >> yMax >> resolution >> points_;
	grid_.setSize(xMin, xMax, yMin, yMax, resolution);
	for (std::size_t y = 0; y < grid_.getSizeY(); ++y)
		for (std::size_t x = 0; x < grid_.getSizeX(); ++x) in >> *grid_.cellByIndex(x, y);
}
}  // namespace examples

IMPLEMENTS_SERIALIZABLE(CoverageMap, CMetricMap, examples)

MRPT_INITIALIZER(registerCoverageMap)
{
	mrpt::rtti::registerClass(CLASS_ID(examples::CoverageMap));
}

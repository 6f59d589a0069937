#include "Fingerprint.h"

#include <semloop/object_map/CObjectMap.h>

namespace semloop
{
void Fingerprint::add(const mrpt::poses::CPose3D& pose)
{
	// Asked for its angles, a pose computes and keeps them: no two threads may do that at once.
	for (int i = 0; i < 3; ++i) add(pose.m_coords[i]);
	for (int row = 0; row < 3; ++row)
		for (int column = 0; column < 3; ++column) add(pose.getRotationMatrix()(row, column));
}

void Fingerprint::add(const LabelSet& labels)
{
	for (std::size_t i = 0; i < labels.size(); ++i)
		add(std::hash<std::string>()(labels.name(uint32_t(i))));
}

void Fingerprint::add(const CObjectMap& map)
{
	add(map.labels());
	for (const auto& [id, object] : map.objects())
	{
		add(id);
		add(object.observations);
		add(object.volume.get());
		add(object.T_world_object);
	}
}

}  // namespace semloop

#include "Fingerprint.h"

#include <semloop/object_map/CObjectMap.h>

namespace semloop
{
void Fingerprint::add(const CObjectMap& map)
{
	for (const auto& [id, object] : map.objects())
	{
		add(id);
		add(object.observations);
		add(object.volume.get());
		for (std::size_t i = 0; i < 6; ++i) add(object.T_world_object[i]);
	}
}

}  // namespace semloop

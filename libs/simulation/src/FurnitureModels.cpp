#include <semloop/simulation/FurnitureModels.h>
#include <semloop/simulation/Primitives.h>

namespace semloop
{
namespace
{
const std::string kPrimitive = "primitive:";

FurnitureModel primitive(const std::string& id, const std::string& kind, uint64_t seed)
{
	auto mesh = std::make_shared<Mesh>(makePrimitive(kind, seed));
	const Eigen::Vector3d size = boundsOf(*mesh).size().cast<double>();
	return {id, std::move(mesh), size, size.z()};
}
}  // namespace

const FurnitureModel& FurnitureModels::get(const std::string& id, uint64_t seed)
{
	const bool made = id.rfind(kPrimitive, 0) == 0;
	const std::string key = made ? id + "#" + std::to_string(seed) : id;
	if (const auto known = models_.find(key); known != models_.end()) return known->second;
	if (made)
		return models_.emplace(key, primitive(key, id.substr(kPrimitive.size()), seed))
			.first->second;
	const CatalogEntry& entry = catalog_.entry(id);
	auto mesh = std::make_shared<Mesh>(catalog_.load(entry));
	return models_.emplace(key, FurnitureModel{key, std::move(mesh), entry.size, entry.top})
		.first->second;
}

}  // namespace semloop

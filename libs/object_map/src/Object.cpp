#include <semloop/object_map/Object.h>

namespace semloop
{
mrpt::math::TPoint3D Object::centre() const
{
	const auto box = volume ? volume->boundingBox() : std::nullopt;
	if (!box) return T_world_object.translation();
	return T_world_object.composePoint((box->min + box->max) * 0.5);
}

mrpt::math::TVector3D Object::extent() const
{
	const auto box = volume ? volume->boundingBox() : std::nullopt;
	if (!box) return {0, 0, 0};
	return box->max - box->min;
}

}  // namespace semloop

#include <semloop/association/SurfaceExtent.h>

#include <algorithm>

namespace semloop
{
namespace
{
float median(std::vector<float>& values)
{
	const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
	std::nth_element(values.begin(), middle, values.end());
	return *middle;
}
}  // namespace

std::optional<SurfaceExtent> extentOf(const std::vector<mrpt::math::TPoint3Df>& points)
{
	if (points.empty()) return std::nullopt;
	std::vector<float> x, y, z;
	for (const auto& p : points)
	{
		x.push_back(p.x);
		y.push_back(p.y);
		z.push_back(p.z);
	}
	SurfaceExtent extent;
	extent.centre = {median(x), median(y), median(z)};
	std::vector<float> distances;
	for (const auto& p : points)
		distances.push_back(float((mrpt::math::TPoint3D(p) - extent.centre).norm()));
	extent.radius = median(distances);
	return extent;
}

}  // namespace semloop

#include <semloop/association/SurfaceExtent.h>

#include <algorithm>
#include <cmath>

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
	double sum = 0;
	for (const auto& p : points) sum += (mrpt::math::TPoint3D(p) - extent.centre).sqrNorm();
	extent.radius = std::sqrt(sum / double(points.size()));
	return extent;
}

}  // namespace semloop

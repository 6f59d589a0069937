#include <semloop/loop_closure/YawPose.h>

namespace semloop
{
std::optional<YawPose> fitYawPose(const std::vector<WeightedPair>& pairs)
{
	constexpr double kNoSpread = 1e-9;  // [m^2]
	mrpt::math::TPoint3D meanFrom, meanTo;
	double sum = 0;
	for (const auto& pair : pairs)
	{
		meanFrom += pair.from * pair.weight;
		meanTo += pair.to * pair.weight;
		sum += pair.weight;
	}
	if (pairs.size() < 2 || sum <= 0) return {};
	meanFrom *= 1 / sum;
	meanTo *= 1 / sum;
	double c = 0, s = 0;
	for (const auto& pair : pairs)
	{
		const auto a = pair.from - meanFrom, b = pair.to - meanTo;
		c += pair.weight * (a.x * b.x + a.y * b.y);
		s += pair.weight * (a.x * b.y - a.y * b.x);
	}
	if (std::hypot(c, s) < kNoSpread) return {};
	return YawPose::about(meanFrom, meanTo, c, s);
}

}  // namespace semloop

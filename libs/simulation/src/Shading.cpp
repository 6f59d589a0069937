#include "Shading.h"

#include <algorithm>
#include <cmath>

namespace semloop
{
namespace
{
// A shadow ray starts and ends a little off the surfaces, which would else shade themselves.
constexpr float kShadowGap = 1e-3F;
// Less is not worth a ray: it would change a grey level by one.
constexpr float kFaint = 0.005F;

float fraction(float value)
{
	return value - std::floor(value);
}

/** From below comes less light than from above. */
float ambientShare(const Eigen::Vector3f& normal)
{
	return 0.75F + 0.25F * normal.z();
}
}  // namespace

Shading::Shading(const Scene& scene, const EmbreeScene& geometry)
	: scene_(scene), geometry_(geometry)
{
	// IEC 61966-2-1, sRGB to linear.
	for (int i = 0; i < 256; ++i)
	{
		const float c = float(i) / 255.0F;
		linear_[i] = c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F);
	}
}

cv::Vec3f Shading::albedo(const Hit& hit) const
{
	const Mesh& mesh = geometry_.mesh(hit.object);
	const auto& triangle = mesh.triangles[hit.triangle];
	const Material& material = mesh.materials[triangle.material];
	if (material.texture < 0) return material.color;
	const Eigen::Vector2f uv =
		(1.0F - hit.u - hit.v) * triangle.uv[0] + hit.u * triangle.uv[1] + hit.v * triangle.uv[2];
	const cv::Mat& texture = mesh.textures[material.texture];
	const int x = std::min(texture.cols - 1, int(fraction(uv.x()) * float(texture.cols)));
	const int y = std::min(texture.rows - 1, int(fraction(-uv.y()) * float(texture.rows)));
	const uchar* texel = texture.ptr<uchar>(y) + 3 * x;
	return {
		material.color[0] * linear_[texel[0]], material.color[1] * linear_[texel[1]],
		material.color[2] * linear_[texel[2]]};
}

void Shading::addLight(
	const PointLight& light, const std::vector<Hit>& hits,
	std::array<float, kPacket>& irradiance) const
{
	std::array<float, kPacket> unshadowed{};
	alignas(64) std::array<int, kPacket> valid{};
	RTCRay16 rays;
	bool any = false;
	for (unsigned i = 0; i < hits.size(); ++i)
	{
		const Eigen::Vector3f toHit = hits[i].point - light.position;
		const float squaredDistance = std::max(1e-4F, toHit.squaredNorm());
		const float towards = -hits[i].normal.dot(toHit);  // cosine times distance
		if (towards <= 0 || light.intensity < kFaint * squaredDistance) continue;
		const float perDistance = 1.0F / std::sqrt(squaredDistance);
		unshadowed[i] = light.intensity * towards * perDistance / squaredDistance;
		if (unshadowed[i] < kFaint) continue;
		// From the light to the surface: neighbours' rays stay together.
		setRay(rays, i, light.position, toHit);
		rays.tnear[i] = kShadowGap;
		rays.tfar[i] = 1.0F - kShadowGap - 0.002F * perDistance;
		valid[i] = -1;
		any = true;
	}
	if (!any) return;
	RTCIntersectContext context;
	rtcInitIntersectContext(&context);
	context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
	rtcOccluded16(valid.data(), geometry_.all(), &context, &rays);
	for (unsigned i = 0; i < hits.size(); ++i)
		if (valid[i] != 0 && rays.tfar[i] > 0) irradiance[i] += unshadowed[i];
}

void Shading::shade(const std::vector<Hit>& hits, std::vector<cv::Vec3f>& out) const
{
	std::array<float, kPacket> irradiance{};
	for (std::size_t i = 0; i < hits.size(); ++i)
		irradiance[i] = scene_.ambient * ambientShare(hits[i].normal);
	for (const auto& light : scene_.lights) addLight(light, hits, irradiance);
	out.resize(hits.size());
	for (std::size_t i = 0; i < hits.size(); ++i) out[i] = albedo(hits[i]) * irradiance[i];
}

}  // namespace semloop

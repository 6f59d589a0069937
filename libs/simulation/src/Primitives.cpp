#include <semloop/config/Error.h>
#include <semloop/simulation/Primitives.h>

#include <utility>

#include "PrimitiveParts.h"
#include "PrimitiveTextures.h"

namespace semloop
{
namespace
{
using Eigen::Vector3f;

Vector3f randomSize(SeededRandom& random, const Vector3f& smallest, const Vector3f& largest)
{
	Vector3f size;
	for (int i = 0; i < 3; i++)
		size[i] = static_cast<float>(random.uniform(smallest[i], largest[i]));
	return size;
}

Vector3f scaled(SeededRandom& random, const Vector3f& usual)
{
	return randomSize(random, 0.97F * usual, 1.03F * usual);
}

/** The corners of a box that stands on z = 0 around the origin. */
std::pair<Vector3f, Vector3f> standing(const Vector3f& size)
{
	return {
		Vector3f(-size.x() / 2, -size.y() / 2, 0), Vector3f(size.x() / 2, size.y() / 2, size.z())};
}

/** Lies on its back cover, the spine to its left. */
Mesh makeBook(SeededRandom& random)
{
	Mesh mesh;
	const Vector3f size = randomSize(random, {0.15F, 0.20F, 0.02F}, {0.22F, 0.28F, 0.05F});
	const cv::Scalar color = random.color(random.uniform(0.3, 0.9), random.uniform(0.3, 0.9));
	BoxMaterials sides = BoxMaterials::all(addTexture(mesh, drawPages(random)));
	sides.left = sides.bottom = addColor(mesh, color);
	sides.top = addTexture(mesh, drawBookCover(color, random));
	const auto [minimum, maximum] = standing(size);
	addBox(mesh, minimum, maximum, sides);
	return mesh;
}

Mesh makeBox(SeededRandom& random)
{
	Mesh mesh;
	const Vector3f size = randomSize(random, {0.30F, 0.22F, 0.18F}, {0.50F, 0.40F, 0.40F});
	BoxMaterials sides = BoxMaterials::all(addTexture(mesh, drawCardboard(false, random)));
	sides.front = addTexture(mesh, drawCardboard(true, random));
	const auto [minimum, maximum] = standing(size);
	addBox(mesh, minimum, maximum, sides);
	return mesh;
}

Mesh makeKeyboard(SeededRandom& random)
{
	Mesh mesh;
	const Vector3f size = scaled(random, {0.44F, 0.14F, 0.025F});
	const cv::Mat keys = drawKeyboard(random);
	const cv::Vec3b edge = keys.at<cv::Vec3b>(0, 0);
	BoxMaterials sides = BoxMaterials::all(addColor(mesh, cv::Scalar(edge[0], edge[1], edge[2])));
	sides.top = addTexture(mesh, keys);
	const auto [minimum, maximum] = standing(size);
	addBox(mesh, minimum, maximum, sides);
	return mesh;
}

Mesh makeMonitor(SeededRandom& random)
{
	Mesh mesh;
	const Vector3f size = scaled(random, {0.53F, 0.18F, 0.42F});
	const uint32_t plastic = addColor(mesh, cv::Scalar::all(random.uniform(25, 70)));
	const uint32_t screen = addTexture(mesh, drawScreen(random));
	const float half = size.x() / 2, footHalf = 0.23F * size.x(), depth = size.y() / 2;
	const float chin = 0.24F * size.z(), border = 0.015F, footTop = 0.015F;
	const BoxMaterials all = BoxMaterials::all(plastic);
	addBox(mesh, {-footHalf, -depth, 0}, {footHalf, depth, footTop}, all);
	addBox(mesh, {-0.03F, 0.01F, footTop}, {0.03F, 0.04F, 0.7F * size.z()}, all);
	addBox(mesh, {-half, -0.035F, chin}, {half, 0.01F, size.z()}, all);
	// The screen is a hair before its frame.
	BoxMaterials glowing = all;
	glowing.front = screen;
	addBox(
		mesh, {-half + border, -0.037F, chin + border}, {half - border, -0.035F, size.z() - border},
		glowing);
	return mesh;
}

Mesh makeMouse(SeededRandom& random)
{
	Mesh mesh;
	const Vector3f size = scaled(random, {0.06F, 0.10F, 0.035F});
	const double grey =
		random.uniform(0, 1) < 0.6 ? random.uniform(40, 75) : random.uniform(190, 235);
	addDome(mesh, size, addTexture(mesh, drawMouse(cv::Scalar::all(grey))));
	return mesh;
}

/** A framed painting that stands upright, to be leant or hung at a wall. */
Mesh makePicture(SeededRandom& random)
{
	Mesh mesh;
	const Vector3f size = randomSize(random, {0.30F, 0.02F, 0.20F}, {0.60F, 0.03F, 0.40F});
	BoxMaterials sides = BoxMaterials::all(addColor(mesh, {60, 75, 90}));
	sides.front = addTexture(mesh, drawPicture(random));
	const auto [minimum, maximum] = standing(size);
	addBox(mesh, minimum, maximum, sides);
	return mesh;
}

struct Kind
{
	const char* name;
	Mesh (*make)(SeededRandom&);
};
constexpr Kind kKinds[] = {{"book", makeBook},         {"box", makeBox},
						   {"keyboard", makeKeyboard}, {"monitor", makeMonitor},
						   {"mouse", makeMouse},       {"picture", makePicture}};

}  // namespace

Mesh makePrimitive(const std::string& kind, uint64_t seed)
{
	for (const Kind& known : kKinds)
		if (kind == known.name)
		{
			SeededRandom random(seed);
			return known.make(random);
		}
	requirePrimitive(kind);
	return {};
}

void requirePrimitive(const std::string& kind)
{
	std::string message = "no primitive '" + kind + "'; there are:";
	for (const std::string& name : primitiveKinds())
	{
		if (name == kind) return;
		message += " " + name;
	}
	throw InputError(message);
}

std::vector<std::string> primitiveKinds()
{
	std::vector<std::string> names;
	for (const Kind& kind : kKinds) names.emplace_back(kind.name);
	return names;
}

}  // namespace semloop

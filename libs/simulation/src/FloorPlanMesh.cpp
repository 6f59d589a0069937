#include <semloop/simulation/FloorPlan.h>

#include <opencv2/imgproc.hpp>

#include "Random.h"

namespace semloop
{
namespace
{
using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr int kTexels = 512;
constexpr float kTextureSize = 2.0F;  // of a repetition [m]

/** Blotches of several sizes: something for odometry to hold on to, as real plaster has. */
cv::Mat noiseTexture(cv::Scalar color, double contrast, RandomStream& random)
{
	cv::Mat noise(kTexels, kTexels, CV_32FC1, cv::Scalar(0));
	for (const int cells : {8, 32, 128, kTexels})
	{
		cv::Mat coarse(cells, cells, CV_32FC1);
		for (int i = 0; i < cells * cells; ++i)
			coarse.at<float>(i / cells, i % cells) = float(random.uniform(-1.0, 1.0));
		cv::Mat fine;
		cv::resize(coarse, fine, noise.size(), 0, 0, cv::INTER_CUBIC);
		noise += fine;
	}
	cv::Mat texture(noise.size(), CV_8UC3);
	for (int y = 0; y < kTexels; ++y)
		for (int x = 0; x < kTexels; ++x)
			for (int channel = 0; channel < 3; ++channel)
				texture.at<cv::Vec3b>(y, x)[channel] = cv::saturate_cast<uchar>(
					color[channel] * (1.0 + contrast * noise.at<float>(y, x)));
	return texture;
}

/** Boards or stripes: lines across a noise texture. */
void drawStripes(cv::Mat& texture, int count, double darkness, bool across)
{
	for (int i = 0; i < count; ++i)
	{
		const int at = i * kTexels / count;
		cv::Mat line = across ? texture.rowRange(at, at + 3) : texture.colRange(at, at + 3);
		line *= darkness;
	}
}

cv::Scalar paleColor(RandomStream& random)
{
	const double brightness = random.uniform(150, 215);
	return {
		brightness + random.uniform(-35, 25), brightness + random.uniform(-10, 10),
		brightness + random.uniform(-15, 35)};
}

int addTexture(Mesh& mesh, const cv::Mat& texture)
{
	mesh.textures.push_back(texture);
	mesh.materials.push_back({{1, 1, 1}, int(mesh.textures.size()) - 1});
	return int(mesh.materials.size()) - 1;
}

/** A parallelogram, textured in metres along its sides. */
void addQuad(
	Mesh& mesh, const Vector3f& corner, const Vector3f& side, const Vector3f& up, uint32_t material,
	Vector2f origin)
{
	const auto first = uint32_t(mesh.vertices.size());
	const Vector2f u(side.norm() / kTextureSize, 0), v(0, up.norm() / kTextureSize);
	origin /= kTextureSize;
	mesh.vertices.insert(
		mesh.vertices.end(), {corner, corner + side, corner + side + up, corner + up});
	mesh.triangles.push_back(
		{{first, first + 1, first + 2}, {origin, origin + u, origin + u + v}, material});
	mesh.triangles.push_back(
		{{first, first + 2, first + 3}, {origin, origin + u + v, origin + v}, material});
}

Vector3f at(const Vector2d& point, double z) { return {float(point.x()), float(point.y()), float(z)}; }

/** A wall's inner side, and what frames a door. */
void addWallMesh(
	Mesh& mesh, const Wall& wall, double height, uint32_t paper, uint32_t frame)
{
	const Vector2d along(wall.inward.y(), -wall.inward.x());
	const double length = std::abs(wall.footprint.size.dot(along));
	const double depth = FloorPlan::kWallThickness;
	const double bottom = wall.aboveDoor ? FloorPlan::kDoorHeight : 0.0;
	const Vector2d left = wall.footprint.center - along * length / 2 + wall.inward * depth / 2;
	const Vector3f up(0, 0, float(height - bottom));
	const Vector2f origin(float(left.dot(along)), float(bottom));
	addQuad(mesh, at(left, bottom), at(along * length, 0), up, paper, origin);
	const Vector3f through = at(-wall.inward * depth, 0);
	if (wall.aboveDoor)
		addQuad(mesh, at(left, bottom), at(along * length, 0), through, frame, {0, 0});
	else
		for (const double end : {0.0, length})
			addQuad(mesh, at(left + along * end, 0), through, up, frame, {0, 0});
}
}  // namespace

Mesh FloorPlan::mesh(uint64_t seed) const
{
	Mesh mesh;
	RandomStream random(seed);
	const int frame = addTexture(mesh, noiseTexture({215, 220, 225}, 0.02, random));
	const int ceiling = addTexture(mesh, noiseTexture({225, 230, 232}, 0.04, random));
	std::vector<int> papers;
	for (const auto& room : rooms_)
	{
		cv::Mat paper = noiseTexture(paleColor(random), 0.06, random);
		if (random.uniform(0, 1) < 0.5) drawStripes(paper, 8, 0.9, false);
		papers.push_back(addTexture(mesh, paper));
		cv::Mat floor = noiseTexture(
			{random.uniform(60, 110), random.uniform(90, 140), random.uniform(120, 180)}, 0.12,
			random);
		drawStripes(floor, 14, 0.6, random.uniform(0, 1) < 0.5);
		const int boards = addTexture(mesh, floor);
		// Under the walls too, so that no gap shows in a door.
		const double margin = kWallThickness / 2;
		const Vector2d corner = room.corner - Vector2d(margin, margin);
		const Vector2d size = room.size + Vector2d(2 * margin, 2 * margin);
		addQuad(mesh, at(corner, 0), at({size.x(), 0}, 0), at({0, size.y()}, 0), boards, {0, 0});
		addQuad(
			mesh, at(corner, height_), at({size.x(), 0}, 0), at({0, size.y()}, 0), ceiling, {0, 0});
	}
	for (const auto& wall : walls_) addWallMesh(mesh, wall, height_, papers[wall.room], frame);
	return mesh;
}

}  // namespace semloop

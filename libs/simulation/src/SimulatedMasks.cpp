#include "SimulatedMasks.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "MaskNoise.h"
#include "Random.h"

namespace semloop
{
namespace
{
constexpr double kPi = 3.14159265358979323846;
// Lengths in an image 640 wide [px].
constexpr double kBulge = 12.0;                              // spacing of the outline's noise
constexpr double kGap = 4.0;                                 // between neighbours, at most
constexpr double kSmallestAxis = 12.0, kLargestAxis = 80.0;  // half axes of false detections

/** A line that cuts the image in two. */
struct Cut
{
	double x = 0, y = 0;              // a point of it [px]
	double normalX = 0, normalY = 0;  // towards the second part
	bool isSecond(int column, int row) const
	{
		return (column - x) * normalX + (row - y) * normalY > 0;
	}
};

Cut cutThroughCentroid(const InstanceMask& mask, RandomStream& random)
{
	double x = 0, y = 0;
	for (const auto& run : mask.runs())
	{
		const double pixels = run.end - run.begin;
		x += pixels * 0.5 * (run.begin + run.end - 1);
		y += pixels * run.row;
	}
	const double angle = random.uniform(0, 2 * kPi), n = double(mask.area());
	return {x / n, y / n, std::cos(angle), std::sin(angle)};
}

/** An ellipse around a point. */
struct Ellipse
{
	double x = 0, y = 0;          // [px]
	double major = 1, minor = 1;  // half axes [px]
	double cosine = 1, sine = 0;  // of the major axis' angle
	bool contains(int column, int row) const
	{
		const double dx = column - x, dy = row - y;
		const double u = (cosine * dx + sine * dy) / major;
		const double v = (cosine * dy - sine * dx) / minor;
		return u * u + v * v <= 1;
	}
};

Ellipse randomEllipse(cv::Size image, double scale, RandomStream& random)
{
	Ellipse e;
	e.x = random.below(uint32_t(image.width));
	e.y = random.below(uint32_t(image.height));
	e.major = scale * kSmallestAxis * std::pow(kLargestAxis / kSmallestAxis, random.uniform());
	e.minor = e.major * random.uniform(0.4, 1.0);
	const double angle = random.uniform(0, kPi);
	e.cosine = std::cos(angle);
	e.sine = std::sin(angle);
	return e;
}

InstanceMask unionOf(const InstanceMask& a, const InstanceMask& b)
{
	cv::Mat both = a.decode();
	for (const auto& run : b.runs())
		std::fill_n(both.ptr<uint8_t>(run.row) + run.begin, run.end - run.begin, uint8_t(255));
	return InstanceMask::encode(both);
}

bool areNeighbours(const InstanceMask& a, const InstanceMask& b, int gap)
{
	const auto grown = [&](cv::Rect r)
	{ return cv::Rect(r.x - gap, r.y - gap, r.width + 2 * gap, r.height + 2 * gap); };
	if ((grown(a.boundingBox()) & b.boundingBox()).empty()) return false;
	for (const auto& p : a.runs())
		for (const auto& q : b.runs())
			if (std::abs(p.row - q.row) <= gap && p.begin <= q.end + gap && q.begin <= p.end + gap)
				return true;
	return false;
}

/** Who takes part in the competition for pixels. */
struct Blob
{
	std::vector<const SceneObject*> objects;
	InstanceMask mask;
};

std::vector<Blob> mergedBlobs(
	const std::vector<VisibleObject>& visible, double rate, double scale, uint64_t seed)
{
	std::vector<Blob> blobs;
	std::vector<bool> taken(visible.size(), false);
	for (std::size_t i = 0; i < visible.size(); i++)
	{
		if (taken[i]) continue;
		const SceneObject* object = visible[i].object;
		blobs.push_back({{object}, visible[i].mask});
		if (RandomStream(hashedFor("merge", seed, object->id)).uniform() >= rate) continue;
		for (std::size_t j = i + 1; j < visible.size(); j++)
		{
			const bool alike = !taken[j] && visible[j].object->label == object->label;
			if (!alike || !areNeighbours(visible[i].mask, visible[j].mask, int(kGap * scale)))
				continue;
			blobs.back() = {{object, visible[j].object}, unionOf(visible[i].mask, visible[j].mask)};
			taken[j] = true;
			break;
		}
	}
	return blobs;
}

/** Blobs with their masks noisy, cut and disjoint. Owners 2 i and 2 i + 1 are the parts of blob i. */
std::vector<SimulatedMask> competing(
	const std::vector<Blob>& blobs, const SimulatedDetectorOptions& options, double scale,
	uint64_t seed, PixelClaims& claims)
{
	std::vector<cv::Rect> boxes;
	for (std::size_t i = 0; i < blobs.size(); i++)
	{
		const auto& [objects, mask] = blobs[i];
		const uint32_t id = objects.front()->id;
		const MaskMargin margin = noisyMargin(
			mask, options.boundaryNoise * scale, kBulge * scale, hashedFor("outline", seed, id));
		boxes.push_back(margin.box);
		const int owner = 2 * int(i);
		RandomStream random(hashedFor("split", seed, id));
		if (random.uniform() < options.splitRate)
		{
			const Cut cut = cutThroughCentroid(mask, random);
			claims.claim(owner, margin, [&](int x, int y) { return !cut.isSecond(x, y); });
			claims.claim(owner + 1, margin, [&](int x, int y) { return cut.isSecond(x, y); });
		}
		else
			claims.claim(owner, margin, [](int, int) { return true; });
	}
	std::vector<SimulatedMask> masks;
	for (std::size_t i = 0; i < blobs.size(); i++)
		for (int part = 0; part < 2; part++)
			masks.push_back(
				{blobs[i].objects, claims.maskOf(2 * int(i) + part, boxes[i]),
				 hashedFor("mask", seed, blobs[i].objects.front()->id, part)});
	return masks;
}

/** Empty where something is reported already. */
InstanceMask falseMask(const RenderedView& view, const Ellipse& e, const PixelClaims& claims)
{
	const cv::Size size = view.object.size();
	const int reach = int(std::ceil(e.major));
	const cv::Rect box =
		cv::Rect(int(e.x) - reach, int(e.y) - reach, 2 * reach + 1, 2 * reach + 1) &
		cv::Rect({0, 0}, size);
	const auto id = view.object.at<uint16_t>(int(e.y), int(e.x));
	cv::Mat mask(box.size(), CV_8UC1, cv::Scalar(0));
	if (!claims.isFree(int(e.x), int(e.y))) return InstanceMask(size);
	for (int y = box.y; y < box.y + box.height; y++)
		for (int x = box.x; x < box.x + box.width; x++)
			if (e.contains(x, y) && view.object.at<uint16_t>(y, x) == id && claims.isFree(x, y))
				mask.at<uint8_t>(y - box.y, x - box.x) = 255;
	return InstanceMask::encode(mask, box.tl(), size);
}

bool isTooSmall(
	const InstanceMask& mask, const RenderedView& view, const SimulatedDetectorOptions& options)
{
	return mask.empty() || scaledArea(mask, view) < options.minimumArea;
}

void addFalseMasks(
	const RenderedView& view, const SimulatedDetectorOptions& options, uint64_t seed,
	PixelClaims& claims, std::vector<SimulatedMask>& masks)
{
	constexpr int kAttempts = 10;  // then the image is full
	constexpr int kOwner = 0;      // nobody asks for it any more
	RandomStream random(hashedFor("false", seed));
	const int count = random.poisson(options.falseRate);
	for (int i = 0; i < count; i++)
		for (int attempt = 0; attempt < kAttempts; attempt++)
		{
			const Ellipse ellipse = randomEllipse(view.object.size(), imageScale(view), random);
			InstanceMask mask = falseMask(view, ellipse, claims);
			if (isTooSmall(mask, view, options)) continue;
			claims.take(kOwner, mask);
			masks.push_back({{}, std::move(mask), hashedFor("mask", seed, 0, i)});
			break;
		}
}

}  // namespace

double imageScale(const RenderedView& view)
{
	return view.camera.ncols / 640.0;
}

double scaledArea(const InstanceMask& mask, const RenderedView& view)
{
	const double scale = imageScale(view);
	return double(mask.area()) / (scale * scale);
}

std::vector<SimulatedMask> simulatedMasks(
	const RenderedView& view, const std::vector<VisibleObject>& objects,
	const SimulatedDetectorOptions& options, uint64_t seed)
{
	if (view.object.empty()) return {};
	const double scale = imageScale(view);
	PixelClaims claims(view.object.size());
	auto masks = competing(
		mergedBlobs(objects, options.mergeRate, scale, seed), options, scale, seed, claims);
	const auto isSmall = [&](const SimulatedMask& m) { return isTooSmall(m.mask, view, options); };
	masks.erase(std::remove_if(masks.begin(), masks.end(), isSmall), masks.end());
	addFalseMasks(view, options, seed, claims, masks);
	return masks;
}

}  // namespace semloop

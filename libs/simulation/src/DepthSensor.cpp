#include <semloop/config/Error.h>
#include <semloop/simulation/DepthSensor.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "Random.h"

namespace semloop
{
namespace
{
void requireView(const RenderedView& view)
{
	if (view.depth.type() != CV_32FC1)
		throw InputError("view to sense: its depth must be one channel of 32-bit floats");
	if (view.cosine.type() != CV_32FC1 || view.cosine.size() != view.depth.size())
		throw InputError("view to sense: its cosine must be 32-bit floats of the depth's size");
	if (!(view.camera.fx() > 0))
		throw InputError(
			"view to sense: its camera has a focal length of " + std::to_string(view.camera.fx()) +
			"; give one above 0");
}

uint16_t millimetres(float metres)
{
	const float value = metres * 1000.0F + 0.5F;
	return value < 65536.0F ? uint16_t(value) : uint16_t(0);
}

cv::Mat exactDepth(const cv::Mat& depth, const DepthSensorOptions& o)
{
	cv::Mat result(depth.size(), CV_16UC1);
	for (int y = 0; y < depth.rows; y++)
	{
		const float* z = depth.ptr<float>(y);
		auto* out = result.ptr<uint16_t>(y);
		for (int x = 0; x < depth.cols; x++)
			out[x] = z[x] >= o.minimumRange && z[x] <= o.maximumRange ? millimetres(z[x]) : 0;
	}
	return result;
}

/** Which pixels of an image row the projector sees. It stands b to the right of the camera and looks
 *  the same way: the point at column u and disparity d = f b / z lies at its column u - d. In each half
 *  column of the projector, the light reaches the largest disparity. A pixel covers up to the middle
 *  between it and a neighbour of the same surface, and else half a pixel. */
class ProjectorRow
{
public:
	ProjectorRow(int width, double focalBaseline, const DepthSensorOptions& o)
		: focalBaseline_(float(focalBaseline)),
		  edge_(float(o.edge)),
		  margin_(int(focalBaseline / o.minimumRange) + 2),
		  disparity_(std::size_t(width)),
		  reached_(std::size_t(2 * (width + margin_ + 1)))
	{
	}

	void project(const float* z, int width)
	{
		std::fill(reached_.begin(), reached_.end(), 0.0F);
		for (int x = 0; x < width; x++) disparity_[x] = z[x] > 0 ? focalBaseline_ / z[x] : 0.0F;
		float left = -0.5F - disparity_[0];
		for (int x = 0; x < width; x++)
		{
			const float d = disparity_[x];
			const bool last = x + 1 == width;
			const bool smooth = !last && std::abs(z[x + 1] - z[x]) <= edge_ && z[x] > 0;
			const float right = float(x) + 0.5F - (smooth ? 0.5F * (d + disparity_[x + 1]) : d);
			if (d > 0) cover(left, right, d);
			left = smooth || last ? right : float(x) + 0.5F - disparity_[x + 1];
		}
	}

	/** Of a pixel in range: whether nothing nearer by a pixel of disparity stands in the light's way. */
	bool sees(int x) const
	{
		const int column = int(2 * (float(x) - disparity_[x] + float(margin_)));
		return reached_[column] <= disparity_[x] + 1.0F;
	}

private:
	/** The half-columns whose middle lies in [left, right); none of a pixel in range lies outside. */
	void cover(float left, float right, float d)
	{
		const float m = float(margin_);
		const int begin = int(std::max(0.0F, 2 * (left + m) + 0.5F));
		const int end = int(std::max(0.0F, 2 * (right + m) + 0.5F));
		for (int i = begin; i < end; i++) reached_[i] = std::max(reached_[i], d);
	}

	float focalBaseline_, edge_;
	int margin_;  // columns left of the image where the projector sees what is in range
	std::vector<float> disparity_;
	std::vector<float> reached_;  // largest disparity, by half-column of the projector
};

/** The true depth where the sensor measures one, 0 elsewhere. */
cv::Mat measurableDepth(const RenderedView& view, const DepthSensorOptions& o)
{
	const int width = view.depth.cols;
	const auto nearest = float(o.minimumRange), farthest = float(o.maximumRange);
	const auto minimumCosine = float(o.minimumCosine);
	ProjectorRow projector(width, view.camera.fx() * o.baseline, o);
	cv::Mat result(view.depth.size(), CV_32FC1);
	for (int y = 0; y < view.depth.rows; y++)
	{
		const float* z = view.depth.ptr<float>(y);
		const float* cosine = view.cosine.ptr<float>(y);
		auto* out = result.ptr<float>(y);
		projector.project(z, width);
		for (int x = 0; x < width; x++)
		{
			const bool measured = z[x] >= nearest && z[x] <= farthest &&
								  cosine[x] >= minimumCosine && projector.sees(x);
			out[x] = measured ? z[x] : 0.0F;
		}
	}
	return result;
}

/** Depth at (x, y) inside the image: bilinear on one surface, else that of the nearest pixel. */
float lookUp(const cv::Mat& depth, float x, float y, float edge)
{
	const int x0 = int(x), y0 = int(y);
	const int x1 = std::min(x0 + 1, depth.cols - 1), y1 = std::min(y0 + 1, depth.rows - 1);
	const float* top = depth.ptr<float>(y0);
	const float* bottom = depth.ptr<float>(y1);
	const float a = top[x0], b = top[x1], c = bottom[x0], d = bottom[x1];
	const float s = x - float(x0), t = y - float(y0);
	const float least = std::min(std::min(a, b), std::min(c, d));
	const float most = std::max(std::max(a, b), std::max(c, d));
	if (least > 0 && most - least <= edge)
	{
		const float above = a + s * (b - a), below = c + s * (d - c);
		return above + t * (below - above);
	}
	const float* nearer = t < 0.5F ? top : bottom;
	return nearer[s < 0.5F ? x0 : x1];
}

/** The formula of DepthSensor.h, with K = `steps` of disparity at one metre; each pixel's random numbers
 *  are its own. */
cv::Mat noisyDepth(const cv::Mat& depth, float steps, const DepthSensorOptions& o, uint64_t seed)
{
	const float right = float(depth.cols - 1), bottom = float(depth.rows - 1);
	const auto sigma = float(o.disparitySigma), shift = float(o.lateralSigma);
	const auto edge = float(o.edge);
	const NormalTable& normal = normalTable();
	RandomStream random(hashed(seed));
	cv::Mat result(depth.size(), CV_16UC1);
	for (int y = 0; y < depth.rows; y++)
	{
		auto* out = result.ptr<uint16_t>(y);
		for (int x = 0; x < depth.cols; x++)
		{
			const uint64_t bits = random.bits();
			const float nx = shift * normal(bits);
			const float ny = shift * normal(bits >> NormalTable::kBits);
			const float z = lookUp(
				depth, std::clamp(float(x) + nx, 0.0F, right),
				std::clamp(float(y) + ny, 0.0F, bottom), edge);
			const float noise = sigma * normal(bits >> (2 * NormalTable::kBits));
			const int disparity = z > 0 ? int(steps / z + noise + 0.5F) : 0;
			out[x] = disparity > 0 ? millimetres(steps / float(disparity)) : 0;
		}
	}
	return result;
}
}  // namespace

void DepthSensorOptions::describe(OptionFields& f)
{
	f.flag("noise", noise, "false: the exact depth within the range");
	f.number("minimum_range", minimumRange, 0.1, 100, "nearer is not measured [m]");
	f.number("maximum_range", maximumRange, 0.1, 65.535, "farther is not measured [m]");
	f.number("baseline", baseline, 0.001, 1, "from the camera to the projector on its right [m]");
	f.number("disparity_scale", disparityScale, 1, 1024, "steps of disparity in a pixel");
	f.number("disparity_sigma", disparitySigma, 0, 100, "noise of the disparity [steps]");
	f.number("lateral_sigma", lateralSigma, 0, 4, "noise of the place in the image [px]");
	f.number("edge", edge, 0, 10, "depth is never interpolated across a larger step [m]");
	f.number("minimum_cosine", minimumCosine, 0, 1, "of the angle of incidence; less: no depth");
}

void DepthSensorOptions::requireConsistent() const
{
	if (minimumRange > maximumRange)
		throw UsageError(
			"minimum_range = " + std::to_string(minimumRange) + ": not allowed; use at most " +
			"maximum_range, " + std::to_string(maximumRange));
}

cv::Mat senseDepth(const RenderedView& view, const DepthSensorOptions& o, uint64_t seed)
{
	o.requireConsistent();
	if (view.depth.empty()) return {};
	requireView(view);
	if (!o.noise) return exactDepth(view.depth, o);
	const double steps = o.disparityScale * view.camera.fx() * o.baseline;
	return noisyDepth(measurableDepth(view, o), float(steps), o, seed);
}

}  // namespace semloop

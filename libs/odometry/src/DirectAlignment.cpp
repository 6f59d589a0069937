#include "DirectAlignment.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "PoseAlgebra.h"

namespace semloop
{
namespace
{
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr int kBorder = 3;               // [px]
constexpr double kDegreesOfFreedom = 5;  // of the t distribution, as in DVO
constexpr double kMinIntensityScale = 0.5;
constexpr double kMinDepthScale = 0.1;
constexpr float kNearest = 0.1f;  // [m]
constexpr std::size_t kMinResiduals = 200;
constexpr double kConverged = 1e-5;  // [m], [rad]

using Row6 = Eigen::Matrix<float, 1, 6>;
using Row8 = Eigen::Matrix<float, 1, 8>;
using Matrix8 = Eigen::Matrix<double, 8, 8>;
using Vector8 = Eigen::Matrix<double, 8, 1>;

float depthSigma(float z)
{
	return 0.0012f + 0.0019f * (z - 0.4f) * (z - 0.4f);
}

float interpolated(const cv::Mat& image, float u, float v)
{
	const int x = int(u), y = int(v);
	const float a = u - float(x), b = v - float(y);
	const float* top = image.ptr<float>(y) + x;
	const float* bottom = image.ptr<float>(y + 1) + x;
	return (1 - b) * ((1 - a) * top[0] + a * top[1]) + b * ((1 - a) * bottom[0] + a * bottom[1]);
}

/** What one point contributes to the normal equations. */
struct Residual
{
	Row8 intensityJacobian;  //!< motion, a, b
	Row6 depthJacobian;
	float intensity = kNaN;  //!< NaN: no such residual
	float depth = kNaN;
};

struct Exposure
{
	double a = 1;
	double b = 0;
};

/** A point in the current camera's frame and its pixel, with what both do under a motion e. */
struct Projection
{
	Eigen::Vector3f q;
	float u = 0, v = 0;
	Eigen::Matrix<float, 1, 3> du, dv;  //!< of the pixel, by q
	Eigen::Matrix<float, 3, 6> dq;      //!< of exp(e) q, by e: [1, -[q]x]
};

/** Empty when the point is not in the image. */
std::optional<Projection> project(const Eigen::Vector3f& q, const AlignmentImage& current)
{
	if (!(q.z() > kNearest)) return std::nullopt;
	const float fx = float(current.fx), fy = float(current.fy);
	const float inverseZ = 1 / q.z();
	Projection p;
	p.q = q;
	p.u = fx * q.x() * inverseZ + float(current.cx);
	p.v = fy * q.y() * inverseZ + float(current.cy);
	const cv::Size size = current.depth.size();
	const bool inside = p.u >= kBorder && p.v >= kBorder && p.u < float(size.width - kBorder - 1) &&
						p.v < float(size.height - kBorder - 1);
	if (!inside) return std::nullopt;
	p.du << fx * inverseZ, 0, -fx * q.x() * inverseZ * inverseZ;
	p.dv << 0, fy * inverseZ, -fy * q.y() * inverseZ * inverseZ;
	p.dq << 1, 0, 0, 0, q.z(), -q.y(), 0, 1, 0, -q.z(), 0, q.x(), 0, 0, 1, q.y(), -q.x(), 0;
	return p;
}

/** r_Z, by the plane through the pixel; none where the surface is not smooth. */
void addDepthResidual(const Projection& p, const AlignmentImage& current, Residual& residual)
{
	const int x = int(p.u + 0.5f), y = int(p.v + 0.5f);
	const float zx = current.depthX.at<float>(y, x), zy = current.depthY.at<float>(y, x);
	if (!std::isfinite(zx) || !std::isfinite(zy)) return;
	const float weight = 1 / depthSigma(p.q.z());
	const float surface =
		current.depth.at<float>(y, x) + zx * (p.u - float(x)) + zy * (p.v - float(y));
	Eigen::Matrix<float, 1, 3> dr = zx * p.du + zy * p.dv;
	dr.z() -= 1;
	residual.depth = (surface - p.q.z()) * weight;
	residual.depthJacobian = weight * dr * p.dq;
}

/** r_I */
void addIntensityResidual(
	const Projection& p, float reference, const AlignmentImage& current, const Exposure& exposure,
	Residual& residual)
{
	const float gx = interpolated(current.intensityX, p.u, p.v);
	const float gy = interpolated(current.intensityY, p.u, p.v);
	residual.intensity = interpolated(current.intensity, p.u, p.v) - float(exposure.a) * reference -
						 float(exposure.b);
	residual.intensityJacobian.head<6>() = (gx * p.du + gy * p.dv) * p.dq;
	residual.intensityJacobian(6) = -reference;
	residual.intensityJacobian(7) = -1;
}

/** Residuals of the points that are seen: in the image, and not behind or before another surface. */
void evaluate(
	const std::vector<AlignmentPoint>& points, const Eigen::Isometry3d& T_current_reference,
	const AlignmentImage& current, const Exposure& exposure, float maxDepthDifference,
	std::vector<Residual>& residuals)
{
	const Eigen::Matrix3f R = T_current_reference.linear().cast<float>();
	const Eigen::Vector3f t = T_current_reference.translation().cast<float>();
	residuals.clear();
	for (const auto& point : points)
	{
		const auto p = project(R * point.p_reference + t, current);
		if (!p) continue;
		const float z = current.depth.at<float>(int(p->v + 0.5f), int(p->u + 0.5f));
		if (std::abs(z - p->q.z()) > maxDepthDifference) continue;  // false for a hole (NaN)

		auto& residual = residuals.emplace_back();
		addDepthResidual(*p, current, residual);
		if (point.textured) addIntensityResidual(*p, point.intensity, current, exposure, residual);
	}
}

/** Scale of a t distribution with a given number of degrees of freedom: fixed point of
 *  s^2 = 1/n sum r^2 (nu + 1) / (nu + r^2 / s^2). */
double studentScale(const std::vector<Residual>& residuals, float Residual::*member, double start)
{
	constexpr int kSteps = 5;
	const double nu = kDegreesOfFreedom;
	double variance = start * start;
	for (int step = 0; step < kSteps; step++)
	{
		double sum = 0;
		std::size_t count = 0;
		for (const auto& residual : residuals)
		{
			const double r = residual.*member;
			if (std::isnan(r)) continue;
			sum += r * r * (nu + 1) / (nu + r * r / variance);
			count++;
		}
		if (count == 0 || !(sum > 0)) return 0;
		variance = sum / double(count);
	}
	return std::sqrt(variance);
}

double studentWeight(double r, double scale)
{
	const double nu = kDegreesOfFreedom;
	return (nu + 1) / (nu * scale * scale + r * r);
}

struct NormalEquations
{
	Matrix8 A = Matrix8::Zero();
	Vector8 g = Vector8::Zero();
};

NormalEquations accumulate(
	const std::vector<Residual>& residuals, double intensityScale, double depthScale,
	double depthWeight)
{
	Eigen::Matrix<float, 8, 8> A = Eigen::Matrix<float, 8, 8>::Zero();
	Eigen::Matrix<float, 8, 1> g = Eigen::Matrix<float, 8, 1>::Zero();
	NormalEquations sum;
	std::size_t inBlock = 0;
	const auto flush = [&]
	{
		// Blocks of floats, a sum of doubles: fast, and no digits are lost over 10^4 residuals.
		sum.A += A.cast<double>();
		sum.g += g.cast<double>();
		A.setZero();
		g.setZero();
		inBlock = 0;
	};
	for (const auto& r : residuals)
	{
		if (!std::isnan(r.intensity))
		{
			const float w = float(studentWeight(r.intensity, intensityScale));
			A.noalias() += (w * r.intensityJacobian).transpose() * r.intensityJacobian;
			g.noalias() -= w * r.intensity * r.intensityJacobian.transpose();
		}
		if (!std::isnan(r.depth))
		{
			const float w = float(depthWeight * studentWeight(r.depth, depthScale));
			A.topLeftCorner<6, 6>().noalias() +=
				(w * r.depthJacobian).transpose() * r.depthJacobian;
			g.head<6>().noalias() -= w * r.depth * r.depthJacobian.transpose();
		}
		if (++inBlock == 256) flush();
	}
	flush();
	// The exposure is loosely known, so that an image of one brightness leaves nothing singular.
	sum.A(6, 6) += 1e2;
	sum.A(7, 7) += 1e-2;
	return sum;
}

/** Information about the motion when the exposure is not known: the Schur complement. */
Matrix6 marginalInformation(const Matrix8& A)
{
	return A.topLeftCorner<6, 6>() - A.topRightCorner<6, 2>() *
										 A.bottomRightCorner<2, 2>().inverse() *
										 A.bottomLeftCorner<2, 6>();
}
}  // namespace

DirectAlignmentResult alignDirectly(
	const std::vector<AlignmentPoint>& points, const AlignmentImage& current,
	const Eigen::Isometry3d& T_current_reference, const DirectAlignmentOptions& options)
{
	DirectAlignmentResult result;
	result.T_current_reference = T_current_reference;
	Exposure exposure;
	double intensityScale = 10, depthScale = 1;
	std::vector<Residual> residuals;
	residuals.reserve(points.size());

	// The last round only takes the normal equations, at the solution.
	for (bool last = options.iterations == 0;;)
	{
		result.valid = false;
		if (!result.T_current_reference.matrix().allFinite()) return result;
		evaluate(
			points, result.T_current_reference, current, exposure,
			float(options.maxDepthDifference), residuals);
		result.overlap = points.empty() ? 0 : double(residuals.size()) / double(points.size());
		if (residuals.size() < kMinResiduals) return result;

		intensityScale = std::max(
			kMinIntensityScale, studentScale(residuals, &Residual::intensity, intensityScale));
		depthScale =
			std::max(kMinDepthScale, studentScale(residuals, &Residual::depth, depthScale));
		const auto equations =
			accumulate(residuals, intensityScale, depthScale, options.depthWeight);
		result.information = marginalInformation(equations.A);
		const Vector8 step = equations.A.ldlt().solve(equations.g);
		if (!step.allFinite() || !result.information.allFinite()) return result;
		result.valid = true;
		if (last) return result;

		result.T_current_reference = smallMotion(step.head<6>()) * result.T_current_reference;
		exposure.a += step(6);
		exposure.b += step(7);
		result.iterations++;
		last = result.iterations == options.iterations || step.head<6>().norm() < kConverged;
	}
}

}  // namespace semloop

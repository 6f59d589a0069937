#pragma once

#include <semloop/simulation/SceneRenderer.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace semloop
{
/** A wall seen head on, without objects; f = 500 px, so that f b = 37.5 px m for b = 7.5 cm. */
inline RenderedView wallView(int width, int height, float z)
{
	RenderedView view;
	view.camera.ncols = uint32_t(width);
	view.camera.nrows = uint32_t(height);
	view.camera.setIntrinsicParamsFromValues(500, 500, 0.5 * (width - 1), 0.5 * (height - 1));
	const cv::Size size(width, height);
	view.depth = cv::Mat(size, CV_32FC1, cv::Scalar(z));
	view.cosine = cv::Mat(size, CV_32FC1, cv::Scalar(1));
	view.object = cv::Mat(size, CV_16UC1, cv::Scalar(0));
	return view;
}

inline bool sameBytes(const cv::Mat& a, const cv::Mat& b)
{
	return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}
}  // namespace semloop

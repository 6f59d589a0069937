#include "PrimitiveTextures.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace semloop
{
namespace
{
/** Bars as long as words, as many lines as there is room for. */
void drawText(
	cv::Mat& image, const cv::Rect& area, int lineHeight, const cv::Scalar& color,
	SeededRandom& random)
{
	const int thickness = lineHeight / 2;
	for (int y = area.y; y + thickness <= area.br().y; y += lineHeight)
	{
		const int end = area.x + static_cast<int>(area.width * random.uniform(0.5, 1.0));
		for (int x = area.x; x < end;)
		{
			const int length = std::min(random.integer(lineHeight, 5 * lineHeight), end - x);
			cv::rectangle(image, cv::Rect(x, y, length, thickness), color, cv::FILLED);
			x += length + lineHeight / 2 + 1;
		}
	}
}

void drawWindow(cv::Mat& image, const cv::Rect& window, SeededRandom& random)
{
	const bool dark = random.uniform(0, 1) < 0.4;
	const cv::Scalar page = dark ? cv::Scalar(45, 42, 40) : cv::Scalar(245, 245, 245);
	const cv::Scalar ink = dark ? random.color(0.4, 0.9) : cv::Scalar(70, 70, 70);
	const int bar = 16;
	cv::rectangle(image, window, page, cv::FILLED);
	cv::rectangle(
		image, cv::Rect(window.x, window.y, window.width, bar), random.color(0.5, 0.8), cv::FILLED);
	cv::rectangle(image, window, {90, 90, 90}, 1);
	for (int i = 0; i < 3; i++)
		cv::circle(image, {window.br().x - 10 - 14 * i, window.y + bar / 2}, 4, {60, 60, 200}, -1);
	const cv::Rect text(
		window.x + 10, window.y + bar + 10, window.width - 20, window.height - bar - 20);
	drawText(image, text, 12, ink, random);
}

/** One row of keys; `widths` in keys, a gap of one key where negative. */
void drawKeys(
	cv::Mat& image, int y, int height, const std::vector<double>& widths, const cv::Scalar& key,
	const cv::Scalar& ink, SeededRandom& random)
{
	double total = 0;
	for (const double width : widths) total += std::abs(width);
	const double unit = (image.cols - 16) / total;
	double x = 8;
	for (const double width : widths)
	{
		const int left = static_cast<int>(x) + 1;
		x += unit * std::abs(width);
		const int right = static_cast<int>(x) - 1;
		if (width < 0) continue;
		cv::rectangle(image, {left, y + 1}, {right, y + height - 2}, key, cv::FILLED);
		if (width < 3)
			cv::rectangle(
				image, cv::Rect(left + 4, y + 5, random.integer(3, 7), random.integer(4, 8)), ink,
				cv::FILLED);
	}
}

}  // namespace

cv::Mat drawKeyboard(SeededRandom& random)
{
	const bool black = random.uniform(0, 1) < 0.6;
	const cv::Scalar body = black ? cv::Scalar(38, 36, 35) : cv::Scalar(200, 205, 205);
	const cv::Scalar key = black ? cv::Scalar(66, 63, 62) : cv::Scalar(240, 242, 242);
	const cv::Scalar ink = black ? cv::Scalar(225, 225, 225) : cv::Scalar(50, 50, 50);
	cv::Mat image(160, 512, CV_8UC3, body);

	// main block, arrows' block and number block, each after a gap
	const std::vector<double> pads = {-0.4, 1, 1, 1, -0.4, 1, 1, 1, 1};
	const std::vector<double> gapAbove = {-0.4, -3, -0.4, 1, 1, 1, 1};
	const std::vector<double> arrowUp = {-0.4, -1, 1, -1, -0.4, 1, 1, 1, 1};
	const std::vector<double> arrows = {-0.4, 1, 1, 1, -0.4, 2, 1, 1};
	const auto row = [&](int index, std::vector<double> keys, const std::vector<double>& rest)
	{
		keys.insert(keys.end(), rest.begin(), rest.end());
		drawKeys(image, 10 + 24 * index, 24, keys, key, ink, random);
	};
	row(0, {1, -1, 1, 1, 1, 1, -0.5, 1, 1, 1, 1, -0.5, 1, 1, 1, 1}, {-0.4, 1, 1, 1, -4.4});
	row(1, {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2}, pads);
	row(2, {1.5, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1.5}, pads);
	row(3, {1.75, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2.25}, gapAbove);
	row(4, {1.25, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2.75}, arrowUp);
	row(5, {1.25, 1.25, 1.25, 6.25, 1.25, 1.25, 1.25, 1.25}, arrows);
	return image;
}

cv::Mat drawMouse(const cv::Scalar& color)
{
	cv::Mat image(192, 128, CV_8UC3, color);
	const cv::Scalar line = color * 0.45;
	cv::line(image, {64, 0}, {64, 80}, line, 2);
	cv::line(image, {0, 80}, {127, 80}, line, 2);
	cv::rectangle(image, cv::Rect(57, 28, 14, 32), {30, 30, 30}, cv::FILLED);
	cv::rectangle(image, cv::Rect(50, 130, 28, 10), line, cv::FILLED);
	return image;
}

cv::Mat drawBookCover(const cv::Scalar& color, SeededRandom& random)
{
	cv::Mat image(384, 288, CV_8UC3, color);
	const bool light = color[0] + color[1] + color[2] > 380;
	const cv::Scalar ink = light ? cv::Scalar(35, 30, 30) : cv::Scalar(225, 235, 240);
	const cv::Scalar ornament = random.color(0.6, 0.9);
	cv::rectangle(image, cv::Rect(12, 12, 264, 360), ink, 3);
	const int titleTop = random.integer(40, 80);
	drawText(image, cv::Rect(36, titleTop, 216, 70), 36, ink, random);
	const cv::Point middle(144, random.integer(205, 235));
	if (random.uniform(0, 1) < 0.5)
		cv::circle(image, middle, random.integer(28, 50), ornament, cv::FILLED);
	else
	{
		const cv::Point half(random.integer(30, 90), random.integer(20, 45));
		cv::rectangle(image, middle - half, middle + half, ornament, cv::FILLED);
	}
	drawText(image, cv::Rect(72, 318, 144, 20), 20, ink, random);
	return image;
}

cv::Mat drawPages(SeededRandom& random)
{
	cv::Mat image(64, 256, CV_8UC3, cv::Scalar(228, 238, 242));
	for (int y = 0; y < image.rows; y += random.integer(2, 4))
		cv::line(image, {0, y}, {image.cols - 1, y}, cv::Scalar::all(random.integer(175, 215)), 1);
	return image;
}

cv::Mat drawScreen(SeededRandom& random)
{
	cv::Mat image(300, 512, CV_8UC3, random.color(0.55, 0.5));
	const int windows = random.integer(2, 4);
	for (int i = 0; i < windows; i++)
	{
		const int width = random.integer(170, 300), height = random.integer(110, 200);
		const int x = random.integer(6, 506 - width), y = random.integer(6, 270 - height);
		drawWindow(image, cv::Rect(x, y, width, height), random);
	}
	cv::rectangle(image, cv::Rect(0, 280, 512, 20), {40, 38, 36}, cv::FILLED);
	for (int i = 0; i < 6; i++)
		cv::rectangle(image, cv::Rect(8 + 24 * i, 283, 14, 14), random.color(0.7, 0.9), cv::FILLED);
	return image;
}

cv::Mat drawPicture(SeededRandom& random)
{
	cv::Mat image(320, 480, CV_8UC3, random.color(0.35, 0.9));
	const int shapes = random.integer(7, 12);
	for (int i = 0; i < shapes; i++)
	{
		const cv::Scalar color = random.color(random.uniform(0.3, 0.9), random.uniform(0.3, 1.0));
		const int x = random.integer(0, 479), y = random.integer(0, 319);
		const int width = random.integer(15, 110), height = random.integer(15, 80);
		const double angle = random.uniform(0, 180);
		if (i % 2 == 0)
			cv::ellipse(image, {x, y}, {width, height}, angle, 0, 360, color, cv::FILLED);
		else
			cv::rectangle(
				image, {x - width, y - height}, {x + width, y + height}, color, cv::FILLED);
	}
	cv::rectangle(image, cv::Rect(10, 10, 460, 300), {235, 240, 240}, 20);  // passe-partout
	cv::rectangle(image, cv::Rect(6, 6, 468, 308), random.color(0.5, 0.35), 12);
	return image;
}

cv::Mat drawCardboard(bool withLabel, SeededRandom& random)
{
	cv::Mat image(192, 256, CV_8UC3, cv::Scalar(110, 155, 188));
	for (int x = 0; x < image.cols; x += 8)
		cv::line(image, {x, 0}, {x, image.rows - 1}, {104, 148, 181}, 2);
	cv::rectangle(image, cv::Rect(112, 0, 32, 192), {140, 185, 210}, cv::FILLED);
	if (!withLabel) return image;
	const int x = random.integer(10, 40), y = random.integer(70, 100);
	cv::rectangle(image, cv::Rect(x, y, 84, 62), {240, 243, 243}, cv::FILLED);
	drawText(image, cv::Rect(x + 8, y + 8, 68, 28), 9, {40, 40, 40}, random);
	for (int bar = x + 8; bar < x + 74; bar += random.integer(2, 5))
		cv::line(image, {bar, y + 42}, {bar, y + 56}, {20, 20, 20}, 1);
	cv::rectangle(image, cv::Rect(180, 24, 50, 40), random.color(0.8, 0.6), 5);
	return image;
}

}  // namespace semloop

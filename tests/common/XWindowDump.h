#pragma once

#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <string>

#include "TemporaryFolder.h"

namespace semloop
{
/** An X window dump of 32 bits a pixel, as Xvfb keeps its screen with -fbdir: CV_8UC3, BGR. Empty when
 *  there is none yet. */
inline cv::Mat readXWindowDump(const std::string& path)
{
	std::string dump = readBytes(path);
	// Words of the header that count here; XWDFile.h has all of them.
	constexpr std::size_t kHeaderSize = 0, kWidth = 4, kHeight = 5, kBytesPerLine = 12,
						  kColors = 19, kWords = 25;
	if (dump.size() < 4 * kWords) return {};
	const auto word = [&](std::size_t index)
	{
		uint32_t value = 0;
		for (std::size_t i = 0; i < 4; i++) value = value << 8 | uint8_t(dump[4 * index + i]);
		return std::size_t(value);
	};
	const std::size_t begin = word(kHeaderSize) + 12 * word(kColors);
	if (word(kHeight) == 0 || dump.size() < begin + word(kHeight) * word(kBytesPerLine)) return {};
	const cv::Mat screen(
		int(word(kHeight)), int(word(kWidth)), CV_8UC4, &dump[begin], word(kBytesPerLine));
	cv::Mat result;
	cv::cvtColor(screen, result, cv::COLOR_BGRA2BGR);
	return result;
}

}  // namespace semloop

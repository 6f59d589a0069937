#include "ObjMaterials.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace semloop
{
namespace
{
constexpr float kGamma = 2.2F;

/** Kd, in linear light. */
cv::Vec3f linearBgr(const tinyobj::material_t& material)
{
	cv::Vec3f bgr;
	for (int i = 0; i < 3; i++)
	{
		const float value = material.diffuse[2 - i];
		bgr[i] = std::isfinite(value) ? std::pow(std::clamp(value, 0.0F, 1.0F), kGamma) : 0.5F;
	}
	return bgr;
}

std::string trimmed(const std::string& text)
{
	const char* const blank = " \t\r\n\"";
	const std::size_t first = text.find_first_not_of(blank);
	if (first == std::string::npos) return {};
	return text.substr(first, text.find_last_not_of(blank) + 1 - first);
}

std::optional<std::string> findTexture(
	const ZipArchive& archive, const std::string& modelPath, const std::string& name)
{
	std::string file = trimmed(name);
	if (file.empty()) return std::nullopt;
	std::replace(file.begin(), file.end(), '\\', '/');
	const std::string folder = std::filesystem::path(modelPath).parent_path().generic_string();
	for (const std::string& path :
		 {folder + "/" + file, folder + "/" + file.substr(file.rfind('/') + 1)})
		if (archive.contains(path)) return path;
	return std::nullopt;
}

int indexOfTexture(ObjModel& model, const std::string& path)
{
	auto& paths = model.texturePaths;
	const auto found = std::find(paths.begin(), paths.end(), path);
	const auto index = static_cast<int>(found - paths.begin());
	if (found == paths.end()) paths.push_back(path);
	return index;
}

/** BGR of an image with alpha. */
cv::Mat withoutHoles(const cv::Mat& bgra)
{
	cv::Mat alpha, bgr;
	cv::extractChannel(bgra, alpha, 3);
	cv::cvtColor(bgra, bgr, cv::COLOR_BGRA2BGR);
	const cv::Mat opaque = alpha >= 128;
	bgr.setTo(cv::mean(bgr, opaque), ~opaque);
	return bgr;
}

}  // namespace

void addMaterials(
	ObjModel& model, const std::vector<tinyobj::material_t>& materials, const ZipArchive& archive,
	const std::string& modelPath)
{
	for (const tinyobj::material_t& material : materials)
	{
		Material added;
		added.color = linearBgr(material);
		if (const auto path = findTexture(archive, modelPath, material.diffuse_texname))
			added.texture = indexOfTexture(model, *path);
		model.mesh.materials.push_back(added);
		model.opacity.push_back(material.dissolve);
	}
}

std::optional<cv::Mat> decodeTexture(const std::string& bytes, int largest)
{
	if (bytes.empty()) return std::nullopt;
	const cv::Mat encoded(
		1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data()));
	cv::Mat image;
	try
	{
		image = cv::imdecode(encoded, cv::IMREAD_UNCHANGED);
	}
	catch (const cv::Exception&)
	{
		return std::nullopt;
	}
	if (image.empty()) return std::nullopt;

	if (image.depth() == CV_16U) image.convertTo(image, CV_8U, 1.0 / 257);
	if (image.depth() != CV_8U) return std::nullopt;
	if (image.channels() == 1) cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
	if (image.channels() == 4) image = withoutHoles(image);
	if (image.channels() != 3) return std::nullopt;

	const cv::Size size(std::min(image.cols, largest), std::min(image.rows, largest));
	if (size != image.size()) cv::resize(image, image, size, 0, 0, cv::INTER_AREA);
	return image;
}

}  // namespace semloop

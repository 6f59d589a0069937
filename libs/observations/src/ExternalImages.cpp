#include <mrpt/core/format.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationStereoImages.h>
#include <semloop/config/Error.h>
#include <semloop/observations/ExternalImages.h>
#include <semloop/observations/RawlogWriter.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <regex>
#include <vector>

#include "GzFile.h"

namespace semloop
{
namespace
{
using mrpt::obs::CObservation3DRangeScan;
namespace fs = std::filesystem;

/** MRPT keeps the names of external depth in protected members and has no setter. */
struct ScanFiles : CObservation3DRangeScan
{
	static std::string& depth(CObservation3DRangeScan& scan)
	{
		return scan.*(&ScanFiles::m_rangeImage_external_file);
	}
	static bool& depthIsExternal(CObservation3DRangeScan& scan)
	{
		return scan.*(&ScanFiles::m_rangeImage_external_stored);
	}
	static std::string& points(CObservation3DRangeScan& scan)
	{
		return scan.*(&ScanFiles::m_points3D_external_file);
	}
};

std::string absoluteName(const std::string& folder, const std::string& file)
{
	const fs::path path(file);
	return path.is_absolute() ? file : (fs::absolute(folder) / path).lexically_normal().string();
}

void resolve(mrpt::img::CImage& image, const std::string& folder)
{
	if (image.isExternallyStored())
		image.setExternalStorage(absoluteName(folder, image.getExternalStorageFile()));
}

void resolve(CObservation3DRangeScan& scan, const std::string& folder)
{
	resolve(scan.intensityImage, folder);
	resolve(scan.confidenceImage, folder);
	if (scan.rangeImage_isExternallyStored())
		ScanFiles::depth(scan) = absoluteName(folder, ScanFiles::depth(scan));
	if (scan.points3D_isExternallyStored())
		ScanFiles::points(scan) = absoluteName(folder, ScanFiles::points(scan));
}

/** libjpeg fills what is missing of a cut file with grey and does not complain; libpng complains on
 *  the user's terminal. Both formats end with a mark. */
bool isCut(const std::string& bytes)
{
	const auto is = [&](const char* start, const char* end)
	{ return bytes.rfind(start, 0) == 0 && bytes.rfind(end) == std::string::npos; };
	return is("\xff\xd8", "\xff\xd9") || is("\x89PNG", "IEND\xae\x42\x60\x82");
}

void appendLittleEndian(std::string& bytes, uint32_t value, int count)
{
	for (int i = 0; i < count; i++) bytes.push_back(char((value >> (8 * i)) & 0xff));
}

uint32_t littleEndian(const uint8_t* bytes, int count)
{
	uint32_t value = 0;
	for (int i = 0; i < count; i++) value |= uint32_t(bytes[i]) << (8 * i);
	return value;
}

void removeFile(const fs::path& path)
{
	std::error_code error;
	fs::remove(path, error);
	if (error)
		throw InputError(
			path.string() + ": cannot be removed (" + error.message() +
			"): remove it, or name another output");
}

/** A longer run would leave its last ones, another program those of another format. */
void removeNumberedImages(const std::string& folder)
{
	static const std::regex name(R"((color|depth)_\d{6,}\.\w+)");
	std::vector<fs::path> images;
	for (const auto& entry : fs::directory_iterator(folder))
		if (std::regex_match(entry.path().filename().string(), name))
			images.push_back(entry.path());
	for (const auto& image : images) removeFile(image);
}

void storeColorExternally(
	CObservation3DRangeScan& scan, const std::string& folder, const std::string& fileName)
{
	const fs::path path = fs::path(folder) / fileName;
	std::vector<uint8_t> bytes;
	cv::imencode(path.extension().string(), scan.intensityImage.asCvMatRef(), bytes);
	std::ofstream out(path, std::ios::binary);
	out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
	if (!out.flush()) throw InputError(path.string() + ": cannot be written; is the disk full?");
	scan.intensityImage.setExternalStorage(fileName);
}

}  // namespace

cv::Mat readImageFile(const std::string& path, int imreadFlags)
{
	std::ifstream in(path, std::ios::binary);
	if (!in) throw InputError(path + ": the image is missing or cannot be read");
	const std::string bytes{std::istreambuf_iterator<char>(in), {}};
	cv::Mat image;
	if (!bytes.empty() && !isCut(bytes))
		image = cv::imdecode(
			cv::_InputArray(bytes.data(), int(bytes.size())),
			imreadFlags | cv::IMREAD_IGNORE_ORIENTATION);
	if (image.empty())
		throw InputError(path + ": the image is cut, damaged or in an unknown format");
	return image;
}

std::string externalImagesFolder(const std::string& rawlogPath)
{
	fs::path path(rawlogPath);
	if (path.extension() == fs::path(RawlogWriter::partialPath("")).filename())
		path.replace_extension();
	return path.replace_extension().string() + "_Images";
}

std::string beginExternalImages(const std::string& rawlogPath)
{
	const std::string folder = externalImagesFolder(rawlogPath);
	std::error_code error;
	if (fs::is_symlink(folder, error))
		throw InputError(
			folder +
			": is a link to another rawlog's images: remove the link, or name another output");
	fs::create_directories(folder, error);
	if (error) throw InputError(folder + ": cannot be made (" + error.message() + ")");
	removeFile(rawlogPath);
	removeNumberedImages(folder);
	return folder;
}

std::string externalImageName(
	const std::string& kind, std::size_t frame, const std::string& extension)
{
	return kind + mrpt::format("_%06zu", frame) + extension;
}

void resolveExternalImages(mrpt::obs::CObservation& observation, const std::string& folder)
{
	if (auto* const scan = dynamic_cast<CObservation3DRangeScan*>(&observation))
		resolve(*scan, folder);
	else if (auto* const image = dynamic_cast<mrpt::obs::CObservationImage*>(&observation))
		resolve(image->image, folder);
	else if (auto* const stereo = dynamic_cast<mrpt::obs::CObservationStereoImages*>(&observation))
	{
		resolve(stereo->imageLeft, folder);
		resolve(stereo->imageRight, folder);
		resolve(stereo->imageDisparity, folder);
	}
}

void storeDepthExternally(
	CObservation3DRangeScan& scan, const std::string& folder, const std::string& fileName)
{
	const auto& depth = scan.rangeImage;
	std::string bytes;
	bytes.reserve(8 + 2 * std::size_t(depth.size()));
	appendLittleEndian(bytes, uint32_t(depth.rows()), 4);
	appendLittleEndian(bytes, uint32_t(depth.cols()), 4);
	for (const uint16_t value : depth) appendLittleEndian(bytes, value, 2);

	GzOutput file((fs::path(folder) / fileName).string());
	file.write(bytes.data(), bytes.size());
	file.close();

	scan.rangeImage.resize(0, 0);
	ScanFiles::depth(scan) = fileName;
	ScanFiles::depthIsExternal(scan) = true;
}

void storeExternally(
	CObservation3DRangeScan& scan, const std::string& folder, std::size_t frame,
	const std::string& colorExtension)
{
	storeColorExternally(scan, folder, externalImageName("color", frame, colorExtension));
	storeDepthExternally(scan, folder, externalImageName("depth", frame, ".bin"));
}

mrpt::math::CMatrix_u16 readExternalDepth(const std::string& path, cv::Size size)
{
	GzInput file(path);
	std::array<uint8_t, 8> header{};
	if (file.read(header.data(), header.size()) != header.size())
		throw InputError(path + ": the depth image is cut");
	const uint32_t rows = littleEndian(&header[0], 4), columns = littleEndian(&header[4], 4);
	if (rows != uint32_t(size.height) || columns != uint32_t(size.width))
		throw InputError(
			path + ": depth image of " + std::to_string(columns) + "x" + std::to_string(rows) +
			" pixels where " + std::to_string(size.width) + "x" + std::to_string(size.height) +
			" are expected");

	std::vector<uint8_t> bytes(2 * std::size_t(size.area()));
	uint8_t beyond = 0;
	if (file.read(bytes.data(), bytes.size()) != bytes.size() || file.read(&beyond, 1) != 0 ||
		file.state() != GzInput::State::Ended)
		throw InputError(path + ": the depth image is cut or damaged");

	mrpt::math::CMatrix_u16 depth(size.height, size.width);
	for (std::size_t i = 0; i < std::size_t(size.area()); i++)
		depth.data()[i] = uint16_t(littleEndian(&bytes[2 * i], 2));
	return depth;
}

}  // namespace semloop

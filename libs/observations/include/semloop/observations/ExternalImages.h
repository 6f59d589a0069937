#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservation3DRangeScan.h>

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <string>

namespace semloop
{
/** Reads an image file, decoded as cv::imread() would with these flags (EXIF turns are ignored).
 *  Throws InputError when it is missing, cut, damaged or no image. */
cv::Mat readImageFile(const std::string& path, int imreadFlags);

/** The folder beside a rawlog where its external images live: path without extension + "_Images". */
std::string externalImagesFolder(const std::string& rawlogPath);

/** Makes that folder, without numbered images of an earlier run, for a rawlog that is to be written. A rawlog of
 *  this name is removed before its images are: call this when the first frame is known to be good. Throws
 *  InputError when something cannot be removed or made, and when the folder is a link: the images behind it are
 *  another rawlog's. */
std::string beginExternalImages(const std::string& rawlogPath);

/** Name of the file of a frame's image: "color", 12, ".png" -> color_000012.png. */
std::string externalImageName(
	const std::string& kind, std::size_t frame, const std::string& extension);

/** Makes the names of an observation's external files absolute, so that they are found whatever
 *  folder MRPT's global CImage::setImagesPathBase() points to: two rawlogs can be open at once.
 *  Knows CObservation3DRangeScan, CObservationImage and CObservationStereoImages. Absolute names
 *  stay. */
void resolveExternalImages(mrpt::obs::CObservation& observation, const std::string& folder);

/** Moves the depth image of a scan to folder/fileName, in MRPT's format for external range images
 *  (gz of rows and columns as uint32 and row by row the uint16 values, little endian), and leaves the
 *  name in the scan. Throws InputError when the file cannot be written. */
void storeDepthExternally(
	mrpt::obs::CObservation3DRangeScan& scan, const std::string& folder,
	const std::string& fileName);

/** Moves both images of a scan, the frame of this number, to folder/color_NNNNNN<colorExtension>, in the format of
 *  the extension, and folder/depth_NNNNNN.bin. Throws InputError when a file cannot be written. */
void storeExternally(
	mrpt::obs::CObservation3DRangeScan& scan, const std::string& folder, std::size_t frame,
	const std::string& colorExtension);

/** Reads a file of storeDepthExternally(). Unlike the scan's own load() it checks what it reads: throws
 *  InputError when the file is missing, damaged, cut, or of another size. */
mrpt::math::CMatrix_u16 readExternalDepth(const std::string& path, cv::Size size);

}  // namespace semloop

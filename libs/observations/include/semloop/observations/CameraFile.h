#pragma once

#include <mrpt/img/TCamera.h>

#include <string>

namespace semloop
{
/** The camera that a file describes as mrpt::img::TCamera writes it: in the section [CAMERA_PARAMS], or in
 *  the only one. Unlike TCamera's own reading, coefficients of distortion without distortion_model are of
 *  MRPT's usual model. Throws UsageError, naming the file. */
mrpt::img::TCamera readCameraFile(const std::string& path);

}  // namespace semloop

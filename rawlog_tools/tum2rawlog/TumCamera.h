#pragma once

#include <mrpt/img/TCamera.h>

#include <optional>
#include <string>

namespace semloop
{
/** One of the benchmark's published cameras by name (fr1, fr2, fr3 or ros, the driver's defaults
 *  without distortion), else the file in which MRPT's TCamera is described: its section
 *  [CAMERA_PARAMS], or the only one. Throws UsageError when it is neither. */
mrpt::img::TCamera tumCamera(const std::string& nameOrFile);

/** fr1, fr2 or fr3 when the name of the folder says so (rgbd_dataset_freiburg1_desk, tum_fr1_desk). */
std::optional<std::string> guessTumCamera(const std::string& folder);

}  // namespace semloop

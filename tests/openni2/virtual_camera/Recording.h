#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RgbdFrame.h>

#include <memory>
#include <optional>
#include <string>

namespace semloop::virtual_camera
{
/** The frames with colour and depth, one after the other. */
class Recording
{
public:
	explicit Recording(const std::string& rawlog) : reader_(rawlog) {}

	std::optional<RgbdFrame> next()
	{
		while (const auto observation = reader_.next())
		{
			const auto scan =
				std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(observation);
			if (scan) return rgbdFrameFrom(*scan);
		}
		return std::nullopt;
	}

private:
	RawlogReader reader_;
};

}  // namespace semloop::virtual_camera

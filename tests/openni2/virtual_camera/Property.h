#pragma once

#include <cstring>

#include "OniDriver.h"

namespace semloop::virtual_camera
{
/** The answer to getProperty() of a stream or a device. */
template <class Value>
OniStatus give(const Value& value, void* data, int* size)
{
	if (*size != int(sizeof(Value))) return ONI_STATUS_BAD_PARAMETER;
	std::memcpy(data, &value, sizeof(Value));
	return ONI_STATUS_OK;
}

}  // namespace semloop::virtual_camera

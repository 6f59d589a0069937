#include "OpenNi2.h"

#include <OpenNI.h>
#include <semloop/config/Error.h>

namespace semloop
{
void startOpenNi2()
{
	static const openni::Status status = openni::OpenNI::initialize();
	if (status != openni::STATUS_OK)
		throw InputError(
			"OpenNI2 has no drivers: install the package libopenni2-0, or look at the folder "
			"OpenNI2/Drivers beside libOpenNI2.so.0");
}

}  // namespace semloop

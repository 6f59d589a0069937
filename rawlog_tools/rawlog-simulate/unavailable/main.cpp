#include <semloop/config/Error.h>

#include "Application.h"

int main()
{
	return semloop::runApplication("rawlog-simulate", []() -> int {
		throw semloop::InputError(
			"this build has no simulation: install libembree-dev, libtinyobjloader-dev, libzip-dev "
			"and sweethome3d-furniture, then build again");
	});
}

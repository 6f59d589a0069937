#pragma once

#include <string>

#include "Shell.h"

namespace semloop
{
/** Why a program of MRPT cannot be run with semloop's plug-ins here; empty when it can. */
inline std::string whyNotRunnable(const std::string& program)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
	return program + " cannot load a library that is built with a sanitizer";
#else
	return isInstalled(program) ? "" : program + " (package mrpt-apps) is not installed";
#endif
}

}  // namespace semloop

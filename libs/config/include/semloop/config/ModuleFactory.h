#pragma once

#include <mrpt/rtti/CObject.h>

#include <memory>
#include <string>
#include <vector>

namespace semloop
{
/** Makes a module by the class name that a configuration gives, e.g. "semloop::OpenCvOdometry".
 *  `key` says where the name stands ("config.ini: [modules] odometry"). Throws UsageError, listing the
 *  registered classes of that kind, when the name is not registered or not of that kind. */
template <class Module>
std::shared_ptr<Module> makeModule(const std::string& className, const std::string& key);

/** Loads plug-ins (shared objects whose modules register themselves), as `plugins = a.so, b.so` in a
 *  configuration asks. Throws UsageError naming the file when one does not load. */
void loadPlugins(const std::vector<std::string>& paths, const std::string& key);

/** Untyped part of makeModule(). */
mrpt::rtti::CObject::Ptr makeModuleOf(
	const mrpt::rtti::TRuntimeClassId* kind, const std::string& className, const std::string& key);

template <class Module>
std::shared_ptr<Module> makeModule(const std::string& className, const std::string& key)
{
	return std::dynamic_pointer_cast<Module>(
		makeModuleOf(&Module::GetRuntimeClassIdStatic(), className, key));
}

}  // namespace semloop

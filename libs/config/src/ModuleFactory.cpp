#include <mrpt/system/os.h>
#include <semloop/config/Error.h>
#include <semloop/config/ModuleFactory.h>

#include <algorithm>
#include <cctype>

namespace semloop
{
namespace
{
std::string registeredClassesOf(const mrpt::rtti::TRuntimeClassId* kind)
{
	std::vector<std::string> names;
	for (const auto* id : mrpt::rtti::getAllRegisteredClassesChildrenOf(kind))
		if (id->ptrCreateObject) names.emplace_back(id->className);
	std::sort(names.begin(), names.end());
	std::string all;
	for (const auto& name : names) all += (all.empty() ? "" : ", ") + name;
	return all.empty() ? "nothing: load a plug-in" : all;
}

std::string oneLine(std::string text)
{
	while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
	std::replace(text.begin(), text.end(), '\n', ' ');
	return text;
}
}  // namespace

mrpt::rtti::CObject::Ptr makeModuleOf(
	const mrpt::rtti::TRuntimeClassId* kind, const std::string& className, const std::string& key)
{
	mrpt::rtti::registerAllPendingClasses();
	const auto* id = mrpt::rtti::findRegisteredClass(className);
	if (!id || !id->ptrCreateObject || !id->derivedFrom(kind))
		throw UsageError(
			key + " = " + className + ": not a registered " + kind->className +
			"; registered are " + registeredClassesOf(kind));
	return mrpt::rtti::CObject::Ptr(id->createObject());
}

void loadPlugins(const std::vector<std::string>& paths, const std::string& key)
{
	for (const auto& path : paths)
	{
		std::string error;
		if (!mrpt::system::loadPluginModule(path, error))
			throw UsageError(
				key + " = " + path + ": does not load (" + oneLine(error) +
				"); give a path with a / to a shared object");
	}
}

}  // namespace semloop

#pragma once

#include <zip.h>

#include <map>
#include <stdexcept>
#include <string>

namespace semloop
{
/** Writes a zip archive of these files, name -> content; returns its path. */
inline std::string writeZip(
	const std::string& path, const std::map<std::string, std::string>& files)
{
	int error = 0;
	zip_t* const archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error);
	if (!archive) throw std::runtime_error("cannot make " + path);
	for (const auto& [name, content] : files)
	{
		zip_source_t* const source = zip_source_buffer(archive, content.data(), content.size(), 0);
		const auto index = zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8);
		// Stored, so that a test can find the bytes in the file and damage them.
		if (index < 0 || zip_set_file_compression(archive, index, ZIP_CM_STORE, 0) != 0)
			throw std::runtime_error("cannot add " + name + " to " + path);
	}
	if (zip_close(archive) != 0) throw std::runtime_error("cannot write " + path);
	return path;
}

}  // namespace semloop

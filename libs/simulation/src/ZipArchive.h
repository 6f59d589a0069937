#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

struct zip;

namespace semloop
{
/** Files inside a .zip. Paths are found whatever their case, slashes ("a\b", "/a/b") and dots
 *  ("a/./b"): models written on Windows name their textures like that. */
class ZipArchive
{
public:
	/** Throws InputError when it is not a readable archive. */
	explicit ZipArchive(const std::string& path);

	bool contains(const std::string& file) const { return find(file).has_value(); }

	/** The bytes of a file. Throws InputError, naming archive and file, when it is not there or is
	 *  damaged. */
	std::string read(const std::string& file) const;

	const std::string& path() const { return path_; }

private:
	struct Closer
	{
		void operator()(zip* archive) const;
	};

	std::optional<uint64_t> find(const std::string& file) const;

	std::string path_;
	std::unique_ptr<zip, Closer> zip_;
	std::map<std::string, uint64_t> indices_;  //!< by normalized path
};

}  // namespace semloop

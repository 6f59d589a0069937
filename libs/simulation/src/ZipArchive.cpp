#include "ZipArchive.h"

#include <semloop/config/Error.h>
#include <zip.h>

#include <algorithm>
#include <filesystem>

namespace semloop
{
namespace
{
//! More than any model has: a damaged header must not ask for all memory.
constexpr uint64_t kLargestFile = 1U << 30;

std::string normalized(std::string path)
{
	std::replace(path.begin(), path.end(), '\\', '/');
	path = std::filesystem::path(path).lexically_normal().generic_string();
	path.erase(0, path.find_first_not_of('/'));
	// ASCII only: tolower() would follow the user's locale
	for (char& c : path)
		if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
	return path;
}

struct FileCloser
{
	void operator()(zip_file_t* file) const { zip_fclose(file); }
};

std::string messageOf(int code)
{
	zip_error_t error;
	zip_error_init_with_code(&error, code);
	const std::string text = zip_error_strerror(&error);
	zip_error_fini(&error);
	return text;
}

}  // namespace

void ZipArchive::Closer::operator()(zip* archive) const
{
	zip_discard(archive);
}

ZipArchive::ZipArchive(const std::string& path) : path_(path)
{
	int error = 0;
	zip_.reset(zip_open(path.c_str(), ZIP_RDONLY, &error));
	if (!zip_) throw InputError(path + ": not a readable zip archive: " + messageOf(error));
	const auto count = static_cast<uint64_t>(zip_get_num_entries(zip_.get(), 0));
	for (uint64_t i = 0; i < count; i++)
		if (const char* const name = zip_get_name(zip_.get(), i, 0))
			indices_.emplace(normalized(name), i);
}

std::optional<uint64_t> ZipArchive::find(const std::string& file) const
{
	const auto found = indices_.find(normalized(file));
	if (found == indices_.end()) return std::nullopt;
	return found->second;
}

std::string ZipArchive::read(const std::string& file) const
{
	const std::string where = path_ + ": " + file;
	const auto index = find(file);
	if (!index) throw InputError(where + ": not in this archive");

	zip_stat_t status;
	const std::unique_ptr<zip_file_t, FileCloser> in(zip_fopen_index(zip_.get(), *index, 0));
	if (!in || zip_stat_index(zip_.get(), *index, 0, &status) != 0 ||
		!(status.valid & ZIP_STAT_SIZE) || status.size > kLargestFile)
		throw InputError(where + ": cannot be unpacked: the archive is damaged");

	std::string bytes(status.size, '\0');
	const zip_int64_t length = zip_fread(in.get(), bytes.data(), bytes.size());
	char beyond = 0;  // the checksum is compared where the file ends
	if (length != static_cast<zip_int64_t>(bytes.size()) || zip_fread(in.get(), &beyond, 1) != 0)
		throw InputError(where + ": cannot be unpacked: the archive is damaged");
	return bytes;
}

}  // namespace semloop

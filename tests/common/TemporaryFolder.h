#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <system_error>

namespace semloop
{
/** A folder of its own for a test, gone afterwards. */
class TemporaryFolder
{
public:
	TemporaryFolder()
	{
		std::string name = (std::filesystem::temp_directory_path() / "semloop-XXXXXX").string();
		if (!mkdtemp(name.data())) throw std::runtime_error("cannot make " + name);
		path_ = name;
	}
	~TemporaryFolder()
	{
		std::error_code ignored;
		std::filesystem::remove_all(path_, ignored);
	}
	TemporaryFolder(const TemporaryFolder&) = delete;
	TemporaryFolder& operator=(const TemporaryFolder&) = delete;

	const std::filesystem::path& path() const { return path_; }
	/** Absolute name of a file in it. */
	std::string file(const std::string& name) const { return (path_ / name).string(); }
	/** Writes a file and returns its name. */
	std::string write(const std::string& name, const std::string& text) const
	{
		std::filesystem::create_directories((path_ / name).parent_path());
		std::ofstream(file(name), std::ios::binary) << text;
		return file(name);
	}

private:
	std::filesystem::path path_;
};

inline std::string readBytes(const std::string& path)
{
	std::ifstream in(path, std::ios::binary);
	return {std::istreambuf_iterator<char>(in), {}};
}

/** what() of the exception of that type that a call throws; "" and nothing when it throws none. */
template <typename Exception, typename Call>
std::string messageOf(const Call& call)
{
	try
	{
		call();
	}
	catch (const Exception& e)
	{
		return e.what();
	}
	return {};
}

}  // namespace semloop

#include "GzFile.h"

#include <semloop/config/Error.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

namespace semloop
{
namespace
{
constexpr unsigned kBufferBytes = 1 << 16;
constexpr std::size_t kLargestChunk = 1 << 30;  // gzread() counts in int
// What a killed process loses at most; small enough to cost no compression worth naming.
constexpr std::size_t kBytesBetweenFlushes = 1 << 18;
}  // namespace

void GzInput::Close::operator()(gzFile_s* file) const
{
	gzclose(file);
}

GzInput::GzInput(const std::string& path)
{
	std::error_code error;
	if (std::filesystem::is_directory(path, error))
		throw InputError(path + ": is a folder, not a file");
	size_ = std::filesystem::file_size(path, error);
	if (!error) file_.reset(gzopen(path.c_str(), "rb"));
	if (!file_)
		throw InputError(
			path + ": cannot be opened (" + (error ? error.message() : std::strerror(errno)) + ")");
	gzbuffer(file_.get(), kBufferBytes);
}

std::size_t GzInput::read(void* buffer, std::size_t count)
{
	std::size_t done = 0;
	while (done < count && state_ == State::Good)
	{
		const auto chunk = unsigned(std::min(count - done, kLargestChunk));
		const int got = gzread(file_.get(), static_cast<uint8_t*>(buffer) + done, chunk);
		if (got > 0) done += std::size_t(got);
		if (got == int(chunk)) continue;

		int error = Z_OK;
		gzerror(file_.get(), &error);
		if (error == Z_OK && got >= 0)
			state_ = State::Ended;
		else
			state_ = error == Z_BUF_ERROR ? State::Cut : State::Damaged;
	}
	return done;
}

uint64_t GzInput::position() const
{
	const auto offset = gzoffset(file_.get());
	return offset < 0 ? size_ : std::min(uint64_t(offset), size_);
}

GzOutput::GzOutput(const std::string& path)
	: path_(path), file_(gzopen(path.c_str(), ("wb" + std::to_string(kFast)).c_str()))
{
	if (!file_) fail();
	gzbuffer(file_, kBufferBytes);
}

GzOutput::~GzOutput()
{
	if (file_) gzclose(file_);
}

void GzOutput::setLevel(int level)
{
	if (level == level_) return;
	if (gzsetparams(file_, level, Z_DEFAULT_STRATEGY) != Z_OK) fail();
	level_ = level;
}

void GzOutput::write(const void* data, std::size_t count)
{
	if (count > 0 && gzfwrite(data, 1, count, file_) != count) fail();
	sinceFlush_ += count;
	if (sinceFlush_ < kBytesBetweenFlushes) return;
	if (gzflush(file_, Z_SYNC_FLUSH) != Z_OK) fail();
	sinceFlush_ = 0;
}

void GzOutput::close()
{
	gzFile_s* const file = file_;
	file_ = nullptr;
	if (file && gzclose(file) != Z_OK) fail();
}

void GzOutput::fail() const
{
	throw InputError(
		path_ + ": cannot be written (" + std::strerror(errno) +
		"): check that the folder exists and has space");
}

}  // namespace semloop

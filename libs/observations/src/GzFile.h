#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

struct gzFile_s;

namespace semloop
{
/** Reads a file, gz-compressed or plain, and knows a file that was cut from one that ended. */
class GzInput
{
public:
	enum class State
	{
		Good,
		Ended,   //!< all of the file was read
		Cut,     //!< the compressed stream stops in its middle
		Damaged  //!< the compressed stream is not valid, or the disk fails
	};

	/** Throws InputError when the file cannot be opened. */
	explicit GzInput(const std::string& path);

	/** Up to count bytes; fewer only when the state then is no longer Good. */
	std::size_t read(void* buffer, std::size_t count);
	State state() const { return state_; }

	/** Bytes of the file on disk that have been consumed, about. */
	uint64_t position() const;
	uint64_t size() const { return size_; }

private:
	struct Close
	{
		void operator()(gzFile_s* file) const;
	};
	std::unique_ptr<gzFile_s, Close> file_;
	uint64_t size_ = 0;
	State state_ = State::Good;
};

/** Writes a gz-compressed file (kFast unless told otherwise). Throws InputError naming the file when that fails. */
class GzOutput
{
public:
	static constexpr int kStored = 0, kFast = 1;

	explicit GzOutput(const std::string& path);
	~GzOutput();

	/** zlib's level of compression for what follows. */
	void setLevel(int level);

	void write(const void* data, std::size_t count);
	void close();

private:
	[[noreturn]] void fail() const;

	std::string path_;
	gzFile_s* file_ = nullptr;
	int level_ = kFast;
	std::size_t sinceFlush_ = 0;
};

}  // namespace semloop

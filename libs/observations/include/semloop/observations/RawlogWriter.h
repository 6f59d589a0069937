#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <memory>
#include <string>

namespace semloop
{
/** Writes observations to a rawlog (gz level 1, as MRPT's programs read it).
 *
 *  Writes to `<path>.partial`; close() renames it. A writer that is destroyed without close() leaves
 *  the partial file, which RawlogReader reads up to its end and tools can resume from. */
class RawlogWriter
{
public:
	/** Throws InputError when the file cannot be created. */
	explicit RawlogWriter(const std::string& path);
	~RawlogWriter();

	/** Throws InputError when the disk is full. */
	void write(const mrpt::serialization::CSerializable& object);
	/** Same, for the bytes of an object from RawlogReader::nextObject(). */
	void writeBytes(const std::string& bytes);
	/** Whether what is written from now on is compressed; it is unless told otherwise. */
	void setCompression(bool on);
	/** Flushes and gives the file its final name. */
	void close();

	static std::string partialPath(const std::string& path) { return path + ".partial"; }

private:
	struct Stream;
	std::string path_;
	std::unique_ptr<Stream> stream_;
};

}  // namespace semloop

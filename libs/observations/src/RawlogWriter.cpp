#include <semloop/config/Error.h>
#include <semloop/observations/RawlogWriter.h>

#include <filesystem>
#include <stdexcept>

#include "Archives.h"
#include "GzFile.h"

namespace semloop
{
namespace
{
const std::string& requireFileName(const std::string& path)
{
	if (path.empty() || std::filesystem::is_directory(path))
		throw InputError(
			"'" + path + "': not the name of a rawlog to write; give one, e.g. out.rawlog");
	return path;
}
}  // namespace

struct RawlogWriter::Stream
{
	explicit Stream(const std::string& path) : file(path) {}
	GzOutput file;
	BufferArchive buffer;
};

RawlogWriter::RawlogWriter(const std::string& path)
	: path_(requireFileName(path)), stream_(std::make_unique<Stream>(partialPath(path)))
{
}

RawlogWriter::~RawlogWriter() = default;

void RawlogWriter::write(const mrpt::serialization::CSerializable& object)
{
	if (!stream_) throw std::logic_error("RawlogWriter: write() after close()");
	// An object that cannot be serialised must not leave its first half in the file.
	stream_->buffer.bytes.clear();
	stream_->buffer.WriteObject(&object);
	stream_->file.write(stream_->buffer.bytes.data(), stream_->buffer.bytes.size());
}

void RawlogWriter::writeBytes(const std::string& bytes)
{
	if (!stream_) throw std::logic_error("RawlogWriter: writeBytes() after close()");
	stream_->file.write(bytes.data(), bytes.size());
}

void RawlogWriter::setCompression(bool on)
{
	if (stream_) stream_->file.setLevel(on ? GzOutput::kFast : GzOutput::kStored);
}

void RawlogWriter::close()
{
	if (!stream_) return;
	stream_->file.close();
	stream_.reset();
	std::error_code error;
	std::filesystem::rename(partialPath(path_), path_, error);
	if (error)
		throw InputError(
			path_ + ": cannot be written (" + error.message() + "): the data are in " +
			partialPath(path_));
}

}  // namespace semloop

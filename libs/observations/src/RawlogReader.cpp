#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/rtti/CObject.h>
#include <semloop/config/Error.h>
#include <semloop/config/ExceptionMessage.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RawlogWriter.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>

#include "Archives.h"

namespace semloop
{
namespace
{
namespace fs = std::filesystem;
using mrpt::serialization::CSerializable;

constexpr uint8_t kNewFormatFlag = 0x80;  // of the length byte before a class name

bool isClassName(const std::string& name)
{
	const auto fits = [](unsigned char c) { return std::isgraph(c) != 0; };
	return !name.empty() && std::all_of(name.begin(), name.end(), fits);
}

std::string findImagesFolder(const std::string& rawlogPath)
{
	const std::string own = externalImagesFolder(rawlogPath);
	std::error_code error;
	return fs::is_directory(own, error) ? own
										: mrpt::obs::CRawlog::detectImagesDirectory(rawlogPath);
}

}  // namespace

struct RawlogReader::Stream
{
	explicit Stream(const std::string& path) : archive(path) {}

	/** Class of the next object, which stays to be read; nothing when the file ended. Of rawlogs from
	 *  before MRPT 0.5.5 only "?". */
	std::optional<std::string> nextClass()
	{
		const std::string length = archive.peek(1);
		if (length.empty()) return std::nullopt;
		if (!(uint8_t(length[0]) & kNewFormatFlag)) return "?";
		return archive.peek(1 + std::size_t(uint8_t(length[0]) & ~kNewFormatFlag)).substr(1);
	}

	GzArchive archive;
};

RawlogReader::RawlogReader(const std::string& path)
	: path_(path), imagesFolder_(findImagesFolder(path)), stream_(std::make_unique<Stream>(path))
{
}

RawlogReader::~RawlogReader() = default;

double RawlogReader::progress() const
{
	const GzInput& file = stream_->archive.file;
	return file.size() == 0 ? 1.0 : double(file.position()) / double(file.size());
}

mrpt::obs::CObservation::Ptr RawlogReader::next()
{
	while (pending_.empty())
	{
		const CSerializable::Ptr object = readObject();
		if (!object) return {};
		unpack(object);
	}
	const auto observation = pending_.front();
	pending_.pop_front();
	resolveExternalImages(*observation, imagesFolder_);
	return observation;
}

std::optional<RawlogObject> RawlogReader::nextObject()
{
	stream_->archive.startCopy();
	const auto object = readObject();
	if (!object) return std::nullopt;
	return RawlogObject{object, stream_->archive.takeCopy()};
}

CSerializable::Ptr RawlogReader::readObject()
{
	using State = GzInput::State;
	const GzInput& file = stream_->archive.file;

	const auto nextClass = stream_->nextClass();
	if (file.size() == 0) fail("the file is empty");
	if (file.state() == State::Damaged) failDamaged("the compressed data are damaged");
	if (!nextClass && file.state() == State::Ended) return {};
	if (file.state() != State::Good) failDamaged("the file was cut: what comes before can be used");

	const std::string& name = *nextClass;
	const bool isOldFormat = name == "?";
	if (!isOldFormat && !isClassName(name)) failDamaged("no MRPT object: not a rawlog, or damaged");
	if (!isOldFormat && !mrpt::rtti::findRegisteredClass(name))
		fail("class " + name + " is not registered: load the plug-in that brings it");
	try
	{
		auto object = stream_->archive.ReadObject();
		objectsRead_++;
		return object;
	}
	catch (const std::exception& e)
	{
		if (file.state() == State::Damaged) failDamaged("the compressed data are damaged");
		if (file.state() != State::Good)
			failDamaged(
				"the file ends inside a " + name + ": it was cut; what comes before can be used");
		// Any first byte below 0x80 looks like the old format.
		if (isOldFormat) failDamaged("no MRPT object: not a rawlog, or damaged");
		const std::string reason = exceptionMessage(e);
		const std::string what = "unreadable " + name + ": " + reason;
		if (reason.find("not registered") != std::string::npos)
			fail(what + " Load the plug-in that brings it");
		failDamaged(what);
	}
}

void RawlogReader::unpack(const CSerializable::Ptr& object)
{
	if (const auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object))
		pending_.push_back(observation);
	else if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))
		pending_.insert(pending_.end(), frame->begin(), frame->end());
	else if (const auto rawlog = std::dynamic_pointer_cast<mrpt::obs::CRawlog>(object))
		for (std::size_t i = 0; i < rawlog->size(); i++) unpack(rawlog->getAsGeneric(i));
	else if (!std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(object))
		fail(std::string("holds a ") + object->GetRuntimeClass()->className + ": not a rawlog");
}

void RawlogReader::fail(const std::string& what) const
{
	throw InputError(place() + what);
}

void RawlogReader::failDamaged(const std::string& what) const
{
	if (objectsRead_ == 0) fail(what);
	throw DamagedRawlogError(place() + what);
}

std::string RawlogReader::place() const
{
	const GzInput& file = stream_->archive.file;
	return path_ + ": object " + std::to_string(objectsRead_) + ", near byte " +
		   std::to_string(file.position()) + " of " + std::to_string(file.size()) + ": ";
}

std::string instancesSidecarPath(const std::string& rawlogPath)
{
	fs::path path(rawlogPath);
	const std::string extension = path.extension().string();
	return path.replace_extension().string() + "_instances" + extension;
}

}  // namespace semloop

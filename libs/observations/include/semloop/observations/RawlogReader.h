#pragma once

#include <mrpt/serialization/CSerializable.h>
#include <semloop/config/Error.h>
#include <semloop/observations/ExternalImages.h>
#include <semloop/observations/ObservationSource.h>

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>

namespace semloop
{
/** A file that is a rawlog up to a place where it was cut or is damaged: what comes before is good. */
class DamagedRawlogError : public InputError
{
public:
	using InputError::InputError;
};

/** An object as it stands in a file. */
struct RawlogObject
{
	mrpt::serialization::CSerializable::Ptr object;
	std::string bytes;  //!< its serialised form, as it was read
};

/** Reads the observations of a rawlog one by one, in file order, without loading the file.
 *
 *  Both rawlog formats: plain observations, and sensory frames with actions (their observations
 *  come one by one). External images are looked for in externalImagesFolder() and, when there is no such
 *  folder, where MRPT's programs look; their names come out absolute. Wheel odometry in actions is
 *  passed over.
 *
 *  Unlike mrpt::obs::CRawlog it tells a file that ended from one that was cut: next() throws
 *  InputError naming file and byte when the file ends inside an object (DamagedRawlogError unless that
 *  is the first one), or holds a class that is not registered (with the plug-in as the remedy). What was
 *  read before stays good. */
class RawlogReader : public ObservationSource
{
public:
	/** Throws InputError when the file is missing or unreadable. */
	explicit RawlogReader(const std::string& path);
	~RawlogReader() override;

	/** The next observation; empty at the end of the file. */
	mrpt::obs::CObservation::Ptr next() override;

	/** The next object, an observation or a sensory frame or actions, with its bytes: for programs that
	 *  write a rawlog anew, bit by bit. Names of external images stay as they are. Empty at the end of
	 *  the file; throws as next(). */
	std::optional<RawlogObject> nextObject();

	const std::string& name() const override { return path_; }
	/** Position in the file as stored on disk. */
	double progress() const override;

private:
	struct Stream;

	mrpt::serialization::CSerializable::Ptr readObject();
	void unpack(const mrpt::serialization::CSerializable::Ptr& object);
	[[noreturn]] void fail(const std::string& what) const;
	[[noreturn]] void failDamaged(const std::string& what) const;
	std::string place() const;

	std::string path_;
	std::string imagesFolder_;
	std::unique_ptr<Stream> stream_;
	std::deque<mrpt::obs::CObservation::Ptr> pending_;
	std::size_t objectsRead_ = 0;
};

/** X.rawlog -> X_instances.rawlog. */
std::string instancesSidecarPath(const std::string& rawlogPath);

}  // namespace semloop

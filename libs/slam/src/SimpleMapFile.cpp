#include "SimpleMapFile.h"

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/serialization/CArchive.h>
#include <semloop/config/Error.h>

#include <filesystem>
#include <optional>

#include "KeyFrameObservations.h"

namespace semloop
{
namespace
{
/** To an archive it is the CSimpleMap that it stands for. */
class KeyFramesOnDemand : public mrpt::maps::CSimpleMap
{
public:
	explicit KeyFramesOnDemand(const SemanticSlam& slam) : slam_(slam) {}

	/** An archive throws another one instead. */
	std::optional<InputError> unreadable() const { return unreadable_; }

protected:
	/** The layout below, whatever the installed MRPT writes itself: it reads the older ones too. */
	uint8_t serializeGetVersion() const override { return 1; }
	void serializeTo(mrpt::serialization::CArchive& out) const override
	{
		out.WriteAs<uint32_t>(slam_.keyFrames().size());
		for (const auto& key : slam_.keyFrames()) try
			{
				const auto observations = keyFrameObservations(slam_, key);
				out << mrpt::poses::CPose3DPDFGaussian(observations.T_world_robot)
					<< *observations.frame;
			}
			catch (const InputError& error)
			{
				unreadable_ = error;
				throw;
			}
	}

private:
	const SemanticSlam& slam_;
	mutable std::optional<InputError> unreadable_;
};
}  // namespace

void saveSimpleMap(const std::string& path, const SemanticSlam& slam)
{
	const auto cannotWrite = [&]
	{ return InputError(path + ": cannot be written; is the disk full?"); };
	const KeyFramesOnDemand keyFrames(slam);
	mrpt::io::CFileGZOutputStream file;
	if (!file.open(path)) throw cannotWrite();
	try
	{
		mrpt::serialization::archiveFrom(file) << keyFrames;
	}
	catch (const std::exception&)
	{
		file.close();
		std::error_code ignored;
		std::filesystem::remove(path, ignored);
		throw keyFrames.unreadable().value_or(cannotWrite());
	}
}

}  // namespace semloop

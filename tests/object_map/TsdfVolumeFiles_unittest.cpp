#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <semloop/object_map/TsdfVolume.h>

#include <array>

#include "TemporaryFolder.h"

using namespace semloop;

namespace
{
/** A volume of one block in which no voxel was observed, as allocation leaves it. */
TsdfVolume volumeWithAnUnseenBlock()
{
	mrpt::io::CMemoryStream stream;
	auto archive = mrpt::serialization::archiveFrom(stream);
	const TsdfOptions options;
	archive << uint8_t{0} << options.voxelSize << options.truncation << options.maxWeight
			<< static_cast<int32_t>(options.maxBlocks) << uint32_t{1};
	for (const int16_t index : {1, -2, 3}) archive << index;
	const std::array<uint8_t, TsdfBlock::voxels / 8> noVoxels{};
	archive.WriteBuffer(noVoxels.data(), noVoxels.size());
	stream.Seek(0);
	TsdfVolume volume;
	volume.serializeFrom(archive);
	return volume;
}
}  // namespace

TEST(TsdfVolumeFiles, ABlockWithoutAVoxelComesBackFromAGzFile)
{
	const TemporaryFolder folder;
	const TsdfVolume written = volumeWithAnUnseenBlock();
	ASSERT_EQ(written.blockCount(), 1u);
	{
		mrpt::io::CFileGZOutputStream file(folder.file("volume.gz"));
		auto archive = mrpt::serialization::archiveFrom(file);
		ASSERT_NO_THROW(written.serializeTo(archive));
		archive << uint32_t{0xC0FFEE};
	}
	mrpt::io::CFileGZInputStream file(folder.file("volume.gz"));
	auto archive = mrpt::serialization::archiveFrom(file);
	TsdfVolume read;
	ASSERT_NO_THROW(read.serializeFrom(archive));
	EXPECT_EQ(read.blockCount(), 1u);
	EXPECT_TRUE(read.surface().empty());
	uint32_t behind = 0;
	archive >> behind;
	EXPECT_EQ(behind, 0xC0FFEEu) << "what follows the volume is read from its place";
}

#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/TsdfVolume.h>

#include <array>

#include "TemporaryFolder.h"
#include "TsdfFixtures.h"

using namespace semloop;
using namespace semloop::testing;

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

TEST(TsdfVolumeFiles, SerialisationIsLossless)
{
	const auto volume = sphereFromAllAround();
	const auto bytes = bytesOf(volume);
	auto copy = volumeOf(bytes);
	EXPECT_EQ(bytesOf(copy), bytes);
	EXPECT_EQ(copy.blockCount(), volume.blockCount());
	EXPECT_EQ(copy.options().voxelSize, volume.options().voxelSize);
	const auto a = volume.surface(), b = copy.surface();
	ASSERT_EQ(a.size(), b.size());
	for (std::size_t i = 0; i < a.size(); ++i)
	{
		EXPECT_EQ(a[i].position, b[i].position);
		EXPECT_EQ(a[i].color.R, b[i].color.R);
	}
	EXPECT_EQ(copy.boundingBox()->min, volume.boundingBox()->min);

	// Both go on alike.
	auto original = volume;
	fuse(original, {sphere(radius)}, lookAt({0.9, 0.2, 0.1}));
	fuse(copy, {sphere(radius)}, lookAt({0.9, 0.2, 0.1}));
	EXPECT_EQ(bytesOf(copy), bytesOf(original));
}

TEST(TsdfVolumeFiles, DamagedFilesAreRefusedAndLeaveTheVolumeAlone)
{
	const auto good = bytesOf(sphereFromAllAround());
	const auto refuses = [&](std::size_t at, uint8_t value)
	{
		auto bytes = good;
		bytes.at(at) = value;
		EXPECT_THROW(volumeOf(bytes), InputError) << at;
	};
	refuses(0, 9);                     // version
	refuses(8, 0xFF);                  // sign of the voxel size (little endian, after the version)
	refuses(1 + 3 * 8 + 3, 0xFF);      // sign of maxBlocks
	refuses(1 + 3 * 8 + 4 + 3, 0xFF);  // number of blocks
	refuses(1 + 3 * 8 + 8 + 1, 0x70);  // first block's x
	refuses(1 + 3 * 8 + 8 + 6 + 64 + 3, 0x7F);  // exponent of the first distance

	auto cut = good;
	cut.resize(good.size() / 2);
	auto volume = sphereFromAllAround();
	mrpt::io::CMemoryStream stream;
	stream.assignMemoryNotOwn(cut.data(), cut.size());
	auto archive = mrpt::serialization::archiveFrom(stream);
	EXPECT_ANY_THROW(volume.serializeFrom(archive));
	EXPECT_EQ(bytesOf(volume), good);
}

TEST(TsdfVolumeFiles, TheSameFramesGiveTheSameBytes)
{
	EXPECT_EQ(bytesOf(sphereFromAllAround()), bytesOf(sphereFromAllAround()));
}

#include <gtest/gtest.h>
#include <semloop/object_map/TsdfVolume.h>

#include "TsdfFixtures.h"

using namespace semloop;
using namespace semloop::testing;

TEST(TsdfVolumeMerging, TwoHalvesGiveTheWhole)
{
	TsdfVolume first(options(voxel)), second(options(voxel)), all(options(voxel));
	const auto poses = posesAllAround(1.0);
	for (std::size_t i = 0; i < poses.size(); ++i)
	{
		fuse(i % 2 ? first : second, {sphere(radius)}, poses[i]);
		fuse(all, {sphere(radius)}, poses[i]);
	}
	first.merge(second, {});
	const auto merged = sphereError(first.surface());
	EXPECT_LT(merged.first, 0.2 * voxel);
	EXPECT_LT(merged.second, 0.8 * voxel);
	EXPECT_NEAR(
		static_cast<double>(first.surface().size()), static_cast<double>(all.surface().size()), 60);
}

TEST(TsdfVolumeMerging, PutsTheOtherVolumeWhereItStands)
{
	const auto other = sphereFromAllAround();
	TsdfVolume volume(options(0.012));
	const mrpt::poses::CPose3D T(0.3, -0.1, 0.05, 0.5, 0.2, -0.4);
	volume.merge(other, T);
	const auto [rms, largest] = sphereError(volume.surface(), {0.3, -0.1, 0.05});
	EXPECT_LT(rms, 0.15 * voxel);
	EXPECT_LT(largest, voxel);
	const auto bounds = volume.boundingBox();
	ASSERT_TRUE(bounds.has_value());
	EXPECT_NEAR(bounds->min.x, 0.3 - radius, 1.5 * voxel);
	EXPECT_NEAR(bounds->max.z, 0.05 + radius, 1.5 * voxel);
}

TEST(TsdfVolumeMerging, WithItselfOrWithNothingKeepsTheSurface)
{
	auto volume = sphereFromAllAround();
	const auto before = volume.surface();
	volume.merge(TsdfVolume(options(voxel)), {});
	EXPECT_EQ(volume.surface().size(), before.size());
	volume.merge(volume, {});
	const auto after = volume.surface();
	ASSERT_EQ(after.size(), before.size());
	for (std::size_t i = 0; i < after.size(); ++i)
		EXPECT_LT((eigen(after[i].position) - eigen(before[i].position)).norm(), 1e-4);
}

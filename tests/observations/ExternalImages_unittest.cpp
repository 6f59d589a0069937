#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/observations/ExternalImages.h>
#include <semloop/observations/RgbdFrame.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <set>

#include "TemporaryFolder.h"
#include "TestScan.h"

using namespace semloop;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

namespace
{
namespace fs = std::filesystem;

/** A folder with x.rawlog and two of its images. */
class ExternalImages : public testing::Test
{
protected:
	ExternalImages()
	{
		folder_.write("x.rawlog", "earlier");
		for (const char* image : {"color_000000.png", "depth_000000.bin"})
			folder_.write(std::string("x_Images/") + image, "earlier");
	}

	std::set<std::string> images(const std::string& of = "x_Images") const
	{
		std::set<std::string> names;
		for (const auto& entry : fs::directory_iterator(folder_.file(of)))
			names.insert(entry.path().filename().string());
		return names;
	}

	std::string errorOfBegin() const
	{
		return messageOf<InputError>([&] { beginExternalImages(folder_.file("x.rawlog")); });
	}

	const TemporaryFolder folder_;
};

TEST_F(ExternalImages, BeginWithoutTheRawlogAndTheImagesOfAnEarlierRun)
{
	for (const char* image : {"color_000001.jpg", "depth_1000000.bin"})
		folder_.write(std::string("x_Images/") + image, "earlier");
	for (const char* other : {"color_mine.png", "color_12.png", "my_color_000000.png", "notes.txt"})
		folder_.write(std::string("x_Images/") + other, "mine");
	EXPECT_EQ(beginExternalImages(folder_.file("x.rawlog")), folder_.file("x_Images"));
	EXPECT_FALSE(fs::exists(folder_.file("x.rawlog")));
	EXPECT_EQ(
		images(), (std::set<std::string>{
					  "color_mine.png", "color_12.png", "my_color_000000.png", "notes.txt"}));
}

TEST_F(ExternalImages, BeginWhereNothingWasBefore)
{
	EXPECT_EQ(beginExternalImages(folder_.file("y.rawlog")), folder_.file("y_Images"));
	EXPECT_TRUE(images("y_Images").empty());
	EXPECT_EQ(images().size(), 2u);
}

TEST_F(ExternalImages, StayWhenTheRawlogCannotBeRemoved)
{
	fs::remove(folder_.file("x.rawlog"));
	folder_.write("x.rawlog/inside", "");
	EXPECT_THAT(
		errorOfBegin(),
		AllOf(StartsWith(folder_.file("x.rawlog")), HasSubstr("cannot be removed")));
	EXPECT_EQ(images().size(), 2u);
}

TEST_F(ExternalImages, DoNotCostTheRawlogWhenTheirFolderCannotBeMade)
{
	fs::remove_all(folder_.file("x_Images"));
	folder_.write("x_Images", "a file");
	EXPECT_THAT(
		errorOfBegin(), AllOf(StartsWith(folder_.file("x_Images")), HasSubstr("cannot be made")));
	EXPECT_EQ(readBytes(folder_.file("x.rawlog")), "earlier");
}

TEST_F(ExternalImages, BehindALinkAreAnotherRawlogs)
{
	fs::rename(folder_.file("x_Images"), folder_.file("other_Images"));
	fs::create_directory_symlink("other_Images", folder_.file("x_Images"));
	EXPECT_THAT(
		errorOfBegin(), AllOf(StartsWith(folder_.file("x_Images")), HasSubstr("remove the link")));
	EXPECT_EQ(images("other_Images").size(), 2u);
	EXPECT_TRUE(fs::exists(folder_.file("x.rawlog")));
}

TEST_F(ExternalImages, OfAScanAreReadBackAsTheyWere)
{
	const auto scan = makeScan();
	const RgbdFrame inside = rgbdFrameFrom(*scan);
	const std::string folder = beginExternalImages(folder_.file("x.rawlog"));
	storeExternally(*scan, folder, 7, ".png");
	EXPECT_EQ(images(), (std::set<std::string>{"color_000007.png", "depth_000007.bin"}));
	EXPECT_EQ(scan->intensityImage.getExternalStorageFile(), "color_000007.png");
	resolveExternalImages(*scan, folder);
	const RgbdFrame outside = rgbdFrameFrom(*scan);
	EXPECT_EQ(cv::norm(inside.color, outside.color, cv::NORM_INF), 0);
	EXPECT_EQ(cv::norm(inside.depth, outside.depth, cv::NORM_INF), 0);
	EXPECT_THROW(storeExternally(*makeScan(), "/nonexistent", 0, ".png"), InputError);
}
}  // namespace

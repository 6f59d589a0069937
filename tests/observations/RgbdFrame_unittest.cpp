#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>
#include <semloop/config/Error.h>
#include <semloop/observations/CameraFrames.h>
#include <semloop/observations/ExternalImages.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RawlogWriter.h>
#include <semloop/observations/RgbdFrame.h>

#include <filesystem>
#include <functional>
#include <opencv2/imgcodecs.hpp>

#include "TemporaryFolder.h"
#include "TestScan.h"

using mrpt::obs::CObservation3DRangeScan;
using semloop::InputError;
using semloop::makeScan;
using semloop::rgbdFrameFrom;
using semloop::TemporaryFolder;

namespace
{
bool same(const cv::Mat& a, const cv::Mat& b)
{
	return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

/** Moves both images out to files in a folder; the scan keeps relative names. */
void moveOut(CObservation3DRangeScan& scan, const std::string& folder, const std::string& color)
{
	std::filesystem::create_directories(folder);
	const cv::Size size(int(scan.cameraParams.ncols), int(scan.cameraParams.nrows));
	cv::imwrite(folder + "/" + color, semloop::colorPattern(size));
	scan.intensityImage = mrpt::img::CImage();
	scan.intensityImage.setExternalStorage(color);
	semloop::storeDepthExternally(scan, folder, "depth.bin");
}

/** A rawlog with one frame whose images are external; returns its path. */
std::string externalRawlog(
	const TemporaryFolder& folder, const std::string& name, const std::string& color = "color.png")
{
	const auto path = folder.file(name + ".rawlog");
	auto scan = makeScan();
	moveOut(*scan, semloop::externalImagesFolder(path), color);
	semloop::RawlogWriter writer(path);
	writer.write(*scan);
	writer.close();
	return path;
}

CObservation3DRangeScan::Ptr firstScan(const std::string& path)
{
	return std::dynamic_pointer_cast<CObservation3DRangeScan>(semloop::RawlogReader(path).next());
}

std::string errorAfter(const std::function<void(CObservation3DRangeScan&)>& damage)
{
	const auto scan = makeScan();
	damage(*scan);
	return semloop::messageOf<InputError>([&] { rgbdFrameFrom(*scan); });
}

}  // namespace

TEST(RgbdFrame, DepthIsInMetresAndColourIsBgr)
{
	const auto frame = rgbdFrameFrom(*makeScan());
	ASSERT_EQ(frame.depth.type(), CV_32FC1);
	EXPECT_FLOAT_EQ(frame.depth.at<float>(10, 20), 10140 / 5000.0f);
	EXPECT_EQ(frame.depth.at<float>(0, 0), 0);
	EXPECT_TRUE(same(frame.color, semloop::colorPattern({64, 48})));
	EXPECT_EQ(semloop::countValidDepth(frame), 64 * 48 - 1);
	EXPECT_EQ(frame.time, mrpt::Clock::fromDouble(1305031453.374112));
}

TEST(RgbdFrame, RedIsTheThirdChannel)
{
	const auto scan = makeScan();
	scan->intensityImage.filledRectangle(0, 0, 63, 47, mrpt::img::TColor::red());
	EXPECT_EQ(rgbdFrameFrom(*scan).color.at<cv::Vec3b>(24, 32), cv::Vec3b(0, 0, 255));
}

TEST(RgbdFrame, GreyImagesBecomeBgr)
{
	const auto scan = makeScan();
	scan->intensityImage =
		mrpt::img::CImage(cv::Mat(48, 64, CV_8UC1, cv::Scalar(77)), mrpt::img::DEEP_COPY);
	EXPECT_EQ(rgbdFrameFrom(*scan).color.at<cv::Vec3b>(1, 1), cv::Vec3b(77, 77, 77));
}

TEST(RgbdFrame, OwnsItsImages)
{
	const auto scan = makeScan();
	const auto frame = rgbdFrameFrom(*scan);
	scan->intensityImage.filledRectangle(0, 0, 63, 47, mrpt::img::TColor::red());
	scan->rangeImage.fill(9);
	EXPECT_TRUE(same(frame.color, semloop::colorPattern({64, 48})));
	EXPECT_FLOAT_EQ(frame.depth.at<float>(10, 20), 10140 / 5000.0f);
}

TEST(RgbdFrame, TheCameraLooksWhereTheSensorLooks)
{
	const auto scan = makeScan();
	scan->sensorPose = mrpt::poses::CPose3D::FromXYZYawPitchRoll(1, 0, 0.5, 0, 0, 0);
	const auto p_robot =
		rgbdFrameFrom(*scan).T_robot_camera.composePoint(mrpt::math::TPoint3D(0, 0, 2));
	EXPECT_NEAR((p_robot - mrpt::math::TPoint3D(3, 0, 0.5)).norm(), 0, 1e-9);
}

TEST(RgbdFrame, ExternalImagesAreTheSameAsInsideAndStayUnloaded)
{
	const TemporaryFolder folder;
	const auto scan = firstScan(externalRawlog(folder, "a"));
	const auto inside = rgbdFrameFrom(*makeScan()), external = rgbdFrameFrom(*scan);
	EXPECT_TRUE(same(inside.color, external.color));
	EXPECT_TRUE(same(inside.depth, external.depth));
	EXPECT_EQ(scan->rangeImage.size(), 0);
	EXPECT_TRUE(scan->rangeImage_isExternallyStored());
	EXPECT_TRUE(scan->intensityImage.isExternallyStored());
}

TEST(RgbdFrame, ExternalImagesAreReadByMrptItself)
{
	const TemporaryFolder folder;
	const auto scan = firstScan(externalRawlog(folder, "a"));
	scan->load();
	ASSERT_EQ(scan->rangeImage.rows(), 48);
	ASSERT_EQ(scan->rangeImage.cols(), 64);
	EXPECT_EQ(scan->rangeImage(10, 20), semloop::depthPattern(10, 20));
	EXPECT_EQ(scan->intensityImage.getWidth(), 64u);
}

TEST(RgbdFrame, DepthThatMrptMovedOutIsReadToo)
{
	const TemporaryFolder folder;
	const auto scan = makeScan();
	scan->rangeImage_convertToExternalStorage("d.bin", folder.path().string() + "/");
	semloop::resolveExternalImages(*scan, folder.path().string());
	EXPECT_TRUE(same(rgbdFrameFrom(*scan).depth, rgbdFrameFrom(*makeScan()).depth));
}

TEST(RgbdFrame, TwoRawlogsWithImagesCanBeOpenAtOnce)
{
	const TemporaryFolder folder;
	const auto pathA = externalRawlog(folder, "a"), pathB = externalRawlog(folder, "b");
	cv::imwrite(folder.file("b_Images/color.png"), cv::Mat(48, 64, CV_8UC3, cv::Scalar(1, 2, 3)));
	semloop::RawlogReader a(pathA), b(pathB);
	const auto scanA = std::dynamic_pointer_cast<CObservation3DRangeScan>(a.next());
	const auto scanB = std::dynamic_pointer_cast<CObservation3DRangeScan>(b.next());
	EXPECT_EQ(rgbdFrameFrom(*scanB).color.at<cv::Vec3b>(9, 9), cv::Vec3b(1, 2, 3));
	EXPECT_TRUE(same(rgbdFrameFrom(*scanA).color, semloop::colorPattern({64, 48})));
}

TEST(RgbdFrame, ExternalImagesAreFoundFromARelativePath)
{
	const TemporaryFolder folder;
	const auto relative = std::filesystem::relative(externalRawlog(folder, "a")).string();
	EXPECT_EQ(semloop::countValidDepth(rgbdFrameFrom(*firstScan(relative))), 64 * 48 - 1);
}

TEST(RgbdFrame, AMissingOrDamagedExternalImageIsNamed)
{
	const TemporaryFolder folder;
	for (const std::string name : {"color.png", "color.jpg", "depth.bin"})
	{
		const auto color = name == "depth.bin" ? "color.png" : name;
		const auto scan = firstScan(externalRawlog(folder, "a", color));
		const auto path = folder.file("a_Images/" + name);
		const auto whole = semloop::readBytes(path);
		const auto error = [&]
		{ return semloop::messageOf<InputError>([&] { rgbdFrameFrom(*scan); }); };
		ASSERT_EQ(error(), "");
		for (const std::size_t length :
			 {whole.size() - 1, whole.size() / 2, std::size_t(5), std::size_t(0)})
		{
			folder.write("a_Images/" + name, whole.substr(0, length));
			EXPECT_EQ(error().find(path), 0u) << name << " cut to " << length << ": " << error();
		}
		std::filesystem::remove(path);
		EXPECT_EQ(error().find(path), 0u) << error();
	}
}

TEST(RgbdFrame, ExternalDepthOfAnotherSizeIsRefused)
{
	const TemporaryFolder folder;
	auto scan = makeScan();
	semloop::storeDepthExternally(*scan, folder.path().string(), "d.bin");
	EXPECT_EQ(
		semloop::readExternalDepth(folder.file("d.bin"), {64, 48})(3, 4),
		semloop::depthPattern(3, 4));
	EXPECT_THROW(semloop::readExternalDepth(folder.file("d.bin"), {48, 64}), InputError);
	EXPECT_THROW(semloop::storeDepthExternally(*makeScan(), "/nonexistent", "d.bin"), InputError);
}

TEST(RgbdFrame, RefusesAFrameThatIsNotOneRegisteredImage)
{
	EXPECT_EQ(errorAfter([](auto&) {}), "");
	const std::vector<std::function<void(CObservation3DRangeScan&)>> damages = {
		[](auto& s) { s.hasRangeImage = false; },
		[](auto& s) { s.hasIntensityImage = false; },
		[](auto& s) { s.intensityImage = mrpt::img::CImage(); },
		[](auto& s) { s.rangeImage.resize(48, 63); },
		[](auto& s) { s.cameraParamsIntensity.ncols = 65; },
		[](auto& s) { s.range_is_depth = false; },
		[](auto& s) { s.rangeUnits = 0; },
		[](auto& s) { s.relativePoseIntensityWRTDepth.x(0.025); },
		[](auto& s) { s.cameraParams.fx(60); },
		[](auto& s) { s.cameraParams.fx(0), s.cameraParamsIntensity.fx(0); }};
	for (std::size_t i = 0; i < damages.size(); i++)
	{
		const auto error = errorAfter(damages[i]);
		EXPECT_EQ(error.find("frame at 1305031453.374112 of sensor 'RGBD': "), 0u) << i << error;
	}
}

TEST(RgbdFrame, ImagesBecomeAScanAndComeBack)
{
	const cv::Size size(64, 48);
	cv::Mat wide(size.height, 2 * size.width, CV_16UC1);
	cv::randu(wide, 0, 65536);
	const cv::Mat depth = wide.colRange(0, size.width);  // its rows are apart
	const auto scan = semloop::rangeScanFrom(
		semloop::colorPattern(size), depth, 1.0f / 5000, semloop::smallCamera());
	EXPECT_EQ(scan->sensorLabel, "RGBD");
	const auto frame = rgbdFrameFrom(*scan);
	EXPECT_TRUE(same(frame.color, semloop::colorPattern(size)));
	cv::Mat units;
	frame.depth.convertTo(units, CV_16U, 5000);
	EXPECT_TRUE(same(units, depth));
	EXPECT_TRUE(frame.camera == semloop::smallCamera());
	EXPECT_TRUE(scan->doDepthAndIntensityCamerasCoincide());
}

TEST(RgbdFrame, AFrameWithoutDepthIsTheCallersDecision)
{
	const auto scan = makeScan();
	scan->rangeImage.fill(0);
	EXPECT_EQ(semloop::countValidDepth(rgbdFrameFrom(*scan)), 0);
}

TEST(RgbdFrame, RefusesTheFrameThatMrptShipsBecauseItIsNotRegistered)
{
	const std::string path = "/usr/share/mrpt/datasets/tests_rgbd.rawlog";
	if (!std::filesystem::exists(path)) GTEST_SKIP() << "needs " << path << " (mrpt-common)";
	const auto scan = firstScan(path);
	ASSERT_TRUE(scan);
	const auto error = semloop::messageOf<InputError>([&] { rgbdFrameFrom(*scan); });
	EXPECT_NE(error.find("register depth to colour"), std::string::npos) << error;

	scan->relativePoseIntensityWRTDepth = semloop::sensorFromCamera();
	scan->cameraParams = scan->cameraParamsIntensity;
	EXPECT_GT(semloop::countValidDepth(rgbdFrameFrom(*scan)), 100'000);
}

#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/observations/Rectifier.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

using mrpt::img::TCamera;
using semloop::CObservationInstances;
using semloop::Instance;
using semloop::InstanceMask;
using semloop::Rectifier;
using semloop::RgbdFrame;

namespace
{
TCamera freiburg1()
{
	TCamera camera;
	camera.ncols = 640;
	camera.nrows = 480;
	camera.setIntrinsicParamsFromValues(517.3, 516.5, 318.6, 255.3);
	camera.setDistortionPlumbBob(0.2624, -0.9531, -0.0054, 0.0026, 1.1633);
	return camera;
}

/** Brown-Conrady, written out: where the ray (x, y, 1) is seen through the lens. */
cv::Point2d project(const TCamera& c, double x, double y)
{
	const double r2 = x * x + y * y;
	const double radial = 1 + r2 * (c.k1() + r2 * (c.k2() + r2 * c.k3()));
	const double xd = x * radial + 2 * c.p1() * x * y + c.p2() * (r2 + 2 * x * x);
	const double yd = y * radial + c.p1() * (r2 + 2 * y * y) + 2 * c.p2() * x * y;
	return {c.fx() * xd + c.cx(), c.fy() * yd + c.cy()};
}

cv::Point2d projectPinhole(const TCamera& c, double x, double y)
{
	return {c.fx() * x + c.cx(), c.fy() * y + c.cy()};
}

RgbdFrame blackFrame(const TCamera& camera)
{
	RgbdFrame frame;
	frame.camera = camera;
	frame.color = cv::Mat(int(camera.nrows), int(camera.ncols), CV_8UC3, cv::Scalar::all(0));
	frame.depth = cv::Mat(frame.color.size(), CV_32FC1, cv::Scalar(0));
	return frame;
}

Instance instanceOf(const cv::Mat& mask)
{
	Instance instance;
	instance.mask = InstanceMask::encode(mask);
	instance.box = instance.mask.boundingBox();
	instance.labelScores = {{0, 0.5f}};
	instance.confidence = 0.5f;
	instance.embedding = {1, 0};
	instance.trueObject = 5;
	return instance;
}

CObservationInstances observe(const TCamera& camera, std::vector<Instance> instances)
{
	CObservationInstances o;
	o.timestamp = mrpt::Clock::fromDouble(12);
	o.sensorLabel = "RGBD";
	o.camera = camera;
	o.labels = semloop::LabelSet({"thing"});
	o.instances = std::move(instances);
	return o;
}

}  // namespace

TEST(Rectifier, APointSeenThroughTheLensLandsAtItsPinholePixel)
{
	const TCamera camera = freiburg1();
	for (const auto& [x, y] :
		 {std::pair{0.0, 0.0}, {0.3, 0.2}, {-0.5, 0.3}, {0.5, -0.4}, {-0.45, -0.4}})
	{
		RgbdFrame frame = blackFrame(camera);
		const cv::Point2d seen = project(camera, x, y);
		for (int v = int(seen.y) - 4; v <= int(seen.y) + 5; v++)
			for (int u = int(seen.x) - 4; u <= int(seen.x) + 5; u++)
			{
				const double weight =
					std::exp(-(std::pow(u - seen.x, 2) + std::pow(v - seen.y, 2)) / 4);
				frame.color.at<cv::Vec3b>(v, u) = cv::Vec3b::all(uint8_t(255 * weight));
			}
		cv::Mat grey;
		cv::cvtColor(Rectifier().rectify(frame).color, grey, cv::COLOR_BGR2GRAY);
		const cv::Moments m = cv::moments(grey);
		const cv::Point2d expected = projectPinhole(camera, x, y);
		EXPECT_NEAR(m.m10 / m.m00, expected.x, 0.1);
		EXPECT_NEAR(m.m01 / m.m00, expected.y, 0.1);
	}
}

TEST(Rectifier, DepthIsTakenFromTheNearestPixelAndNeverMixed)
{
	RgbdFrame frame = blackFrame(freiburg1());
	for (int v = 0; v < 480; v++)
		for (int u = 0; u < 640; u++)
			frame.depth.at<float>(v, u) = float(1 + u + 640 * v);  // tells which pixel it is
	const cv::Mat depth = Rectifier().rectify(frame).depth;
	for (int v = 0; v < 480; v += 7)
		for (int u = 0; u < 640; u += 7)
		{
			const double x = (u - 318.6) / 517.3, y = (v - 255.3) / 516.5;
			const cv::Point2d source = project(frame.camera, x, y);
			const auto value = int(depth.at<float>(v, u));
			if (value == 0)
			{
				const bool outside =
					source.x < 0 || source.y < 0 || source.x > 639 || source.y > 479;
				EXPECT_TRUE(outside) << u << "," << v;
				continue;
			}
			ASSERT_NEAR((value - 1) % 640, source.x, 0.51) << u << "," << v;
			ASSERT_NEAR((value - 1) / 640, source.y, 0.51) << u << "," << v;
		}
}

TEST(Rectifier, TheNewCameraIsThePinholeWithTheSameMatrix)
{
	const auto out = Rectifier().rectify(blackFrame(freiburg1()));
	EXPECT_FALSE(semloop::hasDistortion(out.camera));
	EXPECT_TRUE(out.camera.intrinsicParams == freiburg1().intrinsicParams);
	EXPECT_EQ(out.color.size(), cv::Size(640, 480));
}

TEST(Rectifier, ACameraWithoutDistortionSharesItsImages)
{
	TCamera camera = freiburg1();
	camera.setDistortionPlumbBob(0, 0, 0, 0, 0);
	EXPECT_FALSE(semloop::hasDistortion(camera));
	const RgbdFrame frame = blackFrame(camera);
	const RgbdFrame out = Rectifier().rectify(frame);
	EXPECT_EQ(out.color.data, frame.color.data);
	EXPECT_EQ(out.depth.data, frame.depth.data);
}

TEST(Rectifier, MasksGoWhereTheDepthGoes)
{
	const TCamera camera = freiburg1();
	cv::RNG random(3);
	Rectifier rectifier;
	for (int i = 0; i < 20; i++)
	{
		cv::Mat mask(480, 640, CV_8UC1, cv::Scalar(0));
		const cv::Point centre(random.uniform(0, 640), random.uniform(0, 480));
		cv::ellipse(
			mask, centre, {random.uniform(1, 200), random.uniform(1, 150)}, random.uniform(0, 180),
			0, 360, cv::Scalar(255), cv::FILLED);
		RgbdFrame frame = blackFrame(camera);
		mask.convertTo(frame.depth, CV_32F);

		const auto out = rectifier.rectify(observe(camera, {instanceOf(mask)}));
		const cv::Mat expected = rectifier.rectify(frame).depth > 0;
		if (cv::countNonZero(expected) == 0)
		{
			EXPECT_TRUE(out->instances.empty());
			continue;
		}
		ASSERT_EQ(out->instances.size(), 1u);
		EXPECT_EQ(cv::countNonZero(out->instances[0].mask.decode() != expected), 0);
		const cv::Rect box = out->instances[0].box, maskBox = out->instances[0].mask.boundingBox();
		EXPECT_EQ(box & maskBox, maskBox);
		EXPECT_LE(box.width + box.height, maskBox.width + maskBox.height + 12);  // bent edges
		EXPECT_NO_THROW(out->validate());
	}
}

TEST(Rectifier, TheDepthCropFollowsItsBox)
{
	const TCamera camera = freiburg1();
	cv::Mat mask(480, 640, CV_8UC1, cv::Scalar(0));
	mask(cv::Rect(30, 40, 120, 90)) = 255;
	Instance instance = instanceOf(mask);
	instance.box = {20, 30, 150, 120};
	cv::Mat crop(instance.box.size(), CV_16UC1);
	cv::RNG(4).fill(crop, cv::RNG::UNIFORM, 1, 65536);
	instance.depth = semloop::DepthCrop{crop, 0.0002f};
	RgbdFrame frame = blackFrame(camera);
	crop.convertTo(frame.depth(instance.box), CV_32F);

	Rectifier rectifier;
	const auto out = rectifier.rectify(observe(camera, {instance}));
	ASSERT_EQ(out->instances.size(), 1u);
	const Instance& got = out->instances[0];
	cv::Mat expected;
	const cv::Mat whole = rectifier.rectify(frame).depth;
	EXPECT_EQ(cv::boundingRect(cv::Mat(whole > 0)), got.box);
	whole(got.box).convertTo(expected, CV_16U);
	EXPECT_EQ(cv::countNonZero(got.depth->depth != expected), 0);
	EXPECT_EQ(got.depth->unit, 0.0002f);
}

TEST(Rectifier, KeepsWhatHasNothingToDoWithPixels)
{
	cv::Mat mask(480, 640, CV_8UC1, cv::Scalar(0));
	mask(cv::Rect(300, 200, 20, 20)) = 255;
	const auto in = observe(freiburg1(), {instanceOf(mask)});
	const auto out = Rectifier().rectify(in);
	EXPECT_EQ(out->timestamp, in.timestamp);
	EXPECT_EQ(out->sensorLabel, in.sensorLabel);
	EXPECT_EQ(out->labels, in.labels);
	EXPECT_EQ(out->instances[0].embedding, in.instances[0].embedding);
	EXPECT_EQ(out->instances[0].trueObject, in.instances[0].trueObject);
	EXPECT_EQ(out->instances[0].labelScores, in.instances[0].labelScores);
	EXPECT_EQ(out->instances[0].confidence, in.instances[0].confidence);
}

TEST(Rectifier, AnInstanceThatLeavesTheImageIsDropped)
{
	TCamera camera = freiburg1();
	camera.setDistortionPlumbBob(-0.3, 0, 0, 0, 0);  // barrel: the corners are pushed outwards
	cv::Mat corner(480, 640, CV_8UC1, cv::Scalar(0)), middle = corner.clone();
	corner(cv::Rect(0, 0, 4, 4)) = 255;
	middle(cv::Rect(300, 200, 4, 4)) = 255;
	const auto out = Rectifier().rectify(observe(camera, {instanceOf(corner), instanceOf(middle)}));
	ASSERT_EQ(out->instances.size(), 1u);
	EXPECT_TRUE(out->instances[0].mask.contains(302, 202));
}

TEST(Rectifier, FollowsAChangeOfCamera)
{
	TCamera other = freiburg1();
	other.k1(-0.1);
	const cv::Mat noise = []
	{
		cv::Mat m(480, 640, CV_8UC3);
		cv::RNG(1).fill(m, cv::RNG::UNIFORM, 0, 256);
		return m;
	}();
	RgbdFrame a = blackFrame(freiburg1()), b = blackFrame(other);
	a.color = b.color = noise;
	Rectifier used;
	used.rectify(a);
	EXPECT_EQ(cv::norm(used.rectify(b).color, Rectifier().rectify(b).color), 0.0);
	EXPECT_GT(cv::norm(used.rectify(a).color, used.rectify(b).color), 0.0);
}

TEST(Rectifier, KnowsFishEyes)
{
	TCamera camera = freiburg1();
	camera.setDistortionKannalaBrandt(0.01, -0.002, 0.0005, 0);
	RgbdFrame frame = blackFrame(camera);
	const double x = 0.4, y = 0.3, r = std::hypot(x, y), t = std::atan(r);
	const double td = t * (1 + 0.01 * t * t - 0.002 * std::pow(t, 4) + 0.0005 * std::pow(t, 6));
	const auto seen = projectPinhole(camera, x * td / r, y * td / r);
	cv::circle(frame.depth, seen, 2, cv::Scalar(1), cv::FILLED);
	const auto expected = projectPinhole(camera, x, y);
	EXPECT_EQ(
		Rectifier().rectify(frame).depth.at<float>(cvRound(expected.y), cvRound(expected.x)), 1);
}

TEST(Rectifier, RefusesImagesThatAreNotTheCameras)
{
	RgbdFrame frame = blackFrame(freiburg1());
	frame.depth = cv::Mat(240, 320, CV_32FC1, cv::Scalar(0));
	EXPECT_THROW(Rectifier().rectify(frame), semloop::InputError);
}

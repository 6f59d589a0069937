#include <benchmark/benchmark.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/Rectifier.h>
#include <semloop/observations/RgbdFrame.h>

#include <cstdlib>
#include <opencv2/core.hpp>

namespace
{
using namespace semloop;

mrpt::img::TCamera freiburg1()
{
	mrpt::img::TCamera camera;
	camera.ncols = 640;
	camera.nrows = 480;
	camera.setIntrinsicParamsFromValues(517.3, 516.5, 318.6, 255.3);
	camera.setDistortionPlumbBob(0.2624, -0.9531, -0.0054, 0.0026, 1.1633);
	return camera;
}

/** A disc with a hole. */
InstanceMask ring(cv::Point centre, double radius)
{
	cv::Mat mask(480, 640, CV_8UC1, cv::Scalar(0));
	for (int v = 0; v < mask.rows; v++)
		for (int u = 0; u < mask.cols; u++)
		{
			const double r = cv::norm(cv::Point(u, v) - centre);
			if (r < radius && r > radius / 3) mask.at<uint8_t>(v, u) = 255;
		}
	return InstanceMask::encode(mask);
}

CObservationInstances observation(int count)
{
	CObservationInstances o;
	o.camera = freiburg1();
	o.labels = LabelSet::coco();
	cv::RNG random(1);
	for (int i = 0; i < count; i++)
	{
		Instance instance;
		instance.mask = ring({random.uniform(80, 560), random.uniform(80, 400)}, 75);
		instance.box = instance.mask.boundingBox();
		instance.labelScores = {{56, 0.9f}};
		instance.embedding.assign(1024, 1.0f / 32);
		o.instances.push_back(instance);
	}
	return o;
}

void encodeMask(benchmark::State& state)
{
	const cv::Mat mask = ring({300, 200}, 75).decode();
	for (auto _ : state) benchmark::DoNotOptimize(InstanceMask::encode(mask));
}
BENCHMARK(encodeMask)->Unit(benchmark::kMicrosecond);

void intersectionOverUnionOfMasks(benchmark::State& state)
{
	const auto a = ring({300, 200}, 75), b = ring({330, 220}, 75);
	for (auto _ : state) benchmark::DoNotOptimize(intersectionOverUnion(a, b));
}
BENCHMARK(intersectionOverUnionOfMasks)->Unit(benchmark::kMicrosecond);

void rectifyInstances(benchmark::State& state)
{
	const auto o = observation(int(state.range(0)));
	Rectifier rectifier;
	rectifier.rectify(o);
	for (auto _ : state) benchmark::DoNotOptimize(rectifier.rectify(o));
}
BENCHMARK(rectifyInstances)->Arg(10)->Unit(benchmark::kMicrosecond);

void rectifyFrame(benchmark::State& state)
{
	RgbdFrame frame;
	frame.camera = freiburg1();
	frame.color = cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(9));
	frame.depth = cv::Mat(480, 640, CV_32FC1, cv::Scalar(1));
	Rectifier rectifier;
	rectifier.rectify(frame);
	for (auto _ : state) benchmark::DoNotOptimize(rectifier.rectify(frame));
}
BENCHMARK(rectifyFrame)->Unit(benchmark::kMillisecond);

/** The first frame of a rawlog that tum2rawlog made, JPEG and depth in files. */
void readExternalFrame(benchmark::State& state)
{
	const char* const path = std::getenv("SEMLOOP_RAWLOG");
	if (!path)
	{
		state.SkipWithError("set SEMLOOP_RAWLOG to a rawlog made by tum2rawlog");
		return;
	}
	RawlogReader reader(path);
	mrpt::obs::CObservation3DRangeScan::Ptr scan;
	while (!scan)
		scan = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(reader.next());
	for (auto _ : state) benchmark::DoNotOptimize(rgbdFrameFrom(*scan));
}
BENCHMARK(readExternalFrame)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();

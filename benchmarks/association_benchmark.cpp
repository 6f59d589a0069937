#include <benchmark/benchmark.h>
#include <semloop/association/InstanceTracker.h>
#include <semloop/association/ObjectAssociator.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <random>

using namespace semloop;

namespace
{
enum Kind
{
	kUniform,  //!< every cost uniform in [0, 1], no gate
	kGated  //!< as Eq. (3) gives them: most pairs 1 or forbidden, one good landmark a detection; gate 0.8
};

CostMatrix costs(int rows, int columns, int kind, unsigned seed)
{
	std::mt19937 random(seed);
	std::uniform_real_distribution<double> uniform(0, 1);
	CostMatrix cost(rows, columns);
	for (Eigen::Index i = 0; i < cost.size(); ++i)
	{
		const double draw = uniform(random);
		cost.data()[i] = kind == kUniform ? draw
						 : draw < 0.5     ? std::numeric_limits<double>::infinity()
						 : draw < 0.9     ? 1.0
										  : 0.5 + 0.5 * uniform(random);
	}
	const int smaller = std::min(rows, columns);
	for (int i = 0; kind == kGated && i < smaller; ++i)
		(rows <= columns ? cost(i, 3 * i % columns) : cost(3 * i % rows, i)) =
			0.4 * uniform(random);
	return cost;
}

void assignment(benchmark::State& state)
{
	constexpr unsigned kProblems = 16;
	std::vector<CostMatrix> problems;
	for (unsigned seed = 0; seed < kProblems; ++seed)
		problems.push_back(
			costs(int(state.range(0)), int(state.range(1)), int(state.range(2)), seed));
	const double gate = state.range(2) == kGated ? 0.8 : std::numeric_limits<double>::infinity();
	std::size_t i = 0;
	for (auto _ : state) benchmark::DoNotOptimize(solveAssignment(problems[i++ % kProblems], gate));
}
BENCHMARK(assignment)
	->ArgNames({"rows", "columns", "gated"})
	->Args({10, 50, kUniform})
	->Args({10, 50, kGated})
	->Args({50, 10, kUniform})
	->Args({100, 1000, kUniform})
	->Args({100, 1000, kGated})
	->Args({1000, 100, kUniform})
	->Args({300, 300, kUniform})
	->Unit(benchmark::kMicrosecond);

std::shared_ptr<SemanticMatchingCost> matchingCost()
{
	auto cost = std::make_shared<SemanticMatchingCost>();
	cost->setConfusionMatrix(ConfusionMatrix(LabelSet::coco(), 0.9));
	return cost;
}

std::vector<float> unitVector(std::mt19937& random, int size)
{
	std::normal_distribution<float> normal;
	Eigen::VectorXf v(size);
	for (auto& value : v) value = normal(random);
	v.normalize();
	return {v.data(), v.data() + size};
}

/** An ellipse of the size that objects have in a 640 x 480 picture. */
InstanceMask ellipse(std::mt19937& random, const cv::Size& image)
{
	std::uniform_int_distribution<int> side(60, 200);
	const int width = side(random), height = side(random);
	const cv::Point origin(
		std::uniform_int_distribution<int>(0, image.width - width)(random),
		std::uniform_int_distribution<int>(0, image.height - height)(random));
	cv::Mat mask(height, width, CV_8UC1, cv::Scalar(0));
	for (int y = 0; y < height; ++y)
		for (int x = 0; x < width; ++x)
		{
			const double u = 2.0 * x / width - 1, v = 2.0 * y / height - 1;
			if (u * u + v * v < 1) mask.at<uint8_t>(y, x) = 255;
		}
	return InstanceMask::encode(mask, origin, image);
}

struct Thing
{
	InstanceMask mask;
	LabelScores labelScores;
	std::vector<std::vector<float>> embeddings;
};

std::vector<Thing> things(int count, int embeddings, std::mt19937& random)
{
	std::vector<Thing> all(count);
	for (auto& thing : all)
	{
		thing.mask = ellipse(random, {640, 480});
		const auto label = std::uniform_int_distribution<uint32_t>(0, 79)(random);
		thing.labelScores = {{label, 0.8f}, {(label + 1) % 80, 0.15f}};
		for (int i = 0; i < embeddings; ++i) thing.embeddings.push_back(unitVector(random, 1024));
	}
	return all;
}

std::vector<AssociationItem> items(const std::vector<Thing>& things)
{
	std::vector<AssociationItem> all;
	for (const auto& thing : things)
		all.push_back({&thing.mask, &thing.labelScores, &thing.embeddings, std::nullopt});
	return all;
}

/** Eq. (3) of 30 landmarks with 10 embeddings each and 10 detections, 1024 numbers an embedding. */
void matchingCostMatrix(benchmark::State& state)
{
	std::mt19937 random(1);
	const auto landmarks = things(30, 10, random), detections = things(10, 1, random);
	const auto rows = items(landmarks), columns = items(detections);
	const auto cost = matchingCost();
	for (auto _ : state) benchmark::DoNotOptimize(matchingCosts(*cost, rows, columns));
}
BENCHMARK(matchingCostMatrix)->Unit(benchmark::kMicrosecond);

/** A frame with 10 detections and as many tracks, the camera moving to and fro. */
void trackerFrame(benchmark::State& state)
{
	std::mt19937 random(2);
	RgbdFrame frame;
	frame.camera.ncols = 640;
	frame.camera.nrows = 480;
	frame.camera.setIntrinsicParamsFromValues(525, 525, 319.5, 239.5);
	frame.depth = cv::Mat(480, 640, CV_32FC1);
	for (int y = 0; y < 480; ++y)
		for (int x = 0; x < 640; ++x) frame.depth.at<float>(y, x) = 1.5f + 0.001f * float(x + y);
	CObservationInstances observation;
	for (const auto& thing : things(10, 1, random))
	{
		Instance instance;
		instance.mask = thing.mask;
		instance.labelScores = thing.labelScores;
		instance.embedding = thing.embeddings.front();
		instance.confidence = 0.9f;
		observation.instances.push_back(instance);
	}
	InstanceTracker tracker({}, matchingCost());
	double step = 0.01;
	for (auto _ : state)
	{
		const mrpt::poses::CPose3D T_previous_camera(step, 0, step, 0.5 * step, 0, 0);
		benchmark::DoNotOptimize(tracker.track(frame, observation, T_previous_camera));
		step = -step;
	}
	state.counters["tracks"] = double(tracker.trackCount());
}
BENCHMARK(trackerFrame)->Unit(benchmark::kMicrosecond);
}  // namespace

BENCHMARK_MAIN();

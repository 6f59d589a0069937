#include <benchmark/benchmark.h>
#include <semloop/loop_closure/PlaceSearch.h>
#include <semloop/loop_closure/SpectralMatcher.h>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>

namespace
{
using namespace semloop;

/** One object per square metre, 2.5 m high. */
SemanticGraph randomObjects(std::size_t objects, int labels, unsigned seed)
{
	std::mt19937 random(seed);
	std::uniform_real_distribution<double> unit(0, 1);
	const double side = std::sqrt(static_cast<double>(objects));
	SemanticGraph map;
	for (std::size_t i = 0; i < objects; ++i)
	{
		GraphVertex vertex;
		vertex.id = i;
		vertex.label = "class" + std::to_string(static_cast<int>(unit(random) * labels));
		vertex.position = {unit(random) * side, unit(random) * side, unit(random) * 2.5};
		map.vertices.push_back(vertex);
	}
	return map;
}

/** Same; pairs closer than 4 m are co-visible. */
SemanticGraph randomMap(std::size_t objects, int labels, unsigned seed)
{
	SemanticGraph map = randomObjects(objects, labels, seed);
	for (std::size_t a = 0; a < objects; ++a)
		for (std::size_t b = a + 1; b < objects; ++b)
			if (map.distance(a, b) < 4) map.edges.insert({a, b});
	return map;
}

/** The objects nearest to the middle of the map with 5 cm of noise, moved, all co-visible. */
SemanticGraph localMap(const SemanticGraph& map, std::size_t objects, unsigned seed)
{
	std::mt19937 random(seed);
	std::normal_distribution<double> noise(0, 0.05);
	const double middle = std::sqrt(static_cast<double>(map.vertices.size())) / 2;
	auto byDistance = map.vertices;
	const auto fromMiddle = [&](const GraphVertex& v)
	{ return std::hypot(v.position.x - middle, v.position.y - middle); };
	std::sort(
		byDistance.begin(), byDistance.end(),
		[&](const auto& a, const auto& b) { return fromMiddle(a) < fromMiddle(b); });
	SemanticGraph local;
	for (std::size_t i = 0; i < objects; ++i)
	{
		GraphVertex vertex = byDistance[i];
		const auto p = vertex.position;
		vertex.position = {-p.y + 3 + noise(random), p.x - 1 + noise(random), p.z + noise(random)};
		local.vertices.push_back(vertex);
		for (std::size_t a = 0; a < i; ++a) local.edges.insert({a, i});
	}
	return local;
}

/** Arguments: query objects, target objects, labels. */
void spectralMatch(benchmark::State& state)
{
	const auto target = randomMap(state.range(1), static_cast<int>(state.range(2)), 1);
	const auto query = localMap(target, state.range(0), 2);
	const SpectralMatcher matcher;
	for (auto _ : state) benchmark::DoNotOptimize(matcher.match(query, target));
}
BENCHMARK(spectralMatch)->Args({15, 60, 10})->Unit(benchmark::kMillisecond);

/** Arguments: as above. The map is indexed before. */
void placeSearch(benchmark::State& state)
{
	const auto target = randomObjects(state.range(1), static_cast<int>(state.range(2)), 1);
	const auto query = localMap(target, state.range(0), 2);
	const GraphIndex index(target);
	for (auto _ : state) benchmark::DoNotOptimize(PlaceSearch(query, index).places());
}
BENCHMARK(placeSearch)
	->Args({15, 60, 10})
	->Args({13, 216, 15})
	->Args({20, 10000, 20})
	->Unit(benchmark::kMillisecond);

/** Whole maps of N = M objects, 20 labels, against each other. */
void placeSearchOfWholeMaps(benchmark::State& state)
{
	const auto target = randomObjects(state.range(0), 20, 1);
	const auto query = localMap(target, state.range(0), 2);
	const GraphIndex index(target);
	for (auto _ : state) benchmark::DoNotOptimize(PlaceSearch(query, index).places());
}
BENCHMARK(placeSearchOfWholeMaps)->Arg(50)->Arg(200)->Arg(500)->Unit(benchmark::kMillisecond);

void graphIndex(benchmark::State& state)
{
	const auto target = randomObjects(state.range(0), 20, 1);
	for (auto _ : state) benchmark::DoNotOptimize(GraphIndex(target));
}
BENCHMARK(graphIndex)->Arg(216)->Arg(10000)->Unit(benchmark::kMillisecond);

/** Share of zeros among the (N M)^2 entries of S, Eq. (5): off its diagonal there is an entry for two
 *  edges that join the same labels. */
double sparsity(const SemanticGraph& query, const SemanticGraph& target)
{
	const auto edgesByLabels = [](const SemanticGraph& graph)
	{
		std::map<std::pair<std::string, std::string>, double> count;
		for (const auto& [a, b] : graph.edges)
		{
			const std::string &la = graph.vertices[a].label, &lb = graph.vertices[b].label;
			++count[{la, lb}];
			++count[{lb, la}];
		}
		return count;
	};
	const auto queryEdges = edgesByLabels(query), targetEdges = edgesByLabels(target);
	double entries = 0;
	for (const auto& q : query.vertices)
		for (const auto& t : target.vertices) entries += q.label == t.label;
	for (const auto& [labels, count] : queryEdges)
		if (const auto same = targetEdges.find(labels); same != targetEdges.end())
			entries += count * same->second;
	return 1 - entries / std::pow(double(query.vertices.size() * target.vertices.size()), 2);
}

/** Whole maps of N = M objects against each other. Arguments: objects, labels. */
void spectralMatchOfWholeMaps(benchmark::State& state)
{
	const auto target = randomMap(state.range(0), static_cast<int>(state.range(1)), 1);
	const auto query = target;
	const SpectralMatcher matcher;
	for (auto _ : state) benchmark::DoNotOptimize(matcher.match(query, target));
	state.counters["sparsity"] = sparsity(query, target);
}
BENCHMARK(spectralMatchOfWholeMaps)
	->ArgsProduct({{25, 50, 100, 200}, {5, 10, 20, 40}})
	->Unit(benchmark::kMillisecond);

/** An object and the nearest that were seen with it, twelve in all: what a local map has. */
SemanticGraph neighbourhood(const SemanticGraph& map, std::size_t centre)
{
	std::vector<std::size_t> members;
	for (std::size_t i = 0; i < map.vertices.size(); ++i)
		if (i == centre || map.hasEdge(i, centre)) members.push_back(i);
	std::sort(
		members.begin(), members.end(),
		[&](std::size_t a, std::size_t b)
		{ return map.distance(a, centre) < map.distance(b, centre); });
	members.resize(std::min<std::size_t>(members.size(), 12));
	std::sort(members.begin(), members.end());
	SemanticGraph graph;
	for (std::size_t a = 0; a < members.size(); ++a)
	{
		graph.vertices.push_back(map.vertices[members[a]]);
		for (std::size_t b = 0; b < a; ++b)
			if (map.hasEdge(members[b], members[a])) graph.edges.insert({b, a});
	}
	return graph;
}

/** The neighbourhood of one object after the other against the whole map of a run, its objects.json. */
void spectralMatchOfRun(benchmark::State& state, const std::string& file)
{
	const auto target = SemanticGraph::load(file);
	std::vector<SemanticGraph> queries;
	double sparsities = 0, sizes = 0;
	for (std::size_t i = 0; i < target.vertices.size(); ++i)
	{
		queries.push_back(neighbourhood(target, i));
		sparsities += sparsity(queries.back(), target);
		sizes += double(queries.back().vertices.size());
	}
	const SpectralMatcher matcher;
	for (auto _ : state)
		for (const auto& query : queries) benchmark::DoNotOptimize(matcher.match(query, target));
	state.counters["queries"] = double(queries.size());
	state.counters["objects"] = double(target.vertices.size());
	state.counters["query_objects"] = sizes / double(queries.size());
	state.counters["sparsity"] = sparsities / double(queries.size());
}

}  // namespace

/** What is left of the arguments are the objects.json of runs. */
int main(int argc, char** argv)
{
	benchmark::Initialize(&argc, argv);
	for (int i = 1; i < argc; ++i)
		benchmark::RegisterBenchmark(
			(std::string("spectralMatchOfRun/") + argv[i]).c_str(), spectralMatchOfRun,
			std::string(argv[i]))
			->Unit(benchmark::kMillisecond);
	benchmark::RunSpecifiedBenchmarks();
	benchmark::Shutdown();
}

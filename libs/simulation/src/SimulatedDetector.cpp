#include <semloop/config/Error.h>
#include <semloop/simulation/SimulatedDetector.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "Random.h"
#include "SimulatedEmbedding.h"
#include "SimulatedLabels.h"
#include "SimulatedMasks.h"
#include "VisibleObjects.h"

namespace semloop
{
namespace
{
// How fast misses grow with the hidden share, and with 1 / area.
constexpr double kHiddenWidth = 0.07;
constexpr double kAreaPower = 2.0;

CObservationInstances emptyObservation(const RenderedView& view, const Scene& scene)
{
	CObservationInstances observation;
	observation.camera = view.camera;
	observation.labels = scene.labels;
	return observation;
}

/** 1 - (1 - rate) P(large enough) P(open enough), both logistic: in log(area) and in the share. */
double missProbability(double area, double hidden, const SimulatedDetectorOptions& o)
{
	const double seenSmall = 1 / (1 + std::pow(o.missArea / area, kAreaPower));
	const double seenHidden = 1 / (1 + std::exp((hidden - o.missHidden) / kHiddenWidth));
	return 1 - (1 - o.missRate) * seenSmall * seenHidden;
}

double hiddenShare(const std::vector<float>& hidden, uint32_t id)
{
	return hidden.empty() ? 0.0 : double(hidden[id]);
}

std::vector<VisibleObject> noticedObjects(
	const RenderedView& view, const std::vector<float>& hidden, const Scene& scene,
	const SimulatedDetectorOptions& options, uint64_t seed)
{
	auto objects = visibleObjects(view, scene);
	if (!hidden.empty() && !objects.empty() && hidden.size() <= objects.back().object->id)
		throw InputError(
			"hidden shares of " + std::to_string(hidden.size()) + " objects where object " +
			std::to_string(objects.back().object->id) + " is in the view; give one for each id");
	const auto isMissed = [&](const VisibleObject& o)
	{
		const double area = scaledArea(o.mask, view);
		const uint32_t id = o.object->id;
		return area < options.minimumArea ||
			   RandomStream(hashedFor("miss", seed, id)).uniform() <
				   missProbability(area, hiddenShare(hidden, id), options);
	};
	objects.erase(std::remove_if(objects.begin(), objects.end(), isMissed), objects.end());
	return objects;
}

Instance instanceOf(
	const SimulatedMask& found, const RenderedView& view, double hidden, const Scene& scene,
	const SimulatedDetectorOptions& options, const SimulatedLabels& labels)
{
	RandomStream random(hashed(found.key));
	const double area = scaledArea(found.mask, view);
	const double clarity = area / (area + 4 * options.missArea + 1) * (1 - 0.5 * hidden);
	const SceneObject& object = *found.objects.front();
	const auto embedding = [&](std::size_t i)
	{
		return simulatedEmbedding(
			scene, *found.objects[i], view.T_world_camera, options, hashed(found.key, i));
	};
	Instance instance;
	instance.box = found.mask.boundingBox();
	instance.mask = found.mask;
	instance.labelScores = labels.draw(object.label, clarity, random);
	const double sure = (0.6 + 0.4 * clarity) * instance.labelScores.front().score;
	instance.confidence = float(std::clamp(sure + 0.03 * random.normal(), 0.05, 0.99));
	instance.embedding =
		found.objects.size() == 1 ? embedding(0) : mergedEmbedding(embedding(0), embedding(1));
	return instance;
}

Instance falseInstance(
	const SimulatedMask& found, const Scene& scene, const SimulatedDetectorOptions& options)
{
	RandomStream random(hashed(found.key));
	const uint32_t label = random.below(uint32_t(scene.labels.size()));
	Instance instance;
	instance.box = found.mask.boundingBox();
	instance.mask = found.mask;
	instance.labelScores = {{label, float(random.uniform(0.35, 0.65))}};
	instance.confidence = float(random.uniform(0.3, 0.6));
	instance.embedding = falseEmbedding(scene.labels.name(label), options, hashed(found.key, 0));
	return instance;
}
}  // namespace

void SimulatedDetectorOptions::requireConsistent() const
{
	if (embeddingSize > 0 && embeddingSize < 8)
		throw UsageError(
			"embedding_size = " + std::to_string(embeddingSize) +
			": not allowed; use 0 for none or at least 8");
	const double shares = embeddingClass + embeddingView + embeddingNoise;
	if (shares > 1 + 1e-9)
		throw UsageError(
			"embedding_class + embedding_view + embedding_noise = " + std::to_string(shares) +
			": not allowed; use shares that sum to at most 1");
}

void SimulatedDetectorOptions::describe(OptionFields& f)
{
	f.integer("minimum_area", minimumArea, 0, 1 << 24, "smaller are not reported [px of 640]");
	f.number("miss_rate", missRate, 0, 1, "misses of a large object in full view");
	f.number("miss_area", missArea, 0, 1e6, "half are missed at this area besides [px of 640]");
	f.number(
		"miss_hidden", missHidden, 0, 100,
		"half are missed at this hidden share besides; 100: none");
	f.number("boundary_noise", boundaryNoise, 0, 50, "sigma of the mask's edge [px of 640]");
	f.number("split_rate", splitRate, 0, 1, "masks cut in two");
	f.number("merge_rate", mergeRate, 0, 1, "masks merged with a neighbour of the same label");
	f.number("false_rate", falseRate, 0, 50, "false detections in an image, on average");
	f.number("confusion_rate", confusionRate, 0, 1, "wrong labels, any as likely");
	f.list("confusions", confusions, "in its place: true>observed:probability, as chair>couch:0.2");
	f.integer("embedding_size", embeddingSize, 0, 4096, "0: none; else at least 8");
	f.number("embedding_class", embeddingClass, 0, 1, "share that a label has in common");
	f.number("embedding_view", embeddingView, 0, 1, "share of the viewing direction");
	f.number("embedding_noise", embeddingNoise, 0, 1, "share of noise; the rest is identity");
	f.number(
		"embedding_instance", embeddingInstance, 0, 1,
		"share of identity that copies of a model do not have in common");
}

CObservationInstances trueInstances(
	const RenderedView& view, const Scene& scene, const SimulatedDetectorOptions& options,
	uint64_t seed)
{
	CObservationInstances observation = emptyObservation(view, scene);
	for (auto& [object, mask] : visibleObjects(view, scene))
	{
		Instance instance;
		instance.box = mask.boundingBox();
		instance.mask = std::move(mask);
		instance.labelScores = {{object->label, 1.0F}};
		instance.confidence = 1;
		instance.embedding = simulatedEmbedding(
			scene, *object, view.T_world_camera, options, hashedFor("truth", seed, object->id));
		instance.trueObject = object->id;
		observation.instances.push_back(std::move(instance));
	}
	return observation;
}

CObservationInstances detectInstances(
	const RenderedView& view, const std::vector<float>& hidden, const Scene& scene,
	const SimulatedDetectorOptions& options, uint64_t seed)
{
	if (scene.labels.size() == 0)
		throw InputError("scene " + scene.name + ": no labels to detect; give it a label set");
	CObservationInstances observation = emptyObservation(view, scene);
	auto& instances = observation.instances;
	const SimulatedLabels labels(scene.labels, options);
	const auto objects = noticedObjects(view, hidden, scene, options, seed);
	for (const auto& found : simulatedMasks(view, objects, options, seed))
		if (found.objects.empty())
			instances.push_back(falseInstance(found, scene, options));
		else
			instances.push_back(instanceOf(
				found, view, hiddenShare(hidden, found.objects.front()->id), scene, options,
				labels));
	std::stable_sort(
		instances.begin(), instances.end(),
		[](const Instance& a, const Instance& b) { return a.confidence > b.confidence; });
	return observation;
}

}  // namespace semloop

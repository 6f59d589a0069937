#include <mrpt/core/format.h>
#include <semloop/config/Error.h>
#include <semloop/simulation/Furnishing.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "PlaceFinder.h"
#include "Random.h"

namespace semloop
{
namespace
{
using Eigen::Vector2d;

constexpr int kRestarts = 40;  // of a room
constexpr int kTries = 500;     // of a group
constexpr int kPrimitiveVariants = 6;
constexpr double kClearance = 0.04;      // between pieces [m]
constexpr double kTopMargin = 0.03;      // from the edge of what something stands on [m]
constexpr double kChairGap = 0.05;       // from what it is pushed to [m]

/** A group's pieces with their places, the base first. */
struct Placed
{
	const FurnitureModel* model = nullptr;
	std::string item;
	Footprint footprint;
	double z = 0;  //!< of its bottom [m]
	bool onFloor = true;
};
using PlacedGroup = std::vector<Placed>;

Vector2d rotated(const Vector2d& v, double yaw)
{
	return {
		std::cos(yaw) * v.x() - std::sin(yaw) * v.y(), std::sin(yaw) * v.x() + std::cos(yaw) * v.y()};
}

class Furnisher
{
public:
	Furnisher(
		const SceneDescription& description, const FloorPlan& plan,
		const std::vector<Vector2d>& way, FurnitureModels& models, uint64_t seed)
		: description_(description), plan_(plan), way_(way), models_(models), seed_(seed),
		  random_(seed)
	{
	}

	/** Everything in a room, in the order of its list. */
	PlacedGroup furnishRoom(std::size_t room);

private:
	const FurnitureModel& drawModel(const std::string& item);
	std::optional<PlacedGroup> tryGroup(const FurnitureGroup& group, const PlaceFinder& finder);
	bool putOnTop(const std::string& item, const Placed& base, PlacedGroup& group);
	bool putAround(
		const std::string& item, std::size_t index, const Placed& base, const PlaceFinder& finder,
		PlacedGroup& group);
	/** Empty, and why_, when there is none. */
	std::optional<PlacedGroup> findPlace(
		const std::string& room, const std::string& text, const PlaceFinder& finder);
	std::optional<PlacedGroup> tryRoom(std::size_t room);

	const SceneDescription& description_;
	const FloorPlan& plan_;
	const std::vector<Vector2d>& way_;
	FurnitureModels& models_;
	uint64_t seed_;
	RandomStream random_;
	std::string hindrance_;  //!< of a group's try that came furthest
	std::string why_;        //!< a room could not be furnished
};

const FurnitureModel& Furnisher::drawModel(const std::string& item)
{
	const auto& choices = description_.items.at(item).models;
	std::size_t draw = random_.bits();
	if (description_.scene.sameModels)
	{
		draw = seed_;
		for (const char c : item) draw = draw * 31 + static_cast<unsigned char>(c);
	}
	return models_.get(choices[draw % choices.size()], draw / choices.size() % kPrimitiveVariants);
}

bool Furnisher::putOnTop(const std::string& item, const Placed& base, PlacedGroup& group)
{
	Placed piece;
	piece.model = &drawModel(item);
	piece.item = item;
	piece.z = base.z + base.model->top;
	piece.onFloor = false;
	const auto& spot = description_.items.at(item).spot;
	piece.footprint.size = piece.model->size.head<2>();
	piece.footprint.yaw = base.footprint.yaw + random_.uniform(-0.15, 0.15);
	const Vector2d room =
		(base.footprint.size - piece.footprint.size) / 2 - Vector2d(kTopMargin, kTopMargin);
	if (room.minCoeff() < -kTopMargin) return false;
	Vector2d share(random_.uniform(-1, 1), random_.uniform(-1, 1));
	if (!spot.empty())
		share = Vector2d(std::stod(spot[0]), std::stod(spot[1])) +
				0.12 * Vector2d(random_.uniform(-1, 1), random_.uniform(-1, 1));
	share = share.cwiseMax(-1.0).cwiseMin(1.0);
	piece.footprint.center =
		base.footprint.center +
		rotated(share.cwiseProduct(room.cwiseMax(0.0)), base.footprint.yaw);
	for (const auto& other : group)
		if (!other.onFloor && overlap(piece.footprint, other.footprint, 0.01)) return false;
	group.push_back(piece);
	return true;
}

bool Furnisher::putAround(
	const std::string& item, std::size_t index, const Placed& base, const PlaceFinder& finder,
	PlacedGroup& group)
{
	Placed piece;
	piece.model = &drawModel(item);
	piece.item = item;
	piece.footprint.size = piece.model->size.head<2>();
	// Front, back, left, right, and again beside those.
	const double side = std::array{0.0, M_PI, -M_PI / 2, M_PI / 2}[index % 4];
	const double yaw = base.footprint.yaw + side;
	const bool across = index % 4 >= 2;
	const double reach = (across ? base.footprint.size.x() : base.footprint.size.y()) / 2;
	const double along = (across ? base.footprint.size.y() : base.footprint.size.x()) / 2;
	const double away = reach + piece.footprint.size.y() / 2 + kChairGap + random_.uniform(0, 0.15);
	const double shift = random_.uniform(-0.6, 0.6) * std::max(0.0, along - 0.2);
	piece.footprint.center = base.footprint.center + rotated({shift, -away}, yaw);
	// Facing the base: its front, -y, towards it.
	piece.footprint.yaw = yaw + M_PI + random_.uniform(-0.25, 0.25);
	if (!finder.isFree(piece.footprint)) return false;
	for (const auto& other : group)
		if (other.onFloor && overlap(piece.footprint, other.footprint, kClearance)) return false;
	group.push_back(piece);
	return true;
}

std::optional<PlacedGroup> Furnisher::tryGroup(
	const FurnitureGroup& group, const PlaceFinder& finder)
{
	Placed base;
	base.item = group.base;
	base.model = &drawModel(group.base);
	const auto place = finder.draw(
		description_.items.at(group.base).place, base.model->size.head<2>(), random_);
	if (!place) return std::nullopt;
	base.footprint = *place;
	PlacedGroup result{base};
	for (std::size_t i = 0; i < group.around.size(); ++i)
		if (!putAround(group.around[i], i, base, finder, result))
		{
			if (hindrance_.empty()) hindrance_ = "no room for " + group.around[i] + " around it";
			return std::nullopt;
		}
	for (const auto& item : group.onTop)
	{
		bool placed = false;
		for (int attempt = 0; attempt < 50 && !placed; ++attempt)
			placed = putOnTop(item, base, result);
		if (placed) continue;
		hindrance_ = "no room for " + item + " on top";
		return std::nullopt;
	}
	return result;
}

std::optional<PlacedGroup> Furnisher::findPlace(
	const std::string& room, const std::string& text, const PlaceFinder& finder)
{
	const FurnitureGroup group = description_.group(room, text);
	hindrance_.clear();
	for (int i = 0; i < kTries; ++i)
		if (auto placed = tryGroup(group, finder)) return placed;
	const FurnitureModel& model = drawModel(group.base);
	if (hindrance_.empty()) hindrance_ = "no free place on the floor";
	why_ = mrpt::format(
		"%s: [room.%s] furniture: '%s' (about %.2f x %.2f m) finds no place with seed %llu: %s; make "
		"the room larger, take furniture out, or move the path",
		description_.file.c_str(), room.c_str(), text.c_str(), model.size.x(), model.size.y(),
		static_cast<unsigned long long>(seed_), hindrance_.c_str());
	return std::nullopt;
}

std::optional<PlacedGroup> Furnisher::tryRoom(std::size_t room)
{
	const auto& [name, options] = description_.rooms[room];
	PlaceFinder finder(plan_, room, way_, description_.scene.pathClearance, kClearance);
	PlacedGroup all;
	for (const auto& text : options.furniture)
	{
		const auto placed = findPlace(name, text, finder);
		if (!placed) return std::nullopt;
		for (const auto& piece : *placed)
		{
			if (piece.onFloor) finder.occupy(piece.footprint);
			all.push_back(piece);
		}
	}
	return all;
}

PlacedGroup Furnisher::furnishRoom(std::size_t room)
{
	// What came first may stand in the way of what comes last: begin anew.
	for (int i = 0; i < kRestarts; ++i)
		if (auto furnished = tryRoom(room)) return *furnished;
	throw InputError(why_);
}

std::size_t roomNamed(const FloorPlan& plan, const std::string& name, const std::string& place)
{
	for (std::size_t i = 0; i < plan.rooms().size(); ++i)
		if (plan.rooms()[i].name == name) return i;
	throw UsageError(place + " = " + name + ": no such room");
}

/** A room's furniture, moved into another of the same size. */
PlacedGroup moved(PlacedGroup group, const Room& from, const Room& to, const std::string& place)
{
	if ((from.size - to.size).norm() > 1e-6)
		throw UsageError(place + " = " + from.name + ": that room has another size");
	for (auto& piece : group) piece.footprint.center += to.corner - from.corner;
	return group;
}
}  // namespace

std::vector<SceneObject> furnish(
	const SceneDescription& description, const FloorPlan& plan, const std::vector<Vector2d>& way,
	FurnitureModels& models, const LabelSet& labels, uint64_t seed)
{
	Furnisher furnisher(description, plan, way, models, seed);
	std::vector<PlacedGroup> rooms(plan.rooms().size());
	for (std::size_t i = 0; i < rooms.size(); ++i) rooms[i] = furnisher.furnishRoom(i);
	for (std::size_t i = 0; i < rooms.size(); ++i)
	{
		const auto& [name, options] = description.rooms[i];
		if (options.like.empty()) continue;
		const std::string place = description.file + ": [room." + name + "] like";
		const std::size_t from = roomNamed(plan, options.like, place);
		rooms[i] = moved(rooms[from], plan.rooms()[from], plan.rooms()[i], place);
	}

	std::vector<SceneObject> objects;
	for (const auto& room : rooms)
		for (const auto& piece : room)
		{
			SceneObject object;
			object.id = uint32_t(objects.size() + 1);
			object.label = uint32_t(*labels.find(description.items.at(piece.item).label));
			object.model = piece.model->id;
			object.mesh = piece.model->mesh;
			object.T_world_object = mrpt::poses::CPose3D(
				piece.footprint.center.x(), piece.footprint.center.y(), piece.z,
				piece.footprint.yaw, 0, 0);
			objects.push_back(object);
		}
	return objects;
}

}  // namespace semloop

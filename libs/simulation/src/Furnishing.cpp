#include <mrpt/core/format.h>
#include <semloop/config/Error.h>
#include <semloop/simulation/Furnishing.h>

#include <optional>

#include "GroupPlacer.h"
#include "PlaceFinder.h"

namespace semloop
{
namespace
{
using Eigen::Vector2d;

constexpr int kRestarts = 40;  // of a room

class Furnisher
{
public:
	Furnisher(
		const SceneDescription& description, const FloorPlan& plan,
		const std::vector<Vector2d>& way, FurnitureModels& models, uint64_t seed)
		: description_(description),
		  plan_(plan),
		  way_(way),
		  seed_(seed),
		  groups_(description, models, seed)
	{
	}

	/** Everything in a room, in the order of its list; free in its copies too. */
	PlacedGroup furnishRoom(std::size_t room, const std::vector<std::size_t>& copies);

private:
	/** Empty, and why_ says the reason, when a group finds no place. */
	std::optional<PlacedGroup> tryRoom(std::size_t room, PlaceFinder finder);

	const SceneDescription& description_;
	const FloorPlan& plan_;
	const std::vector<Vector2d>& way_;
	uint64_t seed_;
	GroupPlacer groups_;
	std::string why_;
};

std::optional<PlacedGroup> Furnisher::tryRoom(std::size_t room, PlaceFinder finder)
{
	const auto& [name, options] = description_.rooms[room];
	PlacedGroup all;
	for (const auto& text : options.furniture)
	{
		const std::string place =
			description_.file + ": [room." + name + "] furniture: '" + text + "'";
		const auto placed = groups_.place(description_.group(name, text), finder, place);
		if (!placed)
		{
			why_ = place + " finds no place with seed " + std::to_string(seed_) + ": " +
				   groups_.hindrance();
			return std::nullopt;
		}
		for (const auto& piece : *placed)
		{
			if (piece.onFloor) finder.occupy(piece.footprint);
			all.push_back(piece);
		}
	}
	return all;
}

PlacedGroup Furnisher::furnishRoom(std::size_t room, const std::vector<std::size_t>& copies)
{
	PlaceFinder finder(plan_, room, way_, description_.scene.pathClearance, kFurnitureGap);
	std::string also;
	for (const auto copy : copies)
	{
		finder.mindCopy(plan_, copy, way_);
		also += (also.empty() ? " (and the same place in " : ", ") + plan_.rooms()[copy].name;
	}
	if (!also.empty()) also += ")";
	// What came first may stand in the way of what comes last: begin anew.
	for (int i = 0; i < kRestarts; ++i)
		if (auto furnished = tryRoom(room, finder)) return *furnished;
	throw InputError(why_ + also + "; make the room larger, take furniture out, or move the path");
}

/** For each room the one that it is furnished like: itself for most. */
std::vector<std::size_t> originalsOf(const SceneDescription& description, const FloorPlan& plan)
{
	const auto& rooms = description.rooms;
	std::vector<std::size_t> originals(rooms.size());
	for (std::size_t i = 0; i < rooms.size(); ++i)
	{
		const auto& [name, options] = rooms[i];
		originals[i] = i;
		if (options.like.empty()) continue;
		const std::string place =
			description.file + ": [room." + name + "] like = " + options.like + ": ";
		std::size_t from = 0;
		while (from < rooms.size() && rooms[from].first != options.like) ++from;
		if (from == rooms.size()) throw UsageError(place + "no such room");
		if (!options.furniture.empty())
			throw UsageError(place + "this room has furniture of its own; take out one of the two");
		if (!rooms[from].second.like.empty())
			throw UsageError(place + "that room is a copy itself; name the one with the furniture");
		if ((plan.rooms()[from].size - plan.rooms()[i].size).norm() > 1e-6)
			throw UsageError(place + "that room has another size");
		originals[i] = from;
	}
	return originals;
}

std::vector<PlacedGroup> furnishRooms(
	const SceneDescription& description, const FloorPlan& plan, Furnisher& furnisher)
{
	const auto originals = originalsOf(description, plan);
	std::vector<PlacedGroup> rooms(originals.size());
	for (std::size_t i = 0; i < rooms.size(); ++i)
	{
		if (originals[i] != i) continue;
		std::vector<std::size_t> copies;
		for (std::size_t j = 0; j < rooms.size(); ++j)
			if (j != i && originals[j] == i) copies.push_back(j);
		rooms[i] = furnisher.furnishRoom(i, copies);
		for (const auto copy : copies)
		{
			rooms[copy] = rooms[i];
			for (auto& piece : rooms[copy])
				piece.footprint.center += plan.rooms()[copy].corner - plan.rooms()[i].corner;
		}
	}
	return rooms;
}
}  // namespace

std::vector<SceneObject> furnish(
	const SceneDescription& description, const FloorPlan& plan, const std::vector<Vector2d>& way,
	FurnitureModels& models, const LabelSet& labels, uint64_t seed)
{
	Furnisher furnisher(description, plan, way, models, seed);
	std::vector<SceneObject> objects;
	for (const auto& room : furnishRooms(description, plan, furnisher))
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

#include "GroupPlacer.h"

#include <mrpt/core/format.h>
#include <semloop/config/Error.h>

#include <array>
#include <cmath>

namespace semloop
{
namespace
{
using Eigen::Vector2d;

constexpr int kTries = 500;  // of a group
constexpr int kTriesOnTop = 50;
constexpr int kPrimitiveVariants = 6;
constexpr double kTopMargin = 0.03;  // from the edge of what something stands on [m]
constexpr double kTopGap = 0.01;     // between things on top [m]
constexpr double kChairGap = 0.05;   // from what it is pushed to [m]

Vector2d rotated(const Vector2d& v, double yaw)
{
	return {
		std::cos(yaw) * v.x() - std::sin(yaw) * v.y(),
		std::sin(yaw) * v.x() + std::cos(yaw) * v.y()};
}

/** Sides of the axis-parallel box of a turned rectangle. */
Vector2d extentOf(const Vector2d& size, double yaw)
{
	const double c = std::abs(std::cos(yaw)), s = std::abs(std::sin(yaw));
	return {c * size.x() + s * size.y(), s * size.x() + c * size.y()};
}
}  // namespace

GroupPlacer::GroupPlacer(
	const SceneDescription& description, FurnitureModels& models, uint64_t seed)
	: description_(description), models_(models), seed_(seed), random_(seed)
{
}

const FurnitureModel& GroupPlacer::drawModel(const std::string& item)
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

bool GroupPlacer::putOnTop(const std::string& item, const Placed& base, PlacedGroup& group)
{
	Placed piece;
	piece.model = &drawModel(item);
	piece.item = item;
	piece.z = base.z + base.model->top;
	piece.onFloor = false;
	piece.footprint.size = piece.model->size.head<2>();
	const double turn = random_.uniform(-0.15, 0.15);
	piece.footprint.yaw = base.footprint.yaw + turn;
	const Vector2d free = (base.footprint.size - extentOf(piece.footprint.size, turn)) / 2;
	Vector2d share(random_.uniform(-1, 1), random_.uniform(-1, 1));
	if (const auto& spot = description_.items.at(item).spot; !spot.empty())
		share = Vector2d(std::stod(spot[0]), std::stod(spot[1])) + 0.12 * share;
	if (free.minCoeff() < 0) return false;
	share = share.cwiseMax(-1.0).cwiseMin(1.0);
	const Vector2d reach = (free - Vector2d(kTopMargin, kTopMargin)).cwiseMax(0.0);
	piece.footprint.center =
		base.footprint.center + rotated(share.cwiseProduct(reach), base.footprint.yaw);
	for (const auto& other : group)
		if (!other.onFloor && overlap(piece.footprint, other.footprint, kTopGap)) return false;
	group.push_back(piece);
	return true;
}

bool GroupPlacer::putAround(
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
		if (other.onFloor && overlap(piece.footprint, other.footprint, kFurnitureGap)) return false;
	group.push_back(piece);
	return true;
}

std::optional<PlacedGroup> GroupPlacer::tryOnce(
	const FurnitureGroup& group, const PlaceFinder& finder)
{
	Placed base;
	base.item = group.base;
	base.model = &drawModel(group.base);
	if (!group.onTop.empty() && base.model->top <= 0)
		throw UsageError(
			place_ + ": nothing can stand on " + base.model->id + ", a model of [" + group.base +
			"], so '" + group.onTop.front() + "' cannot; give it another base");
	if (hindrance_.empty())
		hindrance_ = mrpt::format(
			"no free place for its %.2f x %.2f m", base.model->size.x(), base.model->size.y());
	const auto place =
		finder.draw(description_.items.at(group.base).place, base.model->size.head<2>(), random_);
	if (!place) return std::nullopt;
	base.footprint = *place;
	PlacedGroup result{base};
	for (std::size_t i = 0; i < group.around.size(); ++i)
	{
		if (putAround(group.around[i], i, base, finder, result)) continue;
		hindrance_ = "no room for " + group.around[i] + " around it";
		return std::nullopt;
	}
	for (const auto& item : group.onTop)
	{
		bool placed = false;
		for (int attempt = 0; attempt < kTriesOnTop && !placed; ++attempt)
			placed = putOnTop(item, base, result);
		if (placed) continue;
		hindrance_ = "no room for " + item + " on top of " + base.model->id;
		return std::nullopt;
	}
	return result;
}

std::optional<PlacedGroup> GroupPlacer::place(
	const FurnitureGroup& group, const PlaceFinder& finder, const std::string& place)
{
	place_ = place;
	hindrance_.clear();
	if (description_.items.at(group.base).place == "top")
		throw UsageError(
			place + ": '" + group.base + "' has place = top; put it on something with +");
	for (int i = 0; i < kTries; ++i)
		if (auto placed = tryOnce(group, finder)) return placed;
	return std::nullopt;
}

}  // namespace semloop

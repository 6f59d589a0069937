#include "MapScene.h"

#include <mrpt/opengl/CArrow.h>
#include <mrpt/opengl/CSphere.h>
#include <mrpt/opengl/CText.h>
#include <semloop/object_map/MeshVisualization.h>
#include <semloop/observations/CameraFrames.h>
#include <semloop/slam/PathLine.h>

#include <algorithm>
#include <cmath>

using namespace mrpt::opengl;
using mrpt::img::TColor;

namespace semloop
{
namespace
{
const TColor kBackground(244, 245, 248), kFloor(205, 208, 214);
const TColor kLoop(230, 110, 0);
constexpr float kAmbient = 0.5f;         // share of the light
constexpr float kFloorHalfSize = 10.0f;  // [m]
constexpr float kCameraLength = 0.35f;   // of the drawn pyramid [m]

/** Height of the lowest object's lower side, as far as its axes are still parallel to the world's. */
double floorHeight(const CObjectMap& map)
{
	double height = 0.0;
	for (const auto& [id, object] : map.objects())
		if (const auto box = object.volume->boundingBox())
			height = std::min(height, object.T_world_object.z() + box->min.z);
	return height;
}

float fieldOfView(double pixels, double focalLength)
{
	return float(mrpt::RAD2DEG(2 * std::atan(pixels / (2 * focalLength))));
}
}  // namespace

MapScene::MapScene(COpenGLViewport& view)
	: floor_(CGridPlaneXY::Create(
		  -kFloorHalfSize, kFloorHalfSize, -kFloorHalfSize, kFloorHalfSize, 0.0f, 1.0f, 1.0f,
		  false)),
	  surfaceSet_(CSetOfObjects::Create()),
	  paths_(CSetOfObjects::Create()),
	  names_(CSetOfObjects::Create()),
	  loop_(CSetOfObjects::Create()),
	  camera_(CFrustum::Create())
{
	view.setCustomBackgroundColor(mrpt::img::TColorf(kBackground));
	view.lightParameters().ambient = mrpt::img::TColorf(kAmbient, kAmbient, kAmbient);
	floor_->setColor_u8(kFloor);
	camera_->setNearFarPlanes(0.01f, kCameraLength);
	camera_->setColor_u8(kTrajectoryColor);
	camera_->setVisibility(false);
	view.insert(floor_);
	view.insert(surfaceSet_);
	view.insert(paths_);
	view.insert(camera_);
	view.insert(loop_);
	view.insert(names_);
}

void MapScene::showCamera(
	const mrpt::img::TCamera& camera, const mrpt::poses::CPose3D& T_world_camera)
{
	camera_->setHorzFOV(fieldOfView(camera.ncols, camera.fx()));
	camera_->setVertFOV(fieldOfView(camera.nrows, camera.fy()));
	camera_->setPose(T_world_camera + (-sensorFromCamera()));
	camera_->setVisibility(true);
}

void MapScene::showMap(MapSnapshot&& snapshot)
{
	updateSurfaces(snapshot.map);
	snapshot.map.visualizationOptions.meshes = false;
	snapshot.map.visualizationOptions.boxes = false;
	snapshot.map.visualizationOptions.edges = false;
	names_->clear();
	snapshot.map.getVisualizationInto(*names_);
	floor_->setPlaneZcoord(float(floorHeight(snapshot.map)));
	paths_->clear();
	// What is drawn first stays on top where both are one.
	paths_->insert(pathLine(snapshot.trajectory, kTrajectoryColor, 4));
	paths_->insert(pathLine(snapshot.odometryTrajectory, kOdometryColor, 3));
	showLoop(snapshot.lastLoop);
}

void MapScene::updateSurfaces(const CObjectMap& map)
{
	for (auto it = surfaces_.begin(); it != surfaces_.end();)
	{
		const bool remains = map.objects().count(it->first) > 0;
		if (!remains && it->second.mesh) surfaceSet_->removeObject(it->second.mesh);
		it = remains ? std::next(it) : surfaces_.erase(it);
	}
	for (const auto& [id, object] : map.objects())
	{
		Surface& surface = surfaces_[id];
		surface.pose = object.T_world_object;
		if (surface.mesh) surface.mesh->setPose(surface.pose);
		if (surface.volume == object.volume) continue;
		surface.volume = object.volume;
		if (!surface.isWaiting) waiting_.push_back(id);
		surface.isWaiting = true;
	}
}

bool MapScene::meshFor(std::chrono::milliseconds time)
{
	const auto end = std::chrono::steady_clock::now() + time;
	const bool any = !waiting_.empty();
	while (!waiting_.empty())
	{
		const auto found = surfaces_.find(waiting_.front());
		waiting_.pop_front();
		if (found == surfaces_.end()) continue;  // it is gone
		Surface& surface = found->second;
		surface.isWaiting = false;
		// A new one: MRPT leaves out what was out of sight with the size that it had first.
		if (surface.mesh) surfaceSet_->removeObject(surface.mesh);
		surface.mesh = trianglesOf(surface.volume->mesh());
		surface.mesh->setPose(surface.pose);
		surfaceSet_->insert(surface.mesh);
		if (std::chrono::steady_clock::now() >= end) break;
	}
	return any;
}

void MapScene::showLoop(const std::vector<MatchedObjects>& matches)
{
	loop_->clear();
	for (const MatchedObjects& match : matches)
	{
		auto arrow = CArrow::Create(
			mrpt::math::TPoint3Df(match.queryCentre), mrpt::math::TPoint3Df(match.targetCentre),
			0.0f, 0.01f, 0.01f);
		arrow->setColor_u8(kLoop);
		loop_->insert(arrow);
		for (const auto& end : {match.queryCentre, match.targetCentre})
		{
			auto ball = CSphere::Create(0.03f);
			ball->setColor_u8(kLoop);
			ball->setLocation(end);
			loop_->insert(ball);
		}
		auto name = CText::Create(
			match.queryLabel + " " + std::to_string(match.query) + " = " + match.targetLabel + " " +
			std::to_string(match.target));
		name->setColor_u8(kLoop);
		name->setLocation(match.queryCentre);
		loop_->insert(name);
	}
}

}  // namespace semloop

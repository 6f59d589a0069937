#pragma once

#include <mrpt/opengl/CFrustum.h>
#include <mrpt/opengl/CGridPlaneXY.h>
#include <mrpt/opengl/COpenGLViewport.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CSetOfTriangles.h>

#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <vector>

#include "SlamSnapshot.h"

namespace semloop
{
/** The 3D view of a run: the objects with their names, both trajectories, the camera, the matches of
 *  the last loop closure. To be used in the thread that renders it. */
class MapScene
{
public:
	explicit MapScene(mrpt::opengl::COpenGLViewport& view);

	void showCamera(const mrpt::img::TCamera& camera, const mrpt::poses::CPose3D& T_world_camera);
	/** All but the surfaces that have changed: they wait for meshFor(). */
	void showMap(MapSnapshot&& snapshot);
	/** Meshes surfaces that have changed, longest waiting first, until the time is over; one at least.
	 *  Whether there was any. */
	bool meshFor(std::chrono::milliseconds time);

private:
	/** A copy-on-write volume changes its address when it changes, as long as it is held here. */
	struct Surface
	{
		std::shared_ptr<const TsdfVolume> volume;
		mrpt::poses::CPose3D pose;
		mrpt::opengl::CSetOfTriangles::Ptr mesh;  //!< null until there was time for it
		bool isWaiting = false;
	};

	void updateSurfaces(const CObjectMap& map);
	void showLoop(const std::vector<MatchedObjects>& matches);

	mrpt::opengl::CGridPlaneXY::Ptr floor_;
	mrpt::opengl::CSetOfObjects::Ptr surfaceSet_, paths_, names_, loop_;
	mrpt::opengl::CFrustum::Ptr camera_;
	std::map<ObjectId, Surface> surfaces_;
	std::deque<ObjectId> waiting_;
};

}  // namespace semloop

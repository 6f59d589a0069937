#pragma once

#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>
#include <semloop/simulation/Scene.h>

#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace semloop
{
/** What a perfect camera would see; all images of its size. */
struct RenderedView
{
	mrpt::img::TCamera camera;
	mrpt::poses::CPose3D T_world_camera;
	cv::Mat depth;   //!< CV_32FC1 [m] along the optical axis; 0: nothing there
	cv::Mat cosine;  //!< CV_32FC1, of the angle between ray and surface normal, in [0, 1]
	cv::Mat object;  //!< CV_16UC1, SceneObject::id; 0: the room, or nothing
	cv::Mat color;   //!< CV_32FC3, BGR, linear, 1 = full exposure; empty without colour
};

/** Ray casting with Embree (Wald et al., ACM TOG 33(4), 2014). Lambertian surfaces, point lights with
 *  hard shadows, ambient light. One ray a pixel; deterministic. */
class SceneRenderer
{
public:
	/** Builds the ray-casting structure; the scene's meshes must stay. */
	explicit SceneRenderer(const Scene& scene);
	~SceneRenderer();

	/** From T_world_camera (optical frame) through a pinhole without distortion: throws InputError for
	 *  a camera with one. Can be called from several threads. */
	RenderedView render(
		const mrpt::img::TCamera& camera, const mrpt::poses::CPose3D& T_world_camera,
		bool color) const;

	/** Share of each object that others hide in this view: 1 - seen / seen if it stood alone, by
	 *  SceneObject::id; 0 for what is not in the view. Estimated on every fourth pixel of every fourth
	 *  row. */
	std::vector<float> hiddenShares(const RenderedView& view) const;

private:
	struct Impl;
	std::unique_ptr<Impl> impl_;
};

}  // namespace semloop

#include <semloop/slam/KeyFrames.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace semloop
{
namespace
{
/** Between the optical axes [rad]. */
double angleBetweenViews(const mrpt::poses::CPose3D& a, const mrpt::poses::CPose3D& b)
{
	const auto &r = a.getRotationMatrix(), &s = b.getRotationMatrix();
	const double cosine = r(0, 2) * s(0, 2) + r(1, 2) * s(1, 2) + r(2, 2) * s(2, 2);
	return std::acos(std::clamp(cosine, -1.0, 1.0));
}
}  // namespace

KeyFrames::KeyFrames(double distance, double angle, std::size_t most)
	: distance_(distance), angle_(angle), most_(most)
{
}

void KeyFrames::offer(const KeyFrame& frame, const PoseGraph& poses)
{
	if (isCovered(poses.pose(NodeId::camera(frame.frame)), poses)) return;
	frames_.push_back(frame);
	if (frames_.size() <= most_) return;
	std::vector<KeyFrame> everyOther;
	for (std::size_t i = 0; i < frames_.size(); i += 2) everyOther.push_back(frames_[i]);
	frames_ = std::move(everyOther);
	distance_ *= 2;
	angle_ *= 2;
}

bool KeyFrames::isCovered(const mrpt::poses::CPose3D& T_world_camera, const PoseGraph& poses) const
{
	return std::any_of(
		frames_.begin(), frames_.end(),
		[&](const KeyFrame& key)
		{
			const auto& other = poses.pose(NodeId::camera(key.frame));
			return other.distanceTo(T_world_camera) < distance_ &&
				   angleBetweenViews(other, T_world_camera) < angle_;
		});
}

}  // namespace semloop

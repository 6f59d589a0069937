#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/association/FrameRegistration.h>
#include <semloop/association/MaskedSurface.h>
#include <semloop/association/MatchingCost.h>
#include <semloop/config/Options.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/RgbdFrame.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace semloop
{
struct InstanceTrackerOptions : Options
{
	int minTrackedFrames = 3;    //!< a track counts from this many observations on
	int maxMissedFrames = 5;     //!< segmented frames that a track survives unseen
	double gate = 0.6;           //!< largest matching cost of an association
	double minConfidence = 0.4;  //!< weaker detections are not looked at

protected:
	void describe(OptionFields& fields) override;
};

/** A detection of the current frame that belongs to a track. */
struct TrackedInstance
{
	uint64_t track = 0;
	std::size_t instance = 0;  //!< index in the observation given to track()
	int observations = 0;      //!< frames in which the track was seen, this one included
	bool confirmed = false;    //!< seen in minTrackedFrames frames
};

/** Multi-frame instance tracking (Sec. III-B): the association of Eq. (1)-(3) between the detections
 *  of this frame and those of the previous ones, whose masks are moved by the odometry: each masked
 *  pixel with depth is unprojected, transformed and projected again (MaskedSurface); a mask without
 *  depth stays where it was. Filters out what a network imagines in one frame.
 *
 *  A track takes mask, surface, labels and embedding from its latest detection. One that is not seen
 *  goes on moving, and dies with the segmented frame after maxMissedFrames of them. Numbers of tracks
 *  begin at 0 and are never used again. */
class InstanceTracker
{
public:
	/** Throws UsageError without a cost. */
	explicit InstanceTracker(
		InstanceTrackerOptions options, std::shared_ptr<const MatchingCost> cost,
		FrameRegistrationOptions registration = {});

	/** The frame and its instances (rectified, one image size), T_previous_camera since the last call and
	 *  its uncertainty. The frame is registered to the moved tracks first, see registration().
	 *  One entry per detection that is strong enough, in the observation's order. Throws InputError
	 *  when the image sizes differ; an empty depth image means that there is no depth. */
	std::vector<TrackedInstance> track(
		const RgbdFrame& frame, const CObservationInstances& observation,
		const mrpt::poses::CPose3D& T_previous_camera, const PoseSigma& sigma = {});

	/** What the last frame's detections said about T_previous_camera. */
	const FrameRegistration& registration() const { return registered_; }

	std::size_t trackCount() const { return tracks_.size(); }

private:
	struct Track
	{
		uint64_t id = 0;
		int observations = 0;
		int missed = 0;         //!< segmented frames since it was seen
		InstanceMask mask;      //!< in the current image
		MaskedSurface surface;  //!< in the current camera's frame
		LabelScores labelScores;
		std::vector<std::vector<float>> embeddings;  //!< the latest one or none

		AssociationItem item() const;
	};

	void moveTracks(
		const mrpt::img::TCamera& camera, const mrpt::poses::CPose3D& T_camera_previous);
	static Track trackFrom(const Instance& instance, const RgbdFrame& frame);
	void update(Track& track, Track seen);

	InstanceTrackerOptions options_;
	std::shared_ptr<const MatchingCost> cost_;
	FrameRegistrationOptions registrationOptions_;
	FrameRegistration registered_;
	std::vector<Track> tracks_;
	uint64_t nextId_ = 0;
};

}  // namespace semloop

#include <mrpt/core/format.h>
#include <mrpt/obs/CObservationIMU.h>
#include <semloop/config/Error.h>
#include <semloop/observations/UnixTime.h>
#include <semloop/slam/SemanticSlam.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

using mrpt::poses::CPose3D;

namespace semloop
{
SemanticSlam::SemanticSlam(
	const mrpt::config::CConfigFileBase& config, mrpt::system::COutputLogger& logger,
	StageTimings& timings)
	: logger_(logger), timings_(timings), map_(CObjectMap::Create())
{
	makeModules(config);
	makeMap(config);
}

void SemanticSlam::process(const SlamFrame& frame)
{
	const StageTimings::Scope timing(timings_, "frame");
	integrate(frame, track(frame));
}

OdometryEstimate SemanticSlam::track(const SlamFrame& frame)
{
	const StageTimings::Scope timing(timings_, "odometry");
	for (const auto& observation : frame.before) odometry_->observe(*observation);
	return odometry_->track(frame.rgbd);
}

void SemanticSlam::integrate(const SlamFrame& input, const OdometryEstimate& odometry)
{
	const StageTimings::Scope timing(timings_, "mapping");
	for (const auto& observation : input.before) feelGravity(*observation);
	const RgbdFrame& frame = input.rgbd;
	if (frameCount() == 0) placeFirstCamera(frame);

	// The camera-camera constraint of Eq. (7).
	correction_.step(odometry);
	addCamera(frame, odometry);
	localMap_.advance(odometry.T_previous_camera);
	if (!input.instances) return;
	const CObservationInstances& instances = *input.instances;
	adoptLabels(instances);

	// Sec. III-B: multi-frame instance tracking filters out perceptual noise.
	std::vector<TrackedInstance> tracked;
	{
		const StageTimings::Scope trackingTiming(timings_, "tracking");
		tracked = tracker_->track(
			frame, instances, correction_.T_previous_camera(), correction_.stepSigma());
		correction_.track(tracker_->registration());
	}

	// Sec. III-B, Eq. (1)-(3): association with the map's objects, fusion into their volumes.
	const auto seen =
		mapper_->update(frame, instances, tracked, cameraPose(), localMap_, correction_.sigma());
	correction_.localize(mapper_->registration());
	poseGraph_->setNode(cameraNode(), cameraPose());
	addObservations(seen);
	remember(instances, tracked, seen);
	map_->markCovisible(localMap_.objects());
	loopDetector_->addFrame(frameCount() - 1, frame);
	keyFrames_->offer({frameCount() - 1, input.scan, input.instances}, *poseGraph_);

	++segmentedFrames_;
	detections_ += instances.instances.size();
	if (segmentedFrames_ % std::size_t(options_.maintainEveryFrames) == 0) maintainMap();
	// Sec. III-C: graph-based loop closure.
	if (segmentedFrames_ % std::size_t(options_.loopEveryFrames) == 0 && localMap_.isLoopDue())
		closeLoop(frame.time);
}

void SemanticSlam::feelGravity(const mrpt::obs::CObservation& observation)
{
	const auto* imu = dynamic_cast<const mrpt::obs::CObservationIMU*>(&observation);
	if (!imu || frameCount() > 0 || !imu->has(mrpt::obs::IMU_X_ACC)) return;
	// At rest an accelerometer measures what holds it up.
	const mrpt::math::TVector3D acceleration(
		imu->get(mrpt::obs::IMU_X_ACC), imu->get(mrpt::obs::IMU_Y_ACC),
		imu->get(mrpt::obs::IMU_Z_ACC));
	up_ = up_.value_or(mrpt::math::TVector3D(0, 0, 0)) + imu->sensorPose.rotateVector(acceleration);
}

void SemanticSlam::adoptLabels(const CObservationInstances& instances)
{
	const LabelSet& labels = instances.labels;
	if (map_->labels() == labels) return;
	if (map_->labels().size() > 0)
		throw InputError(
			"instances at " + formatUnixTime(instances.timestamp) +
			": their label set is not that of the instances before; segment the rawlog again with "
			"one network");
	map_->setLabels(labels);
	const std::string& file = options_.confusionMatrix;
	ConfusionMatrix confusion = file.empty() ? ConfusionMatrix(labels, options_.confusionCorrect)
											 : ConfusionMatrix::load(file);
	if (!(confusion.labels() == labels))
		throw InputError(file + ": its labels are not those of the instances; learn it anew");
	if (!file.empty()) loopDetector_->setConfusionMatrix(confusion);
	matchingCost_->setConfusionMatrix(std::move(confusion));
}

void SemanticSlam::placeFirstCamera(const RgbdFrame& frame)
{
	CPose3D T_world_robot;
	if (options_.level && up_ && up_->norm() > 0)
	{
		// Roll and pitch that bring the measured up direction to +z; the heading stays.
		const double roll = std::atan2(up_->y, up_->z);
		const double pitch = -std::atan2(up_->x, std::hypot(up_->y, up_->z));
		T_world_robot = CPose3D(0, 0, 0, 0, pitch, roll);
	}
	T_world_firstCamera_ = T_world_robot + frame.T_robot_camera;
	T_world_odom_ = T_world_firstCamera_;
}

void SemanticSlam::addCamera(const RgbdFrame& frame, const OdometryEstimate& odometry)
{
	if (odometry.status == OdometryEstimate::Status::Lost)
	{
		++lostFrames_;
		logger_.logFmt(
			mrpt::system::LVL_WARN, "frame %zu: odometry lost: %s", frameCount(),
			odometry.reason.c_str());
	}
	T_odom_camera_ = odometry.T_odom_camera;
	driftPrior_.add(odometry);
	odometryTrajectory_.push_back({frame.time, T_world_firstCamera_ + T_odom_camera_});

	poseGraph_->setNode(cameraNode(), cameraPose());
	if (frameCount() == 1) return;
	PoseEdge edge;
	edge.kind = PoseEdge::Kind::Odometry;
	edge.a = NodeId::camera(frameCount() - 2);
	edge.b = cameraNode();
	edge.Z_a_b = odometry.T_previous_camera;
	edge.information = odometry.covariance.inverse();
	edge.information = 0.5 * (edge.information + edge.information.transpose()).eval();
	poseGraph_->addEdge(edge);
}

void SemanticSlam::addObservations(const std::vector<ObjectObservation>& seen)
{
	Matrix6 information = Matrix6::Identity();
	information.topLeftCorner<3, 3>() /= options_.observationSigma * options_.observationSigma;
	information.bottomRightCorner<3, 3>() /=
		options_.observationSigmaAngle * options_.observationSigmaAngle;

	std::set<ObjectId> measured;
	for (const ObjectObservation& observation : seen)
	{
		const NodeId node = NodeId::object(observation.object);
		const CPose3D& T_world_object = map_->object(observation.object).T_world_object;
		if (!poseGraph_->has(node)) poseGraph_->setNode(node, T_world_object);
		localMap_.see(observation.object);
		// Two detections of one object, as when a mask was split: one measurement is enough.
		if (!observation.fused || !measured.insert(observation.object).second) continue;

		PoseEdge edge;  // Eq. (7), e_oc
		edge.kind = PoseEdge::Kind::Observation;
		edge.a = node;
		edge.b = cameraNode();
		edge.Z_a_b = (-T_world_object) + cameraPose();
		edge.information = information;
		poseGraph_->addEdge(edge);
	}
}

void SemanticSlam::remember(
	const CObservationInstances& instances, const std::vector<TrackedInstance>& tracked,
	const std::vector<ObjectObservation>& seen)
{
	std::map<std::size_t, ObjectId> objectOf;  // of an instance
	for (const ObjectObservation& observation : seen)
		objectOf[observation.instance] = observation.object;
	for (const TrackedInstance& t : tracked)
	{
		auto& records = unassociated_[t.track];
		records.push_back(
			{odometryTrajectory_.back().time, frameCount() - 1, t.instance,
			 instances.instances[t.instance].box});
		const auto object = objectOf.find(t.instance);
		if (object == objectOf.end()) continue;
		// What its track saw before is that object, too.
		for (AssociationRecord& record : records)
			record.object = record.firstObject = object->second;
		associations_.insert(associations_.end(), records.begin(), records.end());
		unassociated_.erase(t.track);
	}
}

std::vector<AssociationRecord> SemanticSlam::associations() const
{
	auto result = associations_;
	for (AssociationRecord& record : result) record.object = mapper_->mergedInto(record.object);
	std::sort(
		result.begin(), result.end(),
		[](const auto& a, const auto& b)
		{ return std::tie(a.frame, a.instance) < std::tie(b.frame, b.instance); });
	return result;
}

void SemanticSlam::maintainMap()
{
	const StageTimings::Scope timing(timings_, "maintenance");
	for (const ObjectId id : map_->removeUnsupported())
	{
		poseGraph_->removeObject(id);
		localMap_.remove(id);
		mapper_->remove(id);
	}
	loopCloser_->mergeDuplicates(localMap_, *mapper_);
}

std::vector<MatchedObjects> SemanticSlam::matchedObjects(const LoopVerdict& verdict) const
{
	std::vector<MatchedObjects> result;
	for (const auto& match : verdict.matches)
	{
		const Object &query = map_->object(match.first), &target = map_->object(match.second);
		result.push_back(
			{query.id, target.id, map_->labelName(query), map_->labelName(target), query.centre(),
			 target.centre()});
	}
	return result;
}

void SemanticSlam::closeLoop(mrpt::Clock::time_point time)
{
	LoopRecord record;
	record.frame = frameCount() - 1;
	record.time = time;
	record.localMapSince = localMap_.firstFrame();
	record.prior = priorOfTheRest();
	record.verdict = loopCloser_->detect(
		localMap_, record.prior, [this](const auto& objects) { return priorOf(objects); });
	record.matched = matchedObjects(record.verdict);
	if (record.verdict.decision == LoopVerdict::Decision::Accepted)
	{
		record.driftSigmas = driftSigmas(record.verdict);
		if (options_.maxDriftSigmas > 0 && *record.driftSigmas > options_.maxDriftSigmas)
		{
			record.verdict.decision = LoopVerdict::Decision::Rejected;
			record.verdict.reason += mrpt::format(
				"; but the correction is %.1f standard deviations of the odometry's drift",
				*record.driftSigmas);
		}
	}
	if (record.verdict.decision == LoopVerdict::Decision::Accepted)
	{
		record.optimization = loopCloser_->close(record.verdict, localMap_, *mapper_);
		followOptimizedCamera();
		logger_.logFmt(
			mrpt::system::LVL_INFO, "frame %zu: loop closed: %s", record.frame,
			record.verdict.reason.c_str());
	}
	// Sec. IV-B asks once; what is ambiguous may be clear when more of it is known.
	localMap_.keepGrowing(record.verdict.decision == LoopVerdict::Decision::Ambiguous);
	loops_.push_back(std::move(record));
}

std::size_t SemanticSlam::frameAt(mrpt::Clock::time_point time) const
{
	const auto frame = std::lower_bound(
		odometryTrajectory_.begin(), odometryTrajectory_.end() - 1, time,
		[](const StampedPose& pose, mrpt::Clock::time_point t) { return pose.time < t; });
	return std::size_t(frame - odometryTrajectory_.begin());
}

mrpt::math::TPoint3D SemanticSlam::localCentroid() const
{
	mrpt::math::TPoint3D sum(0, 0, 0);
	const auto inside = localMap_.objects();
	for (const ObjectId id : inside) sum += map_->object(id).centre();
	return sum * (1.0 / double(std::max<std::size_t>(1, inside.size())));
}

PosePrior SemanticSlam::priorOf(const std::vector<ObjectId>& objects) const
{
	auto since = odometryTrajectory_.back().time;
	for (const ObjectId id : objects) since = std::min(since, map_->object(id).lastSeen);
	return driftPrior_.prior(frameAt(since), frameCount() - 1, cameraPose(), localCentroid());
}

std::optional<PosePrior> SemanticSlam::priorOfTheRest() const
{
	std::vector<ObjectId> rest;
	for (const auto& entry : map_->objects())
		if (!localMap_.contains(entry.first)) rest.push_back(entry.first);
	const bool isOneSided = rest.empty() || rest.size() == map_->objects().size();
	if (isOneSided || options_.maxDriftSigmas == 0) return {};
	return priorOf(rest);
}

double SemanticSlam::driftSigmas(const LoopVerdict& verdict) const
{
	mrpt::math::TPoint3D centroid(0, 0, 0);
	auto since = odometryTrajectory_.back().time;
	const double weight = 1.0 / double(verdict.matches.size() + verdict.cameras.size());
	for (const auto& [query, target] : verdict.matches)
	{
		centroid += map_->object(query).centre() * weight;
		since = std::min(since, map_->object(target).lastSeen);
	}
	for (const CameraMatch& match : verdict.cameras)
	{
		centroid += poseGraph_->pose(NodeId::camera(match.query)).translation() * weight;
		since = std::min(since, odometryTrajectory_[match.target].time);
	}
	return driftPrior_.sigmas(
		frameAt(since), frameCount() - 1, cameraPose(), verdict.T_target_query, centroid);
}

void SemanticSlam::followOptimizedCamera()
{
	T_world_odom_ =
		poseGraph_->pose(cameraNode()) + (-(T_odom_camera_ + correction_.T_odometry_camera()));
}

void SemanticSlam::finish()
{
	if (frameCount() == 0) return;
	loopCloser_->optimize();
	followOptimizedCamera();
	maintainMap();
	loopCloser_->mergeAllDuplicates(localMap_, *mapper_);
}

Trajectory SemanticSlam::trajectory() const
{
	Trajectory result;
	for (std::size_t i = 0; i < frameCount(); ++i)
		result.push_back({odometryTrajectory_[i].time, poseGraph_->pose(NodeId::camera(i))});
	return result;
}

}  // namespace semloop

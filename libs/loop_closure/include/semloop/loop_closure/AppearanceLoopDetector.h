#pragma once

#include <semloop/loop_closure/CameraVerification.h>
#include <semloop/loop_closure/InvertedIndex.h>
#include <semloop/loop_closure/LoopDetector.h>
#include <semloop/loop_closure/OrbFeatures.h>
#include <semloop/loop_closure/OrbVocabulary.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace semloop
{
struct AppearanceOptions : Options
{
	int features = 1000;       //!< of a key frame
	int keyFrameEvery = 10;    //!< segmented frames
	int minFramesApart = 500;  //!< of the two key frames of a loop; Sec. IV-B
	int maxQueries = 10;  //!< key frames of the local map that one question is about, the latest
	CameraVerificationOptions verification;

	void describe(OptionFields& fields) override;
};

/** Detects loops by what single images look like, without objects: the baselines that Table I compares with.
 *
 *  Key frames of the local map that were in no question before look for key frames from before the local map:
 *  candidates() proposes, compareCameras() decides. The verdict's loop is the pair of cameras with the most
 *  inliers. A prior is not used. A key frame takes 48 bytes a feature.
 *
 *  The keys are in [appearance], so that one configuration has those of the semantic detector, too. */
class AppearanceLoopDetector : public LoopDetector
{
	DEFINE_VIRTUAL_MRPT_OBJECT(AppearanceLoopDetector)

public:
	void addFrame(std::size_t frame, const RgbdFrame& images) override;
	/** Throws std::invalid_argument without T_world_camera. */
	LoopVerdict detect(const LoopQuery& query) override;

	std::size_t keyFrames() const { return keyFrames_.size(); }

protected:
	/** A key frame has come; they are numbered in this order. */
	virtual void remember(const OrbFeatures& features) = 0;
	/** Key frames before `end` that this one may be a picture of, best first. */
	virtual std::vector<std::size_t> candidates(std::size_t keyFrame, std::size_t end) const = 0;
	virtual const AppearanceOptions& appearance() const = 0;

private:
	struct KeyFrame
	{
		std::size_t frame;
		OrbFeatures features;
	};
	std::vector<KeyFrame> keyFrames_;
	std::size_t offered_ = 0;  //!< frames
	std::size_t asked_ = 0;    //!< key frames that were in a question
};

struct BagOfWordsLoopDetectorOptions : AppearanceOptions
{
	std::string vocabulary;      //!< file
	double minSimilarity = 0.3;  //!< as a share of that with the key frame before
	int maxCandidates = 5;       //!< verified for each key frame

	void describe(OptionFields& fields) override;
};

/** Bags of ORB words with an inverted index and geometric verification, the loop detector of ORB-SLAM2 (R.
 *  Mur-Artal and J. D. Tardos, IEEE T-RO 2017) in outline. A candidate's similarity is taken relative to that of
 *  two consecutive key frames, s(q, t) / s(q, q - 1) >= min_similarity (D. Galvez-Lopez and J. D. Tardos, IEEE
 *  T-RO 2012, Eq. 2). */
class BagOfWordsLoopDetector : public AppearanceLoopDetector
{
	DEFINE_MRPT_OBJECT(BagOfWordsLoopDetector, semloop)

public:
	/** Throws UsageError without a vocabulary, InputError when it cannot be read. */
	void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;

	BagOfWordsLoopDetectorOptions options;
	void setVocabulary(OrbVocabulary vocabulary) { vocabulary_ = std::move(vocabulary); }

protected:
	void remember(const OrbFeatures& features) override;
	std::vector<std::size_t> candidates(std::size_t keyFrame, std::size_t end) const override;
	const AppearanceOptions& appearance() const override { return options; }

private:
	OrbVocabulary vocabulary_;
	std::vector<BagOfWords> bags_;
	InvertedIndex index_;
};

/** Plain ORB matching with RANSAC: every earlier key frame is a candidate. The time grows with the map. */
class OrbLoopDetector : public AppearanceLoopDetector
{
	DEFINE_MRPT_OBJECT(OrbLoopDetector, semloop)

public:
	void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;

	AppearanceOptions options;

protected:
	void remember(const OrbFeatures& features) override;
	std::vector<std::size_t> candidates(std::size_t keyFrame, std::size_t end) const override;
	const AppearanceOptions& appearance() const override { return options; }
};

}  // namespace semloop

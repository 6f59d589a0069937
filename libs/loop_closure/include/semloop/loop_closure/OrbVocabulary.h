#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <string>
#include <utility>
#include <vector>

namespace semloop
{
/** An image as visual words: word and weight, by word, no word twice; the weights are above 0 and sum to 1. */
using BagOfWords = std::vector<std::pair<std::uint32_t, float>>;

struct OrbVocabularyOptions
{
	int branching = 10;   //!< children of a node, in [2, 100]
	int levels = 4;       //!< below the root, in [1, 8]
	int iterations = 10;  //!< of each clustering at most
	unsigned seed = 1;
};

/** A tree of ORB words (J. Sivic and A. Zisserman, ICCV 2003; D. Nister and H. Stewenius, CVPR 2006; of binary
 *  descriptors D. Galvez-Lopez and J. D. Tardos, IEEE T-RO 2012).
 *
 *  Each node's descriptors are clustered by k-majority: seeded as in k-means++ (D. Arthur and S. Vassilvitskii,
 *  SODA 2007) with Hamming distances, a cluster's centre has the bits that most of its members have. A leaf is
 *  a word; it weighs idf = ln(N / N_i), N images of which N_i have it. */
class OrbVocabulary
{
public:
	OrbVocabulary() = default;

	/** Descriptors (CV_8UC1, 32 columns) of each image. The same input gives the same tree. Throws InputError
	 *  when there are fewer descriptors than `branching` or fewer than two images, std::invalid_argument on
	 *  options out of range. */
	static OrbVocabulary train(
		const std::vector<cv::Mat>& images, const OrbVocabularyOptions& options = {});

	/** Format semloop.orb-vocabulary/1 (doc/file-formats.md). load() throws InputError naming the file when it is
	 *  missing, cut or not a vocabulary; save() when it cannot be written. */
	static OrbVocabulary load(const std::string& path);
	void save(const std::string& path) const;

	std::size_t words() const { return words_; }
	/** The word whose centre is reached by going to the nearest child from the root on. */
	std::uint32_t word(const std::uint8_t* descriptor) const;
	double idf(std::uint32_t word) const { return idf_[word]; }
	/** tf-idf: weight of word i = its share of the descriptors * idf_i, then divided by the sum. Empty when every
	 *  word of the image is in all images of the training. */
	BagOfWords describe(const cv::Mat& descriptors) const;

private:
	struct Node
	{
		std::uint32_t firstChild = 0;  //!< nodes are in the order of their levels
		std::uint32_t children = 0;    //!< 0: a word
		std::uint32_t word = 0;        //!< of a leaf
	};
	void numberWords();

	std::vector<Node> nodes_;
	cv::Mat centres_;  //!< a row per node; the root's is not used
	std::vector<float> idf_;
	std::size_t words_ = 0;
};

/** Similarity of two images in [0, 1]: 1 - |v - w|_1 / 2 = sum of min(v_i, w_i) (Galvez-Lopez and Tardos, Eq. 1). */
double similarity(const BagOfWords& v, const BagOfWords& w);

}  // namespace semloop

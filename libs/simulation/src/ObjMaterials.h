#pragma once

#include <tiny_obj_loader.h>

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ObjModel.h"

namespace semloop
{
/** Appends MTL materials to a model: Kd as linear colour, the paths of those map_Kd that the archive
 *  has. A path is taken beside the model, then by its last name only: many are from the author's
 *  disk. */
void addMaterials(
	ObjModel& model, const std::vector<tinyobj::material_t>& materials, const ZipArchive& archive,
	const std::string& modelPath);

/** A texture as Mesh has it, at most `largest` pixels wide and high; what is transparent gets the mean
 *  colour of the rest. Empty when the bytes are not an image that can be read. */
std::optional<cv::Mat> decodeTexture(const std::string& bytes, int largest);

}  // namespace semloop

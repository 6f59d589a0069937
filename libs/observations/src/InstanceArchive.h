#pragma once

#include <mrpt/serialization/CArchive.h>
#include <semloop/observations/CObservationInstances.h>

#include <vector>

namespace semloop
{
// What CObservationInstances has in a stream; version 0 has no true objects. Reading checks every count before it asks for
// memory and throws InputError; CObservationInstances::validate() checks the values.

void writeLabels(mrpt::serialization::CArchive& out, const LabelSet& labels);
LabelSet readLabels(mrpt::serialization::CArchive& in);

/** Masks as runs, embeddings as IEEE half floats. */
void writeInstances(mrpt::serialization::CArchive& out, const std::vector<Instance>& instances);
std::vector<Instance> readInstances(
	mrpt::serialization::CArchive& in, cv::Size imageSize, uint8_t version);

}  // namespace semloop

#pragma once

#include <mrpt/serialization/CArchive.h>
#include <semloop/observations/CObservationInstances.h>

#include <vector>

namespace semloop
{
// What CObservationInstances, version 0, has in a stream. Reading checks every count before it asks for
// memory and throws InputError; CObservationInstances::validate() checks the values.

void writeLabels(mrpt::serialization::CArchive& out, const LabelSet& labels);
LabelSet readLabels(mrpt::serialization::CArchive& in);

/** Masks as runs, embeddings as IEEE half floats. */
void writeInstances(mrpt::serialization::CArchive& out, const std::vector<Instance>& instances);
std::vector<Instance> readInstances(mrpt::serialization::CArchive& in, cv::Size imageSize);

}  // namespace semloop

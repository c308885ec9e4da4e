#pragma once

#include <string>

namespace soft_tissue::studies
{
/**
 * What a step costs with each feature off, named but idle, and in use: DIR/features.csv.
 * @param quick  smaller bodies, few steps
 * @throws Error if a file can't be written
 */
void studyFeatures(const std::string& folder, bool quick);

}  // namespace soft_tissue::studies

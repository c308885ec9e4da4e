#pragma once

#include <string>

namespace soft_tissue::studies
{
/**
 * Runs all hard cases; writes stability.csv. Real meshes are those of $SOFT_TISSUE_DATA/hard.
 * @throws Error for a file that can't be written
 */
void studyStability(const std::string& folder, bool quick);
}  // namespace soft_tissue::studies

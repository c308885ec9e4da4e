#pragma once

#include <string>

namespace soft_tissue::studies
{
/**
 * Time to find what touches, by all methods and by FCL and Bullet where there are any; writes
 * DIR/detection.csv. All ways of a scene take turns, on one thread.
 * @param quick  small bodies and few turns only
 * @throws Error if the file can't be written
 */
void studyDetection(const std::string& folder, bool quick);

}  // namespace soft_tissue::studies

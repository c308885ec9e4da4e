#pragma once

#include <string>

namespace soft_tissue::studies
{
/**
 * Speed against error of elements, laws, meshes and linear solvers, one thread: DIR/fem.csv.
 * Beams, against quadratic tets on a finer mesh or against Newton's method carried to the end on
 * the same one, always of the same law; Cook's membrane against published values.
 * @param quick  small bodies only
 * @throws Error if a file can't be written
 */
void studyFemError(const std::string& folder, bool quick);

}  // namespace soft_tissue::studies

#pragma once

#include <string>

namespace soft_tissue::studies
{
/**
 * The step of this package beside a plain one (PlainFem) on the same falling beam, step by step in
 * turn; writes DIR/fem_race.csv, a line for each way, and DIR/fem_tip.csv, the tips' ways.
 * @param quick  one small beam, few steps
 * @throws Error if a file can't be written
 */
void raceFem(const std::string& folder, bool quick);

}  // namespace soft_tissue::studies

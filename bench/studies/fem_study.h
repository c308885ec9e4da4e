#pragma once

#include <string>

namespace soft_tissue::studies
{
/**
 * The step without contact: beside a plain one, DIR/fem_race.csv; beside Bullet,
 * DIR/fem_bullet.csv; beside what the machine could do, DIR/fem_roofline.csv; speed against error,
 * DIR/fem.csv.
 * @param quick  small bodies only, few steps
 * @throws Error if a file can't be written
 */
void studyFem(const std::string& folder, bool quick);

}  // namespace soft_tissue::studies

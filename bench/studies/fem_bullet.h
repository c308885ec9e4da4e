#pragma once

#include <string>

namespace soft_tissue::studies
{
/**
 * The step of this package beside Bullet's deformable bodies on the same falling beam, step by step
 * in turn, one thread; writes DIR/fem_bullet.csv: times, and how far tips are from Newton's method
 * carried to the end in the same law. Without Bullet its lines are missing.
 * @param quick  one small beam, few steps
 * @throws Error if the file can't be written
 */
void raceBullet(const std::string& folder, bool quick);

}  // namespace soft_tissue::studies

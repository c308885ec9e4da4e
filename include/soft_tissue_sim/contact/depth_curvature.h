#pragma once

#include <array>

#include "soft_tissue_sim/contact/contact_sample.h"

namespace soft_tissue
{
/**
 * What the second derivative of a sample's depth d by its nodes needs beyond the sample.
 *
 * The host's point that d is measured from has weights in the host's nodes, and they change as the
 * intruding point moves: a node's coefficient then falls by its `turn` per metre. With c the
 * coefficients, g the gradient, Q = `bend` and b = `turn`, the block (i, j) of the second
 * derivative of d^2 / 2 is
 *
 *     c_i c_j (g g^T + Q) - d (c_i b_j g^T + c_j g b_i^T) - s d^2 (b_i . b_j) g g^T
 *
 * with s = 1 where d is a distance, whose host point has moved with the weights, and s = 0 where d
 * is interpolated.
 */
struct DepthCurvature
{
  Mat3 bend = Mat3::Zero();  ///< d times the second derivative of d by the intruding point
  std::array<Vec3, ContactSample::kMaxNodes> turn{};  ///< 1/m; zero for nodes of the intruder
  bool distance = true;

  DepthCurvature() { turn.fill(Vec3::Zero()); }
};

}  // namespace soft_tissue

#pragma once

#include <vector>

#include "soft_tissue_sim/contact/contact_sample.h"
#include "soft_tissue_sim/contact/depth_curvature.h"
#include "soft_tissue_sim/energy/block_matrix.h"

namespace soft_tissue
{
/** Sum of 1/2 kappa area d^2, joules. */
double contactEnergy(const std::vector<ContactSample>& samples);

/** gradient += its derivative by the nodes, N. */
void addContactGradient(const std::vector<ContactSample>& samples, Points& gradient);

/**
 * hessian += the part kappa area c_i c_j g g^T of one sample's second derivative, which is all of
 * it where the depth is linear, and positive semi-definite; blocks with row <= column.
 */
void addLinearStiffness(const ContactSample& sample, BlockMatrix& hessian);

/** hessian += one sample's whole second derivative, as DepthCurvature has it; may be indefinite. */
void addStiffness(const ContactSample& sample, const DepthCurvature& curvature,
                  BlockMatrix& hessian);

}  // namespace soft_tissue

#pragma once

#include <string>

namespace soft_tissue::studies
{
/**
 * What contact costs of a step: two balls of tets that overlap or are apart, with segments, with
 * points, and with no contact named; writes DIR/contact_cost.csv.
 * @param quick  small balls, few steps
 * @throws Error if a file can't be written
 */
void studyContactCost(const std::string& folder, bool quick);

}  // namespace soft_tissue::studies

#pragma once

#include <string>

namespace soft_tissue::studies
{
/**
 * What share of the memory's bandwidth and of the arithmetic's peak, both measured beside them, the
 * matrix-vector product and the element loops reach, one thread; writes DIR/fem_roofline.csv.
 * Bytes are those of arrays that have to be read or written once, operations those of one law.
 * @param quick  a small mesh alone
 * @throws Error if the file can't be written
 */
void studyRoofline(const std::string& folder, bool quick);

}  // namespace soft_tissue::studies

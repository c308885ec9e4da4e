#pragma once

#include <string>

namespace soft_tissue::studies
{
/**
 * Contact forces against contact mechanics, and from mesh to mesh; writes DIR/contact.csv. Before
 * that, how long finding contacts takes, DIR/detection.csv, and what of a step is contact,
 * DIR/contact_cost.csv.
 * @param quick  coarse meshes only
 * @throws Error if a file can't be written
 */
void studyContact(const std::string& folder, bool quick);

}  // namespace soft_tissue::studies

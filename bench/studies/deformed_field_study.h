#pragma once

#include "field_table.h"

namespace soft_tissue::studies
{
/** Depth at points inside deformed bodies: carried from rest, interpolated from nodes marched on
 * the deformed shape, and by the closest feature. */
void studyDeformedFields(Table& table, bool quick);

}  // namespace soft_tissue::studies

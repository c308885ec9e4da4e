#pragma once

#include <string>

namespace soft_tissue::studies
{
/**
 * Speed against error of all distance fields: writes field.csv into a folder.
 * @param quick  small bodies only, each march timed once
 * @throws Error if the file can't be written
 */
void studyFields(const std::string& folder, bool quick);

}  // namespace soft_tissue::studies

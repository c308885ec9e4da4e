#pragma once

#include <string>

namespace soft_tissue::studies
{
/**
 * Steps of falling beams with two threads against one, ten in turn; writes DIR/fem_threads.csv, a
 * line for each ten. A virtual machine's cores are now two threads of one, now neighbours, now far
 * from each other, so each line has what a number takes from one core to the other and back.
 * Where there is one core it writes nothing.
 * @param quick  one small beam, few steps
 * @throws Error if the file can't be written
 */
void studyThreads(const std::string& folder, bool quick);

}  // namespace soft_tissue::studies

#include "fem_study.h"

#include "fem_bullet.h"
#include "fem_error.h"
#include "fem_race.h"
#include "fem_roofline.h"
#include "fem_threads.h"

namespace soft_tissue::studies
{
void studyFem(const std::string& folder, bool quick)
{
  raceFem(folder, quick);
  raceBullet(folder, quick);
  studyThreads(folder, quick);
  studyRoofline(folder, quick);
  studyFemError(folder, quick);
}

}  // namespace soft_tissue::studies

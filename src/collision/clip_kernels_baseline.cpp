#define SOFT_TISSUE_KERNELS kernels_baseline
#include "clip_kernels_impl.h"

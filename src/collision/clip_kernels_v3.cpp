#define SOFT_TISSUE_KERNELS kernels_v3
#include "clip_kernels_impl.h"

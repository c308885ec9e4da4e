#define SOFT_TISSUE_KERNELS kernels_baseline
#include "box_kernels_impl.h"

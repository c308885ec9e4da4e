#define SOFT_TISSUE_KERNELS kernels_v3
#include "box_kernels_impl.h"

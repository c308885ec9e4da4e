#define SOFT_TISSUE_KERNELS kernels_v3
#include "pcg_kernels_impl.h"

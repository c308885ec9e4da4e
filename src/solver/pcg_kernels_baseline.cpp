#define SOFT_TISSUE_KERNELS kernels_baseline
#include "pcg_kernels_impl.h"

#define SOFT_TISSUE_KERNELS kernels_baseline
#define SOFT_TISSUE_LANES 2
#include "pressed_tet_kernels_impl.h"

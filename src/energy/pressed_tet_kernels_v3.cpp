#define SOFT_TISSUE_KERNELS kernels_v3
#define SOFT_TISSUE_LANES 4
#include "pressed_tet_kernels_impl.h"

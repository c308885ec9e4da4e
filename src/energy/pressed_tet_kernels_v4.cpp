#define SOFT_TISSUE_KERNELS kernels_v4
#define SOFT_TISSUE_LANES 8
#include "pressed_tet_kernels_impl.h"

#define SOFT_TISSUE_KERNELS kernels_v3
#include "meeting_kernels_impl.h"

#define SOFT_TISSUE_KERNELS kernels_baseline
#include "meeting_kernels_impl.h"

#define SOFT_TISSUE_KERNELS kernels_v3
#include "triangle_tree_kernels_impl.h"

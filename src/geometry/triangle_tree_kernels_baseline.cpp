#define SOFT_TISSUE_KERNELS kernels_baseline
#include "triangle_tree_kernels_impl.h"

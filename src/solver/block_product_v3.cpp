#define SOFT_TISSUE_KERNELS kernels_v3
#include "block_product_impl.h"

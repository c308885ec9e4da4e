#define SOFT_TISSUE_KERNELS kernels_baseline
#include "block_product_impl.h"

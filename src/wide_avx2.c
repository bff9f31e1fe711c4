// wide_avx2.c — the kernel for AVX2, where the Makefile could ask for it.

#include "wide_levels.h"

#if defined(__AVX2__)
#include "wide_kernel.h"

const wide_level wide_level_avx2 = {"avx2", WIDE_KERNEL_ENTRIES};
#else
const wide_level wide_level_avx2 = {.name = "avx2"};
#endif

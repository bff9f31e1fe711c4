// wide_avx512.c — the kernel for AVX-512, where the Makefile could ask for it.

#include "wide_levels.h"

#if defined(__AVX512VL__)
#include "wide_kernel.h"

const wide_level wide_level_avx512 = {"avx512", WIDE_KERNEL_ENTRIES};
#else
const wide_level wide_level_avx512 = {.name = "avx512"};
#endif

// ready_avx512.c — the kernel for AVX-512, where the Makefile could ask
// for it.

#include "ready_levels.h"

#if defined(__AVX512F__)
#include "ready_kernel.h"
#include "ready_starts.h"

ready_function *const ready_avx512 = ready_kernel;
starts_function *const starts_avx512 = starts_kernel;
#else
ready_function *const ready_avx512 = NULL;
starts_function *const starts_avx512 = NULL;
#endif

// ready_avx512.c — the kernel for AVX-512, where the Makefile could ask
// for it.

#include "ready_levels.h"

#if defined(__AVX512F__)
#include "ready_kernel.h"
#include "ready_sky_ask.h"
#include "ready_sky_look.h"
#include "ready_starts.h"

ready_function *const ready_avx512 = ready_kernel;
starts_function *const starts_avx512 = starts_kernel;
const path_sky sky_avx512 = {sky_look_kernel, sky_ask_kernel};
#else
ready_function *const ready_avx512 = NULL;
starts_function *const starts_avx512 = NULL;
const path_sky sky_avx512 = {NULL, NULL};
#endif

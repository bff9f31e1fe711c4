// ready_avx2.c — the kernel for AVX2, where the Makefile could ask for
// it.

#include "ready_levels.h"

#if defined(__AVX2__)
#include "ready_kernel.h"
#include "ready_sky_ask.h"
#include "ready_sky_look.h"
#include "ready_starts.h"

ready_function *const ready_avx2 = ready_kernel;
starts_function *const starts_avx2 = starts_kernel;
const path_sky sky_avx2 = {sky_look_kernel, sky_ask_kernel};
#else
ready_function *const ready_avx2 = NULL;
starts_function *const starts_avx2 = NULL;
const path_sky sky_avx2 = {NULL, NULL};
#endif

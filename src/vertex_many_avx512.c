// vertex_many_avx512.c — the kernel for AVX-512, where the Makefile could ask
// for it.

#include "vertex_many_levels.h"

#if defined(__AVX512F__)
#include "vertex_many_kernel.h"

vertices_function *const vertex_many_avx512 = vertex_many_kernel;
#else
vertices_function *const vertex_many_avx512 = NULL;
#endif

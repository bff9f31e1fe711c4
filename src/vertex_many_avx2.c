// vertex_many_avx2.c — the kernel for AVX2, where the Makefile could ask for
// it.

#include "vertex_many_levels.h"

#if defined(__AVX2__)
#include "vertex_many_kernel.h"

vertices_function *const vertex_many_avx2 = vertex_many_kernel;
#else
vertices_function *const vertex_many_avx2 = NULL;
#endif

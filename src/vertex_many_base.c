// vertex_many_base.c — the kernel for every processor of the architecture.

#include "vertex_many_levels.h"

#include "vertex_many_kernel.h"

vertices_function *const vertex_many_base = vertex_many_kernel;

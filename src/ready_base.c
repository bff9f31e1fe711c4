// ready_base.c — the kernel for every processor of the architecture.

#include "ready_levels.h"

#include "ready_kernel.h"

ready_function *const ready_base = ready_kernel;

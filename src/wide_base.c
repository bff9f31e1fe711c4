// wide_base.c — the kernel for what every processor of the architecture has.

#include "wide_kernel.h"
#include "wide_levels.h"

const wide_level wide_level_base = {"base", WIDE_KERNEL_ENTRIES};

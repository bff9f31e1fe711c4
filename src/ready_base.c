// ready_base.c — the kernel for every processor of the architecture.

#include "ready_levels.h"

#include "ready_kernel.h"
#include "ready_sky_ask.h"
#include "ready_sky_look.h"
#include "ready_starts.h"

ready_function *const ready_base = ready_kernel;
starts_function *const starts_base = starts_kernel;
const path_sky sky_base = {sky_look_kernel, sky_ask_kernel};

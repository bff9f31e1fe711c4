// ready.h — starts of paths found together; vertices too, with all that can be
// known of them before their paths go on; the sky, looked at and asked.  The
// same to the bit as one by one.

#ifndef READY_H
#define READY_H

#include "path_sky.h"

// The functions by the best instructions that the processor has.
ready_function *ready_best(void);
starts_function *ready_starts_best(void);
const path_sky *ready_sky_best(void);

// Those of a level of wide.h; NULL where it is not compiled or does not run.
ready_function *ready_by(int level);
starts_function *ready_starts_by(int level);
const path_sky *ready_sky_by(int level);

#endif

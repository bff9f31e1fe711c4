// ready.h — vertices found together with all that can be known of them before
// their paths go on, the same to the bit as one by one.

#ifndef READY_H
#define READY_H

#include "path_ready.h"

// The function by the best instructions that the processor has.
ready_function *ready_best(void);

// That of a level of wide.h; NULL where it is not compiled or does not run.
ready_function *ready_by(int level);

#endif

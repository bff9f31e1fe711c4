// vertex_many.h — vertex_at for many hits at once, and the same to the bit.

#ifndef VERTEX_MANY_H
#define VERTEX_MANY_H

#include "vertex.h"

// The function by the best instructions that the processor has.
vertices_function *vertex_many_best(void);

// That of a level of wide.h; NULL where it is not compiled or does not run.
vertices_function *vertex_many_by(int level);

#endif

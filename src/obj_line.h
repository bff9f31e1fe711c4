// obj_line.h — one OBJ statement of any form, slowly and with messages.

#ifndef OBJ_LINE_H
#define OBJ_LINE_H

#include "obj_chunk.h"
#include "text.h"

// Apply a logical line to the chunk.  Sets c->problem when it is malformed.
void obj_line_parse(obj_chunk *c, span line, uint64_t number);

#endif

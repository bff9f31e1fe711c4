// obj_parse.h — the text of one piece of an OBJ file.

#ifndef OBJ_PARSE_H
#define OBJ_PARSE_H

#include "obj_chunk.h"
#include "text.h"

// Parse the whole lines of text into *c.  At least 16 bytes behind text are
// readable and NUL.
void obj_parse(obj_chunk *c, span text);

#endif

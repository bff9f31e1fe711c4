// picture_head.h — how large a picture is, by the first lines of its file.

#ifndef PICTURE_HEAD_H
#define PICTURE_HEAD_H

#include "error.h"

#include <stddef.h>

// What a picture would be if it were read.
typedef struct picture_head {
  int width, height;
} picture_head;

// Read the head of path and nothing else of it.  Fails where picture_read
// would for want of a head: no such file, no known format, no or senseless
// sides.  What comes after the head may still be damaged.
bool picture_head_read(picture_head *out, const char *path, error *err);

#endif

// pages.h — memory that is about to be written whole.

#ifndef PAGES_H
#define PAGES_H

#include <stddef.h>

// Have the system map the pages of these bytes now, all at once, instead of
// one interruption for each when it is first written.  A wish: nothing changes
// where it is not known.
void pages_expect(void *p, size_t bytes);

#endif

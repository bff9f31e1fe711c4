// arena.h — memory of one lifetime: allocate many times, release once.
//
// The only module that allocates.  It ends the program with exit status 5 and
// one line on stderr when memory runs out: no caller checks for NULL.

#ifndef ARENA_H
#define ARENA_H

#include <stdbool.h>
#include <stddef.h>

typedef struct arena_block arena_block;

// {0} is an empty arena.  One thread at a time.
typedef struct arena {
  arena_block *top;
} arena;

// n zeroed objects of the given size, aligned for any type; never NULL, also
// for n = 0.
void *arena_alloc(arena *a, size_t n, size_t size);

// Release everything; the arena is empty again.
void arena_free(arena *a);

// Make to own everything that from owns; from is empty then.
void arena_adopt(arena *to, arena *from);

// A copy of the first n bytes of s, ended by a NUL.
char *arena_text(arena *a, const char *s, size_t n);

// A printf-style string.
char *arena_format(arena *a, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// n zeroed objects of type T.
#define ARENA_NEW(a, T, n) ((T *)arena_alloc((a), (n), sizeof(T)))

// An array that grows: room for at least `need` elements of `size` bytes,
// twice the old room or more, old content kept, the rest not initialised.
// `old` may be NULL when *room is 0.  Released by array_free.
void *array_grow(void *old, size_t *room, size_t need, size_t size);
void array_free(void *array);

#endif

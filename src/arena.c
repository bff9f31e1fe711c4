// arena.c

// For madvise, which POSIX does not have.
#define _DEFAULT_SOURCE

#include "arena.h"

#include <stdalign.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

// Small requests share a block of this many bytes; larger ones get their own.
enum { BLOCK_BYTES = 1 << 16 };

// A large page, and how much of one must be used for it to cost less than small
// pages.
enum { LARGE_PAGE = 1 << 21, LARGE_WORTH = LARGE_PAGE / 2 };

// The bytes follow the header; `used` counts them.
struct arena_block {
  arena_block *next;
  size_t used, size;
  void *memory;  // that it lies in
  max_align_t bytes[];
};

// The one way out when memory is gone: exit status 5 is documented.
static _Noreturn void out_of_memory(size_t n, size_t size) {
  fprintf(stderr, "facet: out of memory for %zu x %zu bytes\n", n, size);
  exit(5);
}

// Ask for pages of megabytes where the system has them: fewer interruptions
// when they are first touched, and fewer addresses to look up ever after.
static void ask_large_pages(void *p, size_t bytes) {
#ifdef MADV_HUGEPAGE
  madvise(p, bytes, MADV_HUGEPAGE);
#else
  (void)p;
  (void)bytes;
#endif
}

// The bytes of so many that are worth large pages, in whole ones.
static size_t large_bytes(size_t bytes) {
  size_t rest = bytes % LARGE_PAGE;
  return bytes - rest + (rest >= LARGE_WORTH ? LARGE_PAGE : 0);
}

// Zeroed, or NULL.  A large page begins where its address is a multiple of its
// size, and so does a block that has some.
static arena_block *new_block(size_t room) {
  size_t bytes = sizeof(arena_block) + room, large = large_bytes(bytes);
  size_t most = bytes > large ? bytes : large;
  char *memory = calloc(1, most + (large > 0 ? LARGE_PAGE : 0));
  if (memory == NULL) return NULL;
  size_t into = 0;
  if (large > 0) {
    into = LARGE_PAGE - (uintptr_t)memory % LARGE_PAGE;
    ask_large_pages(memory + into, large);
  }
  arena_block *block = (void *)(memory + into);
  block->size = room;
  block->memory = memory;
  return block;
}

void *arena_alloc(arena *a, size_t n, size_t size) {
  if (size != 0 && n > (SIZE_MAX / 2) / size) out_of_memory(n, size);
  size_t align = alignof(max_align_t);
  size_t bytes = (n * size + align - 1) / align * align;
  arena_block *block = a->top;
  if (block == NULL || block->size - block->used < bytes) {
    bool own = bytes > BLOCK_BYTES / 4;
    size_t room = own ? bytes : BLOCK_BYTES;
    block = new_block(room);
    if (block == NULL) out_of_memory(n, size);
    if (own && a->top != NULL) {
      // Behind the top, which still has room for small requests.
      block->next = a->top->next;
      a->top->next = block;
    } else {
      block->next = a->top;
      a->top = block;
    }
  }
  void *p = (char *)block->bytes + block->used;
  block->used += bytes;
  return p;
}

void arena_free(arena *a) {
  for (arena_block *b = a->top, *next; b != NULL; b = next) {
    next = b->next;
    free(b->memory);
  }
  *a = (arena){0};
}

void arena_adopt(arena *to, arena *from) {
  arena_block **end = &from->top;
  while (*end != NULL)
    end = &(*end)->next;
  *end = to->top;
  to->top = from->top;
  *from = (arena){0};
}

char *arena_text(arena *a, const char *s, size_t n) {
  char *copy = arena_alloc(a, n + 1, 1);
  if (n > 0) memcpy(copy, s, n);
  return copy;
}

char *arena_format(arena *a, const char *format, ...) {
  va_list args, again;
  va_start(args, format);
  va_copy(again, args);
  int n = vsnprintf(NULL, 0, format, args);
  va_end(args);
  char *text = arena_alloc(a, (size_t)(n < 0 ? 0 : n) + 1, 1);
  if (n > 0) vsnprintf(text, (size_t)n + 1, format, again);
  va_end(again);
  return text;
}

void *array_grow(void *old, size_t *room, size_t need, size_t size) {
  if (need <= *room) return old;
  size_t more = *room * 2 > need ? *room * 2 : need;
  if (more < 16) more = 16;
  if (more > (SIZE_MAX / 2) / size) out_of_memory(more, size);
  void *array = realloc(old, more * size);
  if (array == NULL) out_of_memory(more, size);
  *room = more;
  return array;
}

void array_free(void *array) {
  free(array);
}

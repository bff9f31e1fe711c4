// pictures.h — what the tests of the picture formats share.

#ifndef PICTURES_H
#define PICTURES_H

#include "picture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// A loop of n turns, or a fiftieth of them under the sanitizers.
static inline int turns(int n) {
  return getenv("FACET_QUICK") == NULL ? n : n / 50 + 1;
}

// The next of a sequence of random-looking numbers.
static inline uint32_t next_random(uint32_t *state) {
  *state = *state * 1664525u + 1013904223u;
  return *state >> 8;
}

// One whole file in memory.
typedef struct blob {
  uint8_t *bytes;
  size_t size;
} blob;

// Read a file whole; size 0 when it is not there.
static inline blob blob_read(const char *path) {
  blob b = {NULL, 0};
  FILE *f = fopen(path, "rb");
  if (f == NULL) return b;
  fseek(f, 0, SEEK_END);
  b.size = (size_t)ftell(f);
  rewind(f);
  b.bytes = malloc(b.size + 1);
  b.size = fread(b.bytes, 1, b.size, f);
  b.bytes[b.size] = 0;
  fclose(f);
  return b;
}

// What a save function writes, in memory.
static inline blob blob_of_file(FILE *f) {
  blob b = {NULL, 0};
  fseek(f, 0, SEEK_END);
  b.size = (size_t)ftell(f);
  rewind(f);
  b.bytes = malloc(b.size + 1);
  assert_int_equal(fread(b.bytes, 1, b.size, f), b.size);
  fclose(f);
  return b;
}

// One of the two kinds of loader.
typedef struct loader {
  bool (*linear)(image *, FILE *, const char *, arena *, error *);
  bool (*stored)(pixmap *, FILE *, const char *, arena *, error *);
} loader;

// Load from the first n bytes; on failure the outputs must be untouched and
// the message must name the file.
static inline bool blob_load(loader l, const uint8_t *bytes, size_t n,
                             picture *out, arena *mem, error *err) {
  uint8_t none = 0;
  FILE *f = fmemopen(n > 0 ? (void *)(uintptr_t)bytes : &none, n, "rb");
  if (f == NULL) f = fopen("/dev/null", "rb");
  picture before = *out;
  void *top = mem->top;
  bool ok = l.linear != NULL
                ? l.linear(&out->linear, f, "test.picture", mem, err)
                : l.stored(&out->stored, f, "test.picture", mem, err);
  fclose(f);
  if (!ok) {
    assert_ptr_equal(mem->top, top);
    assert_memory_equal(&before, out, sizeof before);
    assert_non_null(strstr(err->text, "test.picture: "));
  }
  return ok;
}

// Every proper beginning of a file is refused.
static inline void check_truncations(loader l, blob b) {
  for (size_t n = 0; n < b.size; n++) {
    picture p = {0};
    arena mem = {0};
    error err = {{0}};
    if (blob_load(l, b.bytes, n, &p, &mem, &err))
      fail_msg("the first %zu of %zu bytes were taken for all", n, b.size);
  }
}

// A file with one byte changed is read or refused, and nothing else happens.
static inline void check_flips(loader l, blob b) {
  uint32_t state = 1;
  for (int i = 0; i < turns(2000); i++) {
    size_t at = next_random(&state) % b.size;
    uint8_t old = b.bytes[at];
    b.bytes[at] ^= (uint8_t)(next_random(&state) % 255 + 1);
    picture p = {0};
    arena mem = {0};
    error err = {{0}};
    if (blob_load(l, b.bytes, b.size, &p, &mem, &err)) {
      int side = l.linear != NULL ? p.linear.width : p.stored.width;
      assert_in_range(side, 1, IMAGE_MAX_SIDE);
    }
    arena_free(&mem);
    b.bytes[at] = old;
  }
}

// A picture with smooth and random parts, all values in [0, 1].
static inline image test_image(arena *mem, int width, int height) {
  image im = image_new(mem, width, height);
  uint32_t state = 7;
  for (int i = 0; i < width * height; i++) {
    float u = (float)(i % width) / (float)width;
    float noise = (float)(next_random(&state) % 1000) / 1000;
    im.pixels[i] = (vec3){u, noise, (i / width) % 2 ? 0.5f : u * noise};
  }
  return im;
}

#endif

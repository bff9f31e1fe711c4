// targets.h — one function for each kind of input that may come from a
// stranger: it reads the bytes as facet would, looks at all that came of them,
// and ends the program when that breaks a promise.  libFuzzer, AFL++ and the
// unit tests call the same functions.

#ifndef TARGETS_H
#define TARGETS_H

#include "bytes.h"
#include "digest.h"
#include "hdr.h"
#include "jpeg.h"
#include "mtl.h"
#include "normals.h"
#include "obj.h"
#include "option.h"
#include "part.h"
#include "pfm.h"
#include "picture.h"
#include "png.h"
#include "post.h"
#include "scene_file.h"
#include "tga.h"
#include "view_script.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// What every reader promises, broken: say so and end.
static inline void promise(bool kept, const char *what) {
  if (kept) return;
  fprintf(stderr, "broken promise: %s\n", what);
  abort();
}

// An error that can be shown: one line that is not empty.
static inline void check_error(const error *err) {
  size_t n = strnlen(err->text, sizeof err->text);
  promise(n > 0 && n < sizeof err->text, "an error has a text");
}

static inline void check_report(const report *r) {
  int n = 0;
  for (const report_line *l = r->first; l != NULL; l = l->next)
    n++;
  promise(n == r->stored && n <= REPORT_MAX, "remarks are counted");
}

// Indices of a mesh point at what is there.
static inline void check_index(const uint32_t *index, size_t triangles,
                               size_t count, bool may_be_none) {
  for (size_t i = 0; index != NULL && i < 3 * triangles; i++)
    promise(index[i] < count || (may_be_none && index[i] == MESH_NONE),
            "an index is in range");
}

static inline void check_mesh(const mesh *m) {
  size_t n = m->triangle_count, covered = 0;
  check_index(m->position_index, n, m->position_count, false);
  check_index(m->normal_index, n, m->normal_count, true);
  check_index(m->texcoord_index, n, m->texcoord_count, true);
  for (size_t i = 0; i < m->run_count; i++) {
    const mesh_run *r = &m->runs[i];
    promise(r->first == covered, "runs follow each other");
    promise(r->material < (int)m->material_count, "a run's material");
    promise(r->object < (int)m->object_count, "a run's object");
    promise(r->group < (int)m->group_count, "a run's group");
    covered += r->count;
  }
  promise(covered == n, "runs cover the mesh");
  promise(mesh_area(m) >= 0, "an area");
}

// The first byte says how small the pieces are in which the text is parsed, so
// that a few bytes have up to four; from 128 on there is one.
static inline int target_obj(const uint8_t *data, size_t size) {
  arena mem = {0};
  report r = {.mem = &mem};
  error err = {{0}};
  mesh m;
  if (size == 0) return 0;
  obj_request q = {.path = "f.obj",
                   .text = {(const char *)data + 1, size - 1},
                   .piece_bytes = data[0] < 128 ? data[0] + size / 4 : 0};
  if (obj_read_request(&m, &q, &mem, &r, &err)) {
    check_mesh(&m);
    normals_generate(&m, NORMALS_AUTO, 60, &mem, NULL);
    check_mesh(&m);
  } else {
    check_error(&err);
  }
  check_report(&r);
  arena_free(&mem);
  return 0;
}

static inline int target_mtl(const uint8_t *data, size_t size) {
  arena mem = {0};
  report r = {.mem = &mem};
  error err = {{0}};
  mtl_library lib = {0};
  span text = {(const char *)data, size};
  if (!mtl_read_text(&lib, text, "f.mtl", &mem, &r, &err)) check_error(&err);
  for (size_t i = 0; i < lib.count; i++)
    promise(mtl_find(&lib, lib.materials[i].name) == (long)i,
            "a material is found by its name");
  check_report(&r);
  arena_free(&mem);
  return 0;
}

static inline int target_scene(const uint8_t *data, size_t size) {
  arena mem = {0};
  report r = {.mem = &mem};
  error err = {{0}};
  scene_file f;
  span text = {(const char *)data, size};
  if (scene_file_read_text(&f, text, "f.scene", &mem, &r, &err)) {
    for (size_t i = 0; i < f.camera_count; i++)
      promise(vec3_finite(f.cameras[i].eye), "a camera has an eye");
    for (size_t i = 0; i < f.light_count; i++)
      promise(vec3_finite(f.lights[i].power), "a light is finite");
  } else {
    check_error(&err);
  }
  check_report(&r);
  arena_free(&mem);
  return 0;
}

static inline void check_sides(int width, int height) {
  promise(width > 0 && width <= IMAGE_MAX_SIDE && height > 0 &&
              height <= IMAGE_MAX_SIDE,
          "sides of a picture");
}

// Every sample, so that none is missing or uninitialised.
static inline void check_image(const image *im) {
  check_sides(im->width, im->height);
  volatile float last;
  for (size_t i = 0; i < (size_t)im->width * (size_t)im->height; i++)
    last = im->pixels[i].x + im->pixels[i].y + im->pixels[i].z;
  (void)last;
}

static inline void check_pixmap(const pixmap *p, arena *mem) {
  check_sides(p->width, p->height);
  promise(p->channels >= 1 && p->channels <= 4, "channels of a picture");
  promise(p->depth == 8 || p->depth == 16, "bits of a picture");
  image im = image_from_pixmap(mem, p, true);
  check_image(&im);
}

typedef bool load_linear(image *, FILE *, const char *, arena *, error *);
typedef bool load_stored(pixmap *, FILE *, const char *, arena *, error *);

static inline int try_picture(const uint8_t *data, size_t size,
                              load_linear *linear, load_stored *stored) {
  if (size == 0) return 0;
  arena mem = {0};
  error err = {{0}};
  image im;
  pixmap map;
  FILE *f = fmemopen((void *)(uintptr_t)data, size, "rb");
  promise(f != NULL, "fmemopen");
  bool ok = linear != NULL ? linear(&im, f, "f", &mem, &err)
                           : stored(&map, f, "f", &mem, &err);
  fclose(f);
  if (!ok) check_error(&err);
  if (ok && linear != NULL) check_image(&im);
  if (ok && stored != NULL) check_pixmap(&map, &mem);
  arena_free(&mem);
  return 0;
}

static inline int target_hdr(const uint8_t *data, size_t size) {
  return try_picture(data, size, hdr_load, NULL);
}

static inline int target_pfm(const uint8_t *data, size_t size) {
  return try_picture(data, size, pfm_load, NULL);
}

static inline int target_png(const uint8_t *data, size_t size) {
  return try_picture(data, size, NULL, png_load);
}

static inline int target_jpeg(const uint8_t *data, size_t size) {
  return try_picture(data, size, NULL, jpeg_load);
}

static inline int target_tga(const uint8_t *data, size_t size) {
  return try_picture(data, size, NULL, tga_load);
}

// The bytes are words, ended by line feeds, behind "facet".
static inline int target_option(const uint8_t *data, size_t size) {
  enum { MOST = 64 };
  char *words[MOST + 2] = {NULL};
  const char *operands[MOST + 2];
  arena mem = {0};
  char *text = arena_text(&mem, (const char *)data, size);
  int n = 0;
  words[n++] = arena_text(&mem, "facet", 5);
  for (char *at = text; at < text + size && n < MOST;) {
    words[n++] = at;
    at += strcspn(at, "\n");
    if (at < text + size) *at++ = '\0';
  }
  options o;
  error err = {{0}};
  if (n > 1) {
    if (options_parse(&o, n, words, operands, &err))
      promise(o.operand_count < n, "operands are words");
    else
      check_error(&err);
    post_frost pane;
    if (!post_parse(&pane, words[n - 1], &err)) check_error(&err);
  }
  arena_free(&mem);
  return 0;
}

// A script for the viewer.
static inline int target_script(const uint8_t *data, size_t size) {
  arena mem = {0};
  error err = {{0}};
  view_script s;
  span text = {(const char *)data, size};
  if (view_script_read(&s, text, "f.script", &mem, &err)) {
    for (size_t i = 0; i < s.count; i++)
      promise(s.events[i].kind != VIEW_EVENT_SPP || s.events[i].spp >= 1,
              "samples are counted from 1");
  } else {
    check_error(&err);
  }
  arena_free(&mem);
  return 0;
}

// Four bytes, the most significant first.
static inline uint32_t be32(const uint8_t *b) {
  return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 |
         b[3];
}

// A part of a picture, read in two steps as facet merge does.  It is read from
// a file by name: this one has none but its number.
static inline int target_part(const uint8_t *data, size_t size) {
  enum { MOST_PIXELS = 1 << 20 };
  char name[] = "/tmp/facet-fuzz-XXXXXX", path[64];
  int fd = mkstemp(name);
  promise(fd >= 0 && unlink(name) == 0, "a temporary file");
  promise(write(fd, data, size) == (ssize_t)size, "its bytes");
  snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
  arena mem = {0};
  error err = {{0}};
  part p;
  bool ok = part_read_head(&p, path, &mem, &err);
  if (ok && (int64_t)part_width(&p) * part_height(&p) <= MOST_PIXELS) {
    part_films_new(&p, &mem);
    ok = part_read_sums(&p, path, &err);
  }
  if (!ok) check_error(&err);
  close(fd);
  arena_free(&mem);
  return 0;
}

// Source: ISO/IEC 15948:2003, annex D, bit by bit.
static inline uint32_t crc_of(const uint8_t *bytes, size_t n) {
  uint32_t crc = UINT32_MAX;
  for (size_t i = 0; i < n; i++) {
    crc ^= bytes[i];
    for (int k = 0; k < 8; k++)
      crc = crc & 1 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
  }
  return ~crc;
}

// Give every chunk of a PNG its checksum, without which libpng looks no
// further: only what has a right one gets to the code behind.
static inline void mend_png(uint8_t *data, size_t size) {
  if (size < 8 || memcmp(data, "\x89PNG", 4) != 0) return;
  for (size_t at = 8; at + 12 <= size;) {
    uint32_t length = be32(data + at);
    if (length > size - at - 12) return;
    uint32_t sum = crc_of(data + at + 4, (size_t)length + 4);
    for (int i = 0; i < 4; i++)
      data[at + 8 + length + (size_t)i] = (uint8_t)(sum >> (24 - 8 * i));
    at += 12 + (size_t)length;
  }
}

static inline void seal(uint8_t *to, const uint8_t *bytes, size_t n) {
  bytes_put_u64(&to, digest_add(DIGEST_START, bytes, n));
}

// The same for a part, and for its sums where it has one tile only.
static inline void mend_part(uint8_t *data, size_t size) {
  if (size < PART_HEAD_BYTES || memcmp(data, PART_MAGIC, 8) != 0) return;
  const uint8_t *at = data + 12 + 4 * (PART_HEAD_WORDS - 1);
  size_t head = PART_HEAD_BYTES + (size_t)bytes_get_u32(&at);
  if (size < head + 8) return;
  seal(data + head, data, head);
  at = data + PART_HEAD_BYTES - 8;
  uint64_t tiles = bytes_get_u64(&at);
  uint8_t *table = data + head + 8;
  size_t left = size - head - 8;
  if (left < 8 || tiles > (left - 8) / PART_ROW_BYTES) return;
  size_t n = (size_t)tiles * PART_ROW_BYTES;
  if (tiles == 1) seal(table + n - 8, table + n + 8, left - n - 8);
  seal(table + n, table, n);
}

// A target and its name, which names its seeds and its dictionary too.
typedef struct target {
  const char *name;
  int (*run)(const uint8_t *data, size_t size);
} target;

static const target TARGETS[] = {
    {"obj", target_obj},       {"mtl", target_mtl},   {"scene", target_scene},
    {"hdr", target_hdr},       {"pfm", target_pfm},   {"png", target_png},
    {"jpeg", target_jpeg},     {"tga", target_tga},   {"option", target_option},
    {"script", target_script}, {"part", target_part},
};

enum { TARGET_COUNT = sizeof TARGETS / sizeof *TARGETS };

#endif

// raster_maps.c

#include "raster_maps.h"

#include "gl_make.h"
#include "num.h"

#include <string.h>

const texture_map *raster_map_of(const material *m, int k) {
  const texture_map *const all[RASTER_MAP_COUNT] = {
      &m->map_kd, &m->map_ks, &m->map_ke,   &m->map_ns,  &m->map_d,
      &m->map_pr, &m->map_pm, &m->map_bump, &m->map_norm};
  return all[k];
}

const char *raster_map_name(int k) {
  static const char *const names[RASTER_MAP_COUNT] = {
      "kd", "ks", "ke", "ns", "d", "pr", "pm", "bump", "norm"};
  return names[k];
}

raster_channels raster_map_channels(const texture_map *m, int k) {
  int n = m->image == NULL ? 3 : m->image->channels;
  char channel = m->options.channel;
  if (channel == 0 && k == RASTER_MAP_D && n % 2 == 0) channel = 'm';
  if (channel == 'm') return (raster_channels){.a = 1};
  if (n < 3 || channel == 'r') return (raster_channels){.r = 1};
  if (channel == 'g') return (raster_channels){.g = 1};
  if (channel == 'b') return (raster_channels){.b = 1};
  return (raster_channels){.r = 0.2126f, .g = 0.7152f, .b = 0.0722f};
}

// Where channel c of RGBA lies among n channels, -1: it is 1.
static int channel_source(int n, int c) {
  if (c == 3) return n % 2 == 0 ? n - 1 : -1;
  return n < 3 ? 0 : c;
}

// 8-bit samples as RGBA.
static uint8_t *bytes_rgba(const texture *t, arena *mem) {
  size_t count = (size_t)t->width * (size_t)t->height;
  uint8_t *out = ARENA_NEW(mem, uint8_t, 4 * count);
  for (size_t i = 0; i < 4 * count; i++) {
    int from = channel_source(t->channels, (int)(i % 4));
    size_t at = i / 4 * (size_t)t->channels;
    out[i] = from < 0 ? 255 : t->bytes[at + (size_t)from];
  }
  return out;
}

// Floats as RGBA, decoded where they are sRGB.
static float *floats_rgba(const texture *t, bool decode, arena *mem) {
  size_t count = (size_t)t->width * (size_t)t->height;
  float *out = ARENA_NEW(mem, float, 4 * count);
  for (size_t i = 0; i < 4 * count; i++) {
    int from = channel_source(t->channels, (int)(i % 4));
    size_t at = i / 4 * (size_t)t->channels;
    float x = from < 0 ? 1 : t->floats[at + (size_t)from];
    if (decode && i % 4 < 3 && x > 0)
      x = x <= 0.04045f ? x / 12.92f : num_pow((x + 0.055f) / 1.055f, 2.4f);
    out[i] = x;
  }
  return out;
}

static GLuint upload_map(const gl *g, const texture_map *m) {
  const texture *t = m->image;
  arena scratch = {0};
  GLenum wrap = m->options.clamp ? GL_CLAMP_TO_EDGE : GL_REPEAT;
  gl_texture_spec spec = {.width = t->width,
                          .height = t->height,
                          .format = GL_RGBA,
                          .wrap_s = wrap,
                          .wrap_t = wrap,
                          .mipmaps = true};
  if (t->bytes != NULL) {
    spec.internal = m->is_color ? GL_SRGB8_ALPHA8 : GL_RGBA8;
    spec.type = GL_UNSIGNED_BYTE;
    spec.pixels = bytes_rgba(t, &scratch);
  } else {
    spec.internal = GL_RGBA32F;
    spec.type = GL_FLOAT;
    spec.pixels = floats_rgba(t, m->is_color && !t->is_linear, &scratch);
  }
  GLuint name = gl_texture_new(g, &spec);
  arena_free(&scratch);
  return name;
}

static bool same_map(const texture_map *a, const texture_map *b) {
  return a->image == b->image && a->is_color == b->is_color &&
         a->options.clamp == b->options.clamp;
}

// The texture of an earlier statement with the same picture; 0: none.
static GLuint uploaded_before(const GLuint *maps, const scene *s, size_t n,
                              const texture_map *m) {
  for (size_t i = 0; i < n; i++) {
    const material *of = &s->materials[i / RASTER_MAP_COUNT];
    const texture_map *other = raster_map_of(of, (int)(i % RASTER_MAP_COUNT));
    if (maps[i] != 0 && same_map(other, m)) return maps[i];
  }
  return 0;
}

GLuint *raster_maps_upload(const gl *g, const scene *s, arena *mem) {
  size_t n = s->material_count * RASTER_MAP_COUNT;
  GLuint *maps = ARENA_NEW(mem, GLuint, n);
  for (size_t i = 0; i < n; i++) {
    const texture_map *m = raster_map_of(&s->materials[i / RASTER_MAP_COUNT],
                                         (int)(i % RASTER_MAP_COUNT));
    if (m->image == NULL) continue;
    GLuint before = uploaded_before(maps, s, i, m);
    maps[i] = before != 0 ? before : upload_map(g, m);
  }
  return maps;
}

// Names that are gone already are passed over by OpenGL.
void raster_maps_free(const gl *g, GLuint *maps, const scene *s) {
  GLsizei n = (GLsizei)(s->material_count * RASTER_MAP_COUNT);
  if (n > 0) gl_functions(g)->DeleteTextures(n, maps);
}

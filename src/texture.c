// texture.c — pictures on surfaces.

#include "texture.h"

#include "num.h"
#include "path_find.h"
#include "picture_head.h"

#include <string.h>

// Linear light for each of the 256 sRGB codes.
static float *decode_table(arena *mem) {
  float *table = ARENA_NEW(mem, float, 256);
  for (int k = 0; k < 256; k++)
    table[k] = (float)srgb_decode(k / 255.0);
  return table;
}

// 16-bit samples as floats in [0, 1].
static const float *floats_of(arena *mem, const pixmap *p) {
  size_t n = (size_t)p->width * (size_t)p->height * (size_t)p->channels;
  float *floats = ARENA_NEW(mem, float, n);
  const uint16_t *samples = p->samples;
  for (size_t i = 0; i < n; i++)
    floats[i] = (float)samples[i] / 65535;
  return floats;
}

// What p holds, as a texture.
static texture texture_of(texture_store *s, const char *path,
                          const picture *p) {
  if (p->is_linear)
    return (texture){.path = path,
                     .width = p->linear.width,
                     .height = p->linear.height,
                     .channels = 3,
                     .floats = &p->linear.pixels->x,
                     .is_linear = true};
  const pixmap *m = &p->stored;
  texture t = {.path = path,
               .width = m->width,
               .height = m->height,
               .channels = m->channels,
               .decode = s->decode};
  if (m->depth == 8) t.bytes = m->samples;
  if (m->depth == 16) t.floats = floats_of(s->mem, m);
  return t;
}

// The texture of that name, appended when it is new: *known says which.
static texture *store_entry(texture_store *s, const char *name, bool *known) {
  size_t i =
      (size_t)name_table_add(&s->names, (span){name, strlen(name)}, s->mem);
  *known = i < s->count;
  if (*known) return s->textures[i];
  if (s->count == s->room) {
    size_t room = s->room == 0 ? 16 : 2 * s->room;
    texture **more = ARENA_NEW(s->mem, texture *, room);
    if (s->count > 0) memcpy(more, s->textures, s->count * sizeof *more);
    s->textures = more;
    s->room = room;
  }
  return s->textures[s->count++] = ARENA_NEW(s->mem, texture, 1);
}

// Note what is wrong with a file.
static void set_problem(texture_store *s, texture *t, const char *why) {
  t->problem = arena_format(s->mem, "%s", why);
  s->failed++;
}

bool texture_refuse(texture_store *s, const char *path, const char *why) {
  bool known;
  texture *t = store_entry(s, path, &known);
  if (known) return false;
  t->path = arena_format(s->mem, "%s", path);
  set_problem(s, t, why);
  return true;
}

static bool is_decoded(const texture *t) {
  return t->bytes != NULL || t->floats != NULL;
}

// The entry of a file, by whatever path.
static texture *entry_of(texture_store *s, const char *path) {
  bool known;
  texture *t = store_entry(s, path_real(s->mem, path), &known);
  if (!known) t->path = arena_format(s->mem, "%s", path);
  return t;
}

const texture *texture_get(texture_store *s, const char *path, report *r,
                           error *err) {
  texture *t = entry_of(s, path);
  if (is_decoded(t)) return t;
  if (s->decode == NULL) s->decode = decode_table(s->mem);
  picture p;
  if (t->problem != NULL) {
    fail(err, "%s", t->problem);
    return NULL;
  }
  if (!picture_read(&p, path, s->mem, r, err)) {
    set_problem(s, t, err->text);
    return NULL;
  }
  *t = texture_of(s, t->path, &p);
  return t;
}

const char *texture_check(texture_store *s, const char *path, error *err) {
  texture *t = entry_of(s, path);
  picture_head head;
  if (t->problem == NULL && t->width > 0) return t->path;
  if (t->problem != NULL)
    fail(err, "%s", t->problem);
  else if (!picture_head_read(&head, path, err))
    set_problem(s, t, err->text);
  else
    t->width = head.width, t->height = head.height;
  return t->problem == NULL ? t->path : NULL;
}

size_t texture_decoded(const texture_store *s, size_t *bytes) {
  size_t n = 0;
  *bytes = 0;
  for (size_t i = 0; i < s->count; i++) {
    const texture *t = s->textures[i];
    if (!is_decoded(t)) continue;
    size_t sample = t->bytes != NULL ? 1 : sizeof(float);
    *bytes +=
        sample * (size_t)t->width * (size_t)t->height * (size_t)t->channels;
    n++;
  }
  return n;
}

// Channel c of the texel, as light when `color` asks for it.
static float texel(const texture *t, size_t at, int c, bool color) {
  size_t i = at * (size_t)t->channels + (size_t)c;
  if (t->bytes != NULL)
    return color ? t->decode[t->bytes[i]] : (float)t->bytes[i] / 255;
  float x = t->floats[i];
  if (!color || t->is_linear) return x;
  return x <= 0.04045f ? x / 12.92f : num_pow((x + 0.055f) / 1.055f, 2.4f);
}

// Four texels and their weights.
typedef struct footprint {
  size_t at[4];
  float weight[4];
} footprint;

// The two texels around coordinate x (0..1 over n texels) along one axis, and
// the share of the second.
static float texel_pair(float x, int n, bool clamp, int pair[2]) {
  if (!isfinite(x)) x = 0;
  x = clamp ? float_min(float_max(x, 0), 1) : x - floorf(x);
  float at = x * (float)n - 0.5f, lower = floorf(at);
  int i = (int)lower;
  pair[0] = i >= 0 ? i : clamp ? 0 : n - 1;
  pair[1] = i + 1 < n ? i + 1 : clamp ? n - 1 : 0;
  return at - lower;
}

// Where the options of m put uv on its picture.
static footprint footprint_of(const texture_map *m, vec2 uv) {
  const texture *t = m->image;
  float u = uv.x * m->options.scale.x + m->options.offset.x;
  float v = uv.y * m->options.scale.y + m->options.offset.y;
  int x[2], y[2];
  float fx = texel_pair(u, t->width, m->options.clamp, x);
  float fy = texel_pair(1 - v, t->height, m->options.clamp, y);
  footprint f;
  for (int k = 0; k < 4; k++) {
    f.at[k] = (size_t)y[k / 2] * (size_t)t->width + (size_t)x[k % 2];
    f.weight[k] = (k % 2 ? fx : 1 - fx) * (k / 2 ? fy : 1 - fy);
  }
  return f;
}

// Channel c over a footprint.
static float filtered(const texture_map *m, const footprint *f, int c,
                      bool color) {
  float sum = 0;
  for (int k = 0; k < 4; k++)
    sum += f->weight[k] * texel(m->image, f->at[k], c, color);
  return sum;
}

vec3 texture_rgb(const texture_map *m, vec2 uv) {
  footprint f = footprint_of(m, uv);
  if (m->image->channels < 3) return vec3_all(filtered(m, &f, 0, m->is_color));
  return (vec3){filtered(m, &f, 0, m->is_color),
                filtered(m, &f, 1, m->is_color),
                filtered(m, &f, 2, m->is_color)};
}

// The number that the channel letter names; 'm' is the matte: alpha, or 1 in a
// picture without.
static float channel_number(const texture_map *m, vec2 uv, char channel) {
  int n = m->image->channels;
  footprint f = footprint_of(m, uv);
  if (channel == 'm')
    return n == 2 || n == 4 ? filtered(m, &f, n - 1, false) : 1;
  if (n < 3) return filtered(m, &f, 0, m->is_color);
  if (channel == 'r') return filtered(m, &f, 0, m->is_color);
  if (channel == 'g') return filtered(m, &f, 1, m->is_color);
  if (channel == 'b') return filtered(m, &f, 2, m->is_color);
  // Luminance with the weights of the sRGB primaries (ITU-R BT.709).
  return 0.2126f * filtered(m, &f, 0, m->is_color) +
         0.7152f * filtered(m, &f, 1, m->is_color) +
         0.0722f * filtered(m, &f, 2, m->is_color);
}

float texture_number(const texture_map *m, vec2 uv) {
  char channel = m->options.channel;
  return channel_number(m, uv, channel == 0 ? 'l' : channel);
}

float texture_alpha(const texture_map *m, vec2 uv) {
  int n = m->image->channels;
  char usual = n == 2 || n == 4 ? 'm' : 'l';
  char channel = m->options.channel;
  return channel_number(m, uv, channel == 0 ? usual : channel);
}

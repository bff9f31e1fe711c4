// texture.h — pictures on surfaces.

#ifndef TEXTURE_H
#define TEXTURE_H

#include "error.h"
#include "mtl.h"
#include "picture.h"

// A file, decoded when it is first used: 8-bit samples as stored, or floats for
// HDR and PFM and 16-bit ones.
typedef struct texture {
  const char *path;
  int width, height, channels;
  const uint8_t *bytes;  // NULL when floats are used
  const float *floats;   // both NULL: not decoded
  bool is_linear;        // HDR and PFM: never to be decoded
  const float *decode;   // linear light by 8-bit sRGB code, shared by all
  const char *problem;   // why it could not be read, else NULL
} texture;

// Files by their real paths, each decoded once whatever it is called.  Start
// with {.mem = arena}.
typedef struct texture_store {
  texture **textures;
  size_t count, room;
  name_table names;  // name number = texture number
  const char *root;  // of path_root, for who looks for files; may be NULL
  int misses;        // of a path_search
  size_t failed;     // that have a problem
  arena *mem;
  float *decode;
} texture_store;

// The texture at path, loaded on first use; NULL when it cannot be read.  A
// file that failed is not tried again, but fails with the same message.
const texture *texture_get(texture_store *s, const char *path, report *r,
                           error *err);

// Remember that path is not to be read, and why; false when that is known.
bool texture_refuse(texture_store *s, const char *path, const char *why);

// The path by which the store knows a file, NULL when it is not there or has
// not the head of a picture.  It is not decoded.
const char *texture_check(texture_store *s, const char *path, error *err);

// How many are decoded, and their bytes.
size_t texture_decoded(const texture_store *s, size_t *bytes);

// A texture as a material uses it.
typedef struct texture_map {
  const texture *image;  // NULL: no texture
  mtl_map options;
  bool is_color;      // samples are sRGB, to be decoded
  const char *found;  // the file, where it is there and has a head; else NULL
} texture_map;

// Bilinear lookup at uv, (0, 0) the lower left corner of the picture, repeated
// or clamped by the options, which scale and shift uv first: linear RGB.
// Texel centres lie at (i + 0.5) / width.  A uv that is not finite reads as 0.
vec3 texture_rgb(const texture_map *m, vec2 uv);

// The same as one number: the channel that -imfchan names (z counts as l),
// else the luminance.
float texture_number(const texture_map *m, vec2 uv);

// The same as opacity: without -imfchan the alpha of a picture that has one,
// else its luminance.
float texture_alpha(const texture_map *m, vec2 uv);

#endif

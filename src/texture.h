// texture.h — pictures on surfaces.

#ifndef TEXTURE_H
#define TEXTURE_H

#include "error.h"
#include "mtl.h"
#include "picture.h"

// A decoded file: 8-bit samples as stored, or floats for HDR and PFM and
// 16-bit ones.
typedef struct texture {
  const char *path;
  int width, height, channels;
  const uint8_t *bytes;  // NULL when floats are used
  const float *floats;
} texture;

// Files by path, each decoded once.
typedef struct texture_store {
  texture **textures;
  size_t count, room;
  arena *mem;
} texture_store;

// The texture at path, loaded on first use.
const texture *texture_get(texture_store *s, const char *path, report *r,
                           error *err);

// A texture as a material uses it.
typedef struct texture_map {
  const texture *image;  // NULL: no texture
  mtl_map options;
  bool is_color;  // samples are sRGB, to be decoded
} texture_map;

// Bilinear lookup at uv, (0, 0) the lower left corner of the picture, repeated
// or clamped by the options: linear RGB, or one number by -imfchan (default
// luminance for grey maps and colour, alpha for map_d with alpha).
vec3 texture_rgb(const texture_map *m, vec2 uv);
float texture_number(const texture_map *m, vec2 uv);
float texture_alpha(const texture_map *m, vec2 uv);

#endif

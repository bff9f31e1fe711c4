// post.c

#include "post.h"

#include "num.h"
#include "rng.h"
#include "text.h"

#include <string.h>

// The radius of "frosted" alone: the grain shows, and a face is still known
// in a picture 500 to 1000 pixels wide.
#define DEFAULT_RADIUS 8.0f

// The key of the grains among all other uses of rng.
#define GRAIN_SEED UINT64_C(0x66726f7374)

// Where the grain of a film's pixel looks, in pixels from the pixel: uniform
// over a disc, so that many grains together are a blur by that disc.
static vec2 grain_tilt(int x, int y, float radius) {
  uint64_t pixel = (uint64_t)y << 32 | (uint64_t)x;
  rng random = rng_of(GRAIN_SEED, pixel, 0);
  float distance = radius * sqrtf(rng_next(&random));
  vec2 way = num_circle(rng_next(&random));
  return (vec2){distance * way.x, distance * way.y};
}

// The nearest whole number that is a row or column, 0..size-1.
static int clamp_index(int i, int size) {
  return i < 0 ? 0 : i >= size ? size - 1 : i;
}

static vec3 pixel_near(const image *im, int x, int y) {
  x = clamp_index(x, im->width);
  y = clamp_index(y, im->height);
  return im->pixels[(size_t)y * (size_t)im->width + (size_t)x];
}

// The picture at (x, y), between the four pixels around; whole numbers are
// the middles of pixels.
static vec3 pixel_between(const image *im, float x, float y) {
  float fx = floorf(x), fy = floorf(y);
  int i = (int)fx, j = (int)fy;
  vec3 top = vec3_lerp(pixel_near(im, i, j), pixel_near(im, i + 1, j), x - fx);
  vec3 low =
      vec3_lerp(pixel_near(im, i, j + 1), pixel_near(im, i + 1, j + 1), x - fx);
  return vec3_lerp(top, low, y - fy);
}

// What the threads share.
typedef struct frosting {
  const image *in;
  image out;
  post_frost pane;
} frosting;

// Work of the pool: one row.
static void frost_row(void *context, size_t row, int worker) {
  (void)worker;
  frosting *f = context;
  int y = (int)row;
  vec3 *out = f->out.pixels + row * (size_t)f->in->width;
  for (int x = 0; x < f->in->width; x++) {
    vec2 d = grain_tilt(x + f->pane.x0, y + f->pane.y0, f->pane.radius);
    out[x] = pixel_between(f->in, (float)x + d.x, (float)y + d.y);
  }
}

image post_frosted(const image *im, post_frost pane, arena *mem,
                   pool *threads) {
  frosting f = {im, image_new(mem, im->width, im->height), pane};
  pool_run(threads, (size_t)im->height, frost_row, &f);
  return f.out;
}

bool post_parse(post_frost *out, const char *text, error *err) {
  static const char NAME[] = "frosted";
  size_t n = sizeof NAME - 1;
  float radius = DEFAULT_RADIUS;
  bool good = strncmp(text, NAME, n) == 0;
  if (good && text[n] != 0) {
    span number = {text + n + 1, strlen(text + n) - 1};
    good = text[n] == '=' && span_float(number, &radius) && radius >= 0 &&
           radius <= POST_MAX_RADIUS;
  }
  if (!good)
    return fail(err,
                "--post wants frosted or frosted=RADIUS, RADIUS in pixels "
                "from 0 to %d, not '%s'",
                POST_MAX_RADIUS, text);
  out->radius = radius;
  return true;
}

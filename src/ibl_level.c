// ibl_level.c

#include "ibl_level.h"

// Nodes across: half of the lobe's width or less from one to the next, and
// fine enough for the bend at 90 degrees where a lobe reaches it.
static int level_width(float roughness) {
  if (roughness >= 0 && roughness < 0.14f) return 1024;
  return roughness < 0.25f || roughness > 0.55f ? 512 : 256;
}

ibl_level ibl_level_of(float roughness) {
  int width = level_width(roughness);
  return (ibl_level){roughness, width, width / 2 + 1, NULL};
}

void ibl_level_allocate(ibl_level *l, arena *mem) {
  l->texels = ARENA_NEW(mem, vec3, ibl_level_texels(l));
}

size_t ibl_level_texels(const ibl_level *l) {
  return (size_t)(l->height + 2) * (size_t)l->width;
}

// The pole of the splines' recursion, sqrt(3) - 2; its 24th power is 2e-14.
#define SPLINE_POLE -0.26794919243112270f

// Coefficients of the cubic B-spline that passes through n values of a closed
// line, in place.   Source:
// Unser 1999, box 2.
static void spline_filter(vec3 *line, int n) {
  vec3 sum = {0, 0, 0};
  float power = 1;
  for (int k = 0; k < 24; k++, power *= SPLINE_POLE)
    sum = vec3_mad(sum, power, line[(24 * n - k) % n]);
  line[0] = sum;
  for (int i = 1; i < n; i++)
    line[i] = vec3_mad(line[i], SPLINE_POLE, line[i - 1]);
  sum = vec3_all(0), power = 1;
  for (int k = 0; k < 24; k++, power *= SPLINE_POLE)
    sum = vec3_mad(sum, power, line[(n - 1 + k) % n]);
  line[n - 1] = vec3_scale(sum, -6 * SPLINE_POLE);
  for (int i = n - 2; i >= 0; i--)
    line[i] = vec3_scale(vec3_sub(vec3_scale(line[i + 1], 1.0f / 6), line[i]),
                         6 * SPLINE_POLE);
}

// Along a row, which is a closed line.
static void filter_row(void *context, size_t row, int worker) {
  (void)worker;
  const ibl_level *l = context;
  spline_filter(l->texels + (row + 1) * (size_t)l->width, l->width);
}

// Along a meridian from pole to pole and back on the other side, which is a
// closed line, too.
static void filter_meridian(void *context, size_t x, int worker) {
  (void)worker;
  const ibl_level *l = context;
  size_t width = (size_t)l->width, far = x + width / 2;
  int n = 2 * (l->height - 1), half = l->height - 1;
  vec3 line[2048];
  for (int i = 0; i < n; i++) {
    size_t row = (size_t)(i <= half ? i : n - i) + 1;
    line[i] = l->texels[row * width + (i <= half ? x : far)];
  }
  spline_filter(line, n);
  for (int i = 0; i < n; i++) {
    size_t row = (size_t)(i <= half ? i : n - i) + 1;
    l->texels[row * width + (i <= half ? x : far)] = line[i];
    if (i == 0 || i == half) l->texels[row * width + far] = line[i];
  }
}

// The rows beyond the poles are those before them, half a turn on.
static void pad_poles(ibl_level *l) {
  size_t width = (size_t)l->width, last = (size_t)l->height + 1;
  for (size_t x = 0; x < width; x++) {
    size_t far = (x + width / 2) % width;
    l->texels[x] = l->texels[2 * width + far];
    l->texels[last * width + x] = l->texels[(last - 2) * width + far];
  }
}

void ibl_level_to_spline(ibl_level *l, pool *threads) {
  pool_run(threads, (size_t)l->height, filter_row, l);
  pool_run(threads, (size_t)l->width / 2, filter_meridian, l);
  pad_poles(l);
}

// The weights of the four nodes around a place t in [0, 1) of a cell.
static void spline_weights(float w[4], float t) {
  float s = 1 - t;
  w[0] = s * s * s / 6;
  w[1] = (4 - 6 * t * t + 3 * t * t * t) / 6;
  w[2] = (4 - 6 * s * s + 3 * s * s * s) / 6;
  w[3] = t * t * t / 6;
}

vec3 ibl_level_at(const ibl_level *l, float u, float v) {
  float x = (u - floorf(u)) * (float)l->width;
  float y = fminf(fmaxf(v, 0), 1) * (float)(l->height - 1);
  int x0 = (int)x, y0 = (int)y < l->height - 2 ? (int)y : l->height - 2;
  float wx[4], wy[4];
  spline_weights(wx, x - (float)x0);
  spline_weights(wy, y - (float)y0);
  vec3 sum = {0, 0, 0};
  for (int j = 0; j < 4; j++) {
    const vec3 *row = l->texels + (size_t)(y0 + j) * (size_t)l->width;
    vec3 line = {0, 0, 0};
    for (int i = 0; i < 4; i++)
      line = vec3_mad(line, wx[i], row[(x0 + i - 1) & (l->width - 1)]);
    sum = vec3_mad(sum, wy[j], line);
  }
  return vec3_max(sum, vec3_all(0));
}

// light_env.c

#include "light_env.h"

#include "num.h"

// The texels that the built-in sky is tabulated with.
enum { SKY_WIDTH = 128, SKY_HEIGHT = 64 };

// The four texels around a cell, by what the table holds of each.
typedef struct cell {
  float a00, a01, a10, a11;  // row above, row below; left, right
} cell;

static int clamped(int i, int n) {
  return i < 0 ? 0 : i < n ? i : n - 1;
}

static float mean_of(vec3 c) {
  return c.x / 3 + c.y / 3 + c.z / 3;
}

static float value_at(const light_env *l, int x, int y) {
  return l->values[(size_t)y * (size_t)l->width + (size_t)x];
}

// Row j of cells lies between the texel rows j - 1 and j, column i likewise.
static cell cell_at(const light_env *l, int i, int j) {
  int left = i > 0 ? i - 1 : l->width - 1;
  int above = clamped(j - 1, l->height), below = clamped(j, l->height);
  return (cell){value_at(l, left, above), value_at(l, i, above),
                value_at(l, left, below), value_at(l, i, below)};
}

static float cell_mean(const cell *c) {
  return 0.25f * (c->a00 + c->a01 + c->a10 + c->a11);
}

static float cell_height(const light_env *l, int j) {
  return j == 0 || j == l->height ? 0.5f : 1;
}

static float row_sine(const light_env *l, int row) {
  return num_circle(((float)row + 0.5f) / (float)l->height * 0.5f).y;
}

// The built-in sky as a map, unrotated.
static image sky_map(const env *e, arena *mem) {
  image map = image_new(mem, SKY_WIDTH, SKY_HEIGHT);
  env still = *e;
  still.rotate = 0;
  still.scale = 1;
  for (int y = 0; y < SKY_HEIGHT; y++)
    for (int x = 0; x < SKY_WIDTH; x++) {
      vec2 uv = {((float)x + 0.5f) / SKY_WIDTH, ((float)y + 0.5f) / SKY_HEIGHT};
      map.pixels[y * SKY_WIDTH + x] = env_radiance(&still, env_direction(uv));
    }
  return map;
}

// Fills the values with radiance; its mean over the sphere.
static float fill_values(light_env *l, const image *map, float *peak) {
  double sum = 0, weight = 0;
  float *value = l->values;
  *peak = 0;
  for (int y = 0; y < l->height; y++) {
    double of_row = 0, sine = (double)row_sine(l, y);
    for (int x = 0; x < l->width; x++, value++) {
      *value = mean_of(map->pixels[value - l->values]);
      *peak = float_max(*peak, *value);
      of_row += (double)*value;
    }
    sum += of_row * sine;
    weight += l->width * sine;
  }
  return (float)(sum / weight);
}

// Makes the values what they are; gives the radiance that 1 stands for, 0 where
// nothing is above the mean.
static float measure(light_env *l, const image *map, arena *mem) {
  l->values = ARENA_NEW(mem, float, (size_t)l->width *(size_t)l->height);
  float peak, mean = fill_values(l, map, &peak), unit = 1 / (peak - mean);
  if (!(isfinite(unit) && unit > 0)) return 0;
  float *value = l->values;
  for (int y = 0; y < l->height; y++) {
    float scale = unit * row_sine(l, y);
    for (int x = 0; x < l->width; x++, value++)
      *value = float_max(*value - mean, 0) * scale;
  }
  return peak - mean;
}

// Work of the pool: the columns of one row of cells.
typedef struct row_job {
  light_env *light;
  float *values, *sums;
} row_job;

static void weigh_row(void *context, size_t item, int worker) {
  (void)worker;
  row_job *job = context;
  light_env *l = job->light;
  int j = (int)item, w = l->width;
  float *values = job->values + item * (size_t)w;
  for (int i = 0; i < w; i++) {
    cell c = cell_at(l, i, j);
    values[i] = cell_mean(&c);
  }
  double sum;
  pick_weigh(&l->columns[j], values, &sum);
  job->sums[j] = (float)sum * cell_height(l, j);
}

static void weigh(light_env *l, float unit, arena *mem, pool *threads) {
  size_t rows = (size_t)l->height + 1, width = (size_t)l->width;
  arena scratch = {0};
  row_job job = {l, ARENA_NEW(&scratch, float, rows *width),
                 ARENA_NEW(&scratch, float, rows)};
  l->columns = ARENA_NEW(mem, pick, rows);
  l->rows = pick_new(mem, (uint32_t)rows);
  for (size_t j = 0; j < rows; j++)
    l->columns[j] = pick_new(mem, (uint32_t)width);
  pool_run(threads, rows, weigh_row, &job);
  double sum;
  pick_weigh(&l->rows, job.sums, &sum);
  double cells = (double)width * (double)l->height;
  double mean = sum / cells * (double)unit;  // of radiance times sine
  l->irradiance = (float)(mean * (double)(PI * PI / 2)) * l->env->scale;
  arena_free(&scratch);
}

void light_env_build(light_env *out, const env *e, arena *mem, pool *threads) {
  *out = (light_env){.env = e};
  if (e->kind != ENV_SKY && e->kind != ENV_MAP) return;
  if (e->kind == ENV_MAP && e->map.pixels == NULL) return;
  if (!(e->scale > 0)) return;
  image map = e->kind == ENV_SKY ? sky_map(e, mem) : e->map;
  out->width = map.width;
  out->height = map.height;
  float unit = measure(out, &map, mem);
  if (unit > 0) weigh(out, unit, mem, threads);
}

// Where in [0, 1) a density falls that runs from a to b; not both 0.
static float sample_slope(float a, float b, float u) {
  float t = u * (a + b) / (a + sqrtf(a * a * (1 - u) + b * b * u));
  return float_min(t, FLOAT_BELOW_1);
}

// Density per steradian at (x, y) of a cell, where its probability is known.
static float cell_pdf(const light_env *l, const cell *c, vec2 at, float share) {
  float top = c->a00 * (1 - at.x) + c->a01 * at.x;
  float low = c->a10 * (1 - at.x) + c->a11 * at.x;
  float value = top * (1 - at.y) + low * at.y, mean = cell_mean(c);
  float cells = (float)l->width * (float)l->height;
  return mean > 0 ? share * cells * value / mean : 0;
}

// From a density over the unit square of the map: its height is pi radians,
// its width 2 pi sin.
static float per_steradian(float pdf, float v) {
  float sine = num_circle(0.5f * v).y;
  return sine > 0 ? pdf / (2 * PI * PI * sine) : 0;
}

bool light_env_sample(const light_env *l, float u1, float u2, vec3 *wi,
                      float *pdf) {
  if (!(l->irradiance > 0)) return false;
  float share_y, share_x;
  int j = (int)pick_at(&l->rows, &u2, &share_y);
  int i = (int)pick_at(&l->columns[j], &u1, &share_x);
  cell c = cell_at(l, i, j);
  if (!(cell_mean(&c) > 0)) return false;
  vec2 at;
  at.y = sample_slope(c.a00 + c.a01, c.a10 + c.a11, u2);
  at.x = sample_slope(c.a00 * (1 - at.y) + c.a10 * at.y,
                      c.a01 * (1 - at.y) + c.a11 * at.y, u1);
  float top = j > 0 ? (float)j - 0.5f : 0, high = cell_height(l, j);
  float u = ((float)i - 0.5f + at.x) / (float)l->width - l->env->rotate;
  float v = (top + high * at.y) / (float)l->height;
  *wi = env_direction((vec2){u - floorf(u), v});
  float of_square = cell_pdf(l, &c, at, share_x * share_y / high);
  *pdf = per_steradian(of_square, v);
  return *pdf > 0 && isfinite(*pdf);
}

float light_env_pdf(const light_env *l, vec3 wi) {
  if (!(l->irradiance > 0) || !vec3_finite(wi)) return 0;
  vec2 uv = env_uv(wi);
  float u = uv.x + l->env->rotate;
  float x = (u - floorf(u)) * (float)l->width + 0.5f;
  float y = uv.y * (float)l->height + 0.5f;
  int i = (int)x, j = clamped((int)y, l->height + 1);
  vec2 at = {x - (float)i, y - (float)j};
  if (i >= l->width) i = 0;
  float high = cell_height(l, j);
  if (j == 0) at.y = 2 * at.y - 1;
  if (j == l->height) at.y = float_min(2 * at.y, 1);
  cell c = cell_at(l, i, j);
  float share = pick_share(&l->columns[j], (uint32_t)i) *
                pick_share(&l->rows, (uint32_t)j) / high;
  float pdf = per_steradian(cell_pdf(l, &c, at, share), uv.y);
  return isfinite(pdf) ? pdf : 0;
}

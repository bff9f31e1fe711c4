// light_env.c

#include "light_env.h"

#include "num.h"

#include <string.h>

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
  const float third = 1.0f / 3;
  return c.x * third + c.y * third + c.z * third;
}

// What of radiance the table holds.
static float above(const light_env *l, vec3 c) {
  return float_max(mean_of(c) - l->less, 0);
}

// Row j of cells lies between the texel rows j - 1 and j, column i likewise.
typedef struct corners {
  const vec3 *above, *below;  // rows of the map
  float above_scale, below_scale;
  int left, right;
} corners;

static corners corners_of(const light_env *l, int i, int j) {
  const image *m = &l->map;
  int above = clamped(j - 1, m->height), below = clamped(j, m->height);
  return (corners){.above = m->pixels + (size_t)above * (size_t)m->width,
                   .below = m->pixels + (size_t)below * (size_t)m->width,
                   .above_scale = l->scale[above],
                   .below_scale = l->scale[below],
                   .left = i > 0 ? i - 1 : m->width - 1,
                   .right = i};
}

static cell cell_of(const light_env *l, const corners *c) {
  return (cell){above(l, c->above[c->left]) * c->above_scale,
                above(l, c->above[c->right]) * c->above_scale,
                above(l, c->below[c->left]) * c->below_scale,
                above(l, c->below[c->right]) * c->below_scale};
}

static float cell_mean(const cell *c) {
  return 0.25f * (c->a00 + c->a01 + c->a10 + c->a11);
}

static float cell_height(const light_env *l, int j) {
  return j == 0 || j == l->map.height ? 0.5f : 1;
}

static float row_sine(int row, int height) {
  return num_circle(((float)row + 0.5f) / (float)height * 0.5f).y;
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

// Finds the scale of each row; gives the radiance that 1 stands for, 0 where
// the table holds nothing.
static float measure(light_env *l, arena *mem) {
  const int rows = l->map.height;
  l->scale = ARENA_NEW(mem, float, (size_t)rows);
  float unit = 1 / (l->peak - l->less);
  if (!(isfinite(unit) && unit > 0)) return 0;
  for (int y = 0; y < rows; y++)
    l->scale[y] = unit * row_sine(y, rows);
  return l->peak - l->less;
}

// Rows of cells that are one item of work.
enum { RUN = 16 };

// What a worker needs: two rows of texels, by what the table holds, and one of
// cells.
typedef struct row_room {
  float *high, *low;
  double *values;
} row_room;

typedef struct row_job {
  light_env *light;
  row_room *rooms;
  double *sums;
} row_job;

// The corners of cells that lie in one row of texels.
static void weigh_texels(const light_env *l, int row, float *values) {
  size_t y = (size_t)clamped(row, l->map.height), w = (size_t)l->map.width;
  const vec3 *pixels = l->map.pixels + y * w;
  for (size_t i = 0; i < w; i++)
    values[i] = above(l, pixels[i]) * l->scale[y];
}

static void weigh_row(const row_job *job, const row_room *r, int j) {
  light_env *l = job->light;
  int w = l->map.width;
  for (int i = 0, left = w - 1; i < w; left = i++) {
    cell c = {r->high[left], r->high[i], r->low[left], r->low[i]};
    r->values[i] = (double)cell_mean(&c);
  }
  double sum;
  pick_weigh(&l->columns[j], r->values, &sum);
  job->sums[j] = (double)((float)sum * cell_height(l, j));
}

static void weigh_run(void *context, size_t item, int worker) {
  const row_job *job = context;
  row_room *r = &job->rooms[worker];
  const light_env *l = job->light;
  int from = (int)item * RUN, to = from + RUN;
  weigh_texels(l, from - 1, r->low);
  for (int j = from; j < to && j <= l->map.height; j++) {
    float *above = r->low;
    r->low = r->high;
    r->high = above;
    weigh_texels(l, j, r->low);
    weigh_row(job, r, j);
  }
}

static void weigh(light_env *l, float unit, arena *mem, pool *threads) {
  size_t rows = (size_t)l->map.height + 1, width = (size_t)l->map.width;
  int workers = threads == NULL ? 1 : pool_threads(threads);
  arena scratch = {0};
  row_job job = {l, ARENA_NEW(&scratch, row_room, (size_t)workers),
                 ARENA_NEW(&scratch, double, rows)};
  for (int k = 0; k < workers; k++)
    job.rooms[k] = (row_room){ARENA_NEW(&scratch, float, width),
                              ARENA_NEW(&scratch, float, width),
                              ARENA_NEW(&scratch, double, width)};
  l->columns = ARENA_NEW(mem, pick, rows);
  l->rows = pick_new(mem, (uint32_t)rows);
  pick_new_all(l->columns, rows, mem, (uint32_t)width);
  pool_run(threads, (rows + RUN - 1) / RUN, weigh_run, &job);
  double sum;
  pick_weigh(&l->rows, job.sums, &sum);
  double cells = (double)width * (double)l->map.height;
  double mean = sum / cells * (double)unit;  // of radiance times sine
  l->irradiance = (float)(mean * (double)(PI * PI / 2)) * l->env->scale;
  l->rest = float_max(PI * l->mean * l->env->scale - l->irradiance, 0);
  arena_free(&scratch);
}

// The mean of a map's radiance over the sphere, and the largest, row by row.
// Rows that are added up abreast do not wait for each other.
enum { ABREAST = 4 };

typedef struct mean_job {
  const image *map;
  double *sums;  // by row
  float *peaks;
} mean_job;

static void add_rows(void *context, size_t item, int worker) {
  (void)worker;
  const mean_job *job = context;
  const vec3 *row[ABREAST];
  int first = (int)item * ABREAST, n = job->map->height - first;
  for (int k = 0; k < ABREAST; k++)
    row[k] = job->map->pixels +
             (size_t)(first + (k < n ? k : 0)) * (size_t)job->map->width;
  double sum[ABREAST] = {0};
  float peak[ABREAST] = {0};
  for (int x = 0; x < job->map->width; x++)
    for (int k = 0; k < ABREAST; k++) {
      float value = mean_of(row[k][x]);
      peak[k] = float_max(peak[k], value);
      sum[k] += (double)value;
    }
  for (int k = 0; k < ABREAST && k < n; k++) {
    job->sums[first + k] = sum[k];
    job->peaks[first + k] = peak[k];
  }
}

static float mean_and_peak(const image *map, float *peak, pool *threads) {
  arena scratch = {0};
  size_t rows = (size_t)map->height;
  mean_job job = {map, ARENA_NEW(&scratch, double, rows),
                  ARENA_NEW(&scratch, float, rows)};
  pool_run(threads, (rows + ABREAST - 1) / ABREAST, add_rows, &job);
  double sum = 0, weight = 0;
  *peak = 0;
  for (int y = 0; y < map->height; y++) {
    double sine = (double)row_sine(y, map->height);
    *peak = float_max(*peak, job.peaks[y]);
    sum += job.sums[y] * sine;
    weight += map->width * sine;
  }
  arena_free(&scratch);
  return (float)(sum / weight);
}

static void fill(light_env *l, arena *mem, pool *threads) {
  float unit = measure(l, mem);
  if (unit > 0) weigh(l, unit, mem, threads);
}

void light_env_build(light_env *out, const env *e, arena *mem, pool *threads) {
  *out = (light_env){.env = e};
  if (e->kind != ENV_SKY && e->kind != ENV_MAP) return;
  if (e->kind == ENV_MAP && e->map.pixels == NULL) return;
  if (!(e->scale > 0)) return;
  out->map = e->kind == ENV_SKY ? sky_map(e, mem) : e->map;
  out->less = out->mean = mean_and_peak(&out->map, &out->peak, threads);
  fill(out, mem, threads);
}

void light_env_whole(light_env *out, const light_env *of, arena *mem,
                     pool *threads) {
  *out = *of;
  out->less = 0;
  if (of->map.pixels != NULL) fill(out, mem, threads);
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
  float cells = (float)l->map.width * (float)l->map.height;
  return mean > 0 ? share * cells * value / mean : 0;
}

// From a density over the unit square of the map: its height is pi radians,
// its width 2 pi sin.
static float per_steradian(float pdf, float v) {
  float sine = num_circle(0.5f * v).y;
  return sine > 0 ? pdf / (2 * PI * PI * sine) : 0;
}

static light_env_spot find_row(const light_env *l, vec2 u) {
  light_env_spot s = {.unit = (double)u.x * PICK_UNITS, .u = u};
  s.row = (int)pick_at(&l->rows, &s.u.y, &s.share);
  pick_expect(&l->columns[s.row], u.x);
  return s;
}

static void find_column(const light_env *l, light_env_spot *s) {
  float share;
  s->column = (int)pick_unit(&l->columns[s->row], s->unit, &s->u.x, &share);
  s->share *= share;
  corners at = corners_of(l, s->column, s->row);
  __builtin_prefetch(at.above + at.left);
  __builtin_prefetch(at.below + at.left);
  __builtin_prefetch(&at.above[at.right].z);
  __builtin_prefetch(&at.below[at.right].z);
}

void light_env_find_columns(const light_env *l, light_env_spot *s, size_t n) {
  for (size_t k = 0; k < n; k++)
    pick_search(&l->columns[s[k].row], s[k].u.x);
  for (size_t k = 0; k < n; k++)
    find_column(l, &s[k]);
}

void light_env_spots(const light_env *l, const vec2 *u, size_t n,
                     light_env_spot *out) {
  for (size_t k = 0; k < n; k++)
    out[k] = find_row(l, u[k]);
  light_env_find_columns(l, out, n);
}

// Radiance at a place of a cell, by what it is bilinear in.
static vec3 radiance_at(const light_env *l, const corners *c, vec2 at,
                        vec3 wi) {
  if (l->env->kind != ENV_MAP) return env_radiance(l->env, wi);
  vec3 above = vec3_lerp(c->above[c->left], c->above[c->right], at.x);
  vec3 below = vec3_lerp(c->below[c->left], c->below[c->right], at.x);
  return vec3_scale(vec3_lerp(above, below, at.y), l->env->scale);
}

env_sample light_env_sample_cell(const light_env *l, const light_env_spot *s) {
  env_sample none = {.pdf = 0};
  corners around = corners_of(l, s->column, s->row);
  cell c = cell_of(l, &around);
  if (!(cell_mean(&c) > 0)) return none;
  vec2 at;
  at.y = sample_slope(c.a00 + c.a01, c.a10 + c.a11, s->u.y);
  at.x = sample_slope(c.a00 * (1 - at.y) + c.a10 * at.y,
                      c.a01 * (1 - at.y) + c.a11 * at.y, s->u.x);
  float top = s->row > 0 ? (float)s->row - 0.5f : 0;
  float high = cell_height(l, s->row), left = (float)s->column - 0.5f;
  float u = (left + at.x) / (float)l->map.width - l->env->rotate;
  float v = (top + high * at.y) / (float)l->map.height;
  env_sample out = {.wi = env_direction((vec2){u - float_floor(u), v})};
  out.pdf = per_steradian(cell_pdf(l, &c, at, s->share / high), v);
  if (!(out.pdf > 0 && isfinite(out.pdf))) return none;
  out.radiance = radiance_at(l, &around, at, out.wi);
  return out;
}

void light_env_samples(const light_env *l, const vec2 *u, size_t n,
                       env_sample *out) {
  light_env_spot spots[LIGHT_TOGETHER];
  if (!(l->irradiance > 0)) memset(out, 0, n * sizeof *out);
  if (!(l->irradiance > 0)) return;
  for (size_t i = 0; i < n; i += LIGHT_TOGETHER) {
    size_t some = n - i < LIGHT_TOGETHER ? n - i : LIGHT_TOGETHER;
    light_env_spots(l, u + i, some, spots);
    for (size_t k = 0; k < some; k++)
      out[i + k] = light_env_sample_cell(l, &spots[k]);
  }
}

env_sample light_env_sample(const light_env *l, vec2 u) {
  env_sample one;
  light_env_samples(l, &u, 1, &one);
  return one;
}

light_env_place light_env_place_of(const light_env *l, vec2 uv) {
  const image *m = &l->map;
  float u = uv.x + l->env->rotate;
  float x = (u - float_floor(u)) * (float)m->width + 0.5f;
  float y = uv.y * (float)m->height + 0.5f;
  light_env_place p = {(int)x, clamped((int)y, m->height + 1), {0, 0}};
  p.at = (vec2){x - (float)p.column, y - (float)p.row};
  if (p.column >= m->width) p.column = 0;
  if (p.row == 0) p.at.y = 2 * p.at.y - 1;
  if (p.row == m->height) p.at.y = float_min(2 * p.at.y, 1);
  return p;
}

void light_env_expect(const light_env *l, vec2 uv) {
  if (!(l->irradiance > 0)) return;
  light_env_place p = light_env_place_of(l, uv);
  __builtin_prefetch(&l->columns[p.row].upto[p.column]);
}

float light_env_cell_density(const light_env *l, const light_env_place *p,
                             float v, float share) {
  corners around = corners_of(l, p->column, p->row);
  cell c = cell_of(l, &around);
  share /= cell_height(l, p->row);
  float pdf = per_steradian(cell_pdf(l, &c, p->at, share), v);
  return isfinite(pdf) ? pdf : 0;
}

float light_env_density(const light_env *l, vec2 uv) {
  if (!(l->irradiance > 0)) return 0;
  light_env_place p = light_env_place_of(l, uv);
  float share = pick_share(&l->columns[p.row], (uint32_t)p.column) *
                pick_share(&l->rows, (uint32_t)p.row);
  return light_env_cell_density(l, &p, uv.y, share);
}

float light_env_pdf(const light_env *l, vec3 wi) {
  return vec3_finite(wi) ? light_env_density(l, env_uv(wi)) : 0;
}

// light_memory.c

#include "light_memory.h"

#include <string.h>

enum { GRID = LIGHT_GRID, SIDES = LIGHT_SIDES, UNITS = LIGHT_UNITS };
enum { KEYS = GRID * GRID * GRID * SIDES };

// So many cells, cubed, are neighbours, who know about the same.
enum { NEAR = 3, SOME = GRID / NEAR, REGIONS = SOME * SOME * SOME * SIDES };

// The share of questions that goes to all parts by their power: memory is not
// certain.
#define DOUBT 0.1f

// A cell adds so many records of its region to its own, and a region as many of
// the whole scene.
#define SHARED 2.0f

// The least probability that any light is asked.
#define LEAST_ASKED 0.08f

// What a question costs, over all else that a path does at a vertex.
#define COST 0.25

// The relative variance of all light that nobody is asked for, and how much of
// it there is by way of other surfaces: a share of the usual light.
#define OTHER_NOISE 0.3
#define INDIRECT 0.1

// Where there are more cells than numbers for them, the rest learns nothing.
enum { MOST_CELLS = 1 << 16 };

static uint32_t step_of(float x) {
  return x > 0 ? (uint32_t)float_min(x, GRID - 1) : 0;
}

uint32_t light_memory_key(const light_memory *m, vec3 p, vec3 n) {
  vec3 at = vec3_scale(vec3_sub(p, m->lo), m->per_unit);
  uint32_t key = (step_of(at.z) * GRID + step_of(at.y)) * GRID + step_of(at.x);
  return key * SIDES + light_side(n);
}

// A cell by weights whose sum is the probability to ask at all.  Each part
// keeps a unit: what shines may be asked.
static light_cell cell_of_weights(const light_memory *m, const float *weights) {
  light_cell c;
  uint32_t n = m->count, end = 0;
  for (uint32_t i = 0; i < LIGHT_PARTS_MOST; i++) {
    if (i < n) end += 1 + (uint32_t)(weights[i] * (float)(UNITS - n - 1));
    c.last[i] = (uint16_t)(i < n ? end - 1 : UNITS - 1);
  }
  return c;
}

bool light_memory_new(light_memory *out, const float *power, uint32_t count,
                      vec3 lo, vec3 hi, arena *mem) {
  light_memory m = {.lo = lo, .count = count};
  float longest = vec3_peak(vec3_sub(hi, lo));
  m.per_unit = GRID / longest;
  if (!(longest > 0 && isfinite(m.per_unit)) || !vec3_finite(lo)) return false;
  float weights[LIGHT_PARTS_MOST], sum = 0;
  for (uint32_t i = 0; i < count; i++)
    sum += power[i];
  for (uint32_t i = 0; i < count; i++) {
    m.power[i] = power[i];
    weights[i] = power[i] / sum;
  }
  m.cell_of = ARENA_NEW(mem, uint16_t, KEYS);
  m.cells = ARENA_NEW(mem, light_cell, 1);
  m.cells[0] = cell_of_weights(&m, weights);
  *out = m;
  return true;
}

// What is known of a part in a cell: sums over `asked` questions, of weights
// and of weighted finds.
typedef struct lore {
  double asked, weights, finds, squares;
} lore;

// What that means: the irradiance; the mean square of a find; and the
// probability that a scattered ray goes there, in terms of that of a question.
typedef struct view {
  double mean, square, scattered;
} view;

// All parts from a cell, and all light that is there.
typedef struct outlook {
  view of[LIGHT_PARTS_MOST];
  double light;
} outlook;

// Learning: lore by cell and part, the first cell for all; the same for
// regions of neighbours.
typedef struct school {
  light_memory *m;
  double share[LIGHT_PARTS_MOST];  // of the power
  lore *of, *region;
  uint32_t *key_of, *visits;  // by cell
  uint32_t cells, parts;
  double usual;  // light, in all of the scene
} school;

static uint32_t region_of(uint32_t key) {
  uint32_t side = key % SIDES, x = key / SIDES % GRID;
  uint32_t y = key / SIDES / GRID % GRID, z = key / SIDES / GRID / GRID;
  return ((z / NEAR * SOME + y / NEAR) * SOME + x / NEAR) * SIDES + side;
}

// What a cell knows, with so much of what others know.
static lore refine(const lore *own, lore others) {
  double k = others.asked > 0 ? (double)SHARED / others.asked : 0;
  return (lore){
      own->asked + k * others.asked, own->weights + k * others.weights,
      own->finds + k * others.finds, own->squares + k * others.squares};
}

// The density of scattered rays over that of a question is taken to be the
// same all over a part: weights then are 1 / (1 + their quotient).
static view view_of(const school *s, uint32_t cell, uint32_t part) {
  lore l = s->of[part];
  if (cell > 0) {
    uint32_t region = region_of(s->key_of[cell]);
    l = refine(&s->region[region * s->parts + part], l);
    l = refine(&s->of[(size_t)cell * s->parts + part], l);
  }
  if (!(l.weights > 0)) return (view){0, 0, 0};
  return (view){l.finds / l.weights, l.squares / l.weights,
                s->share[part] * fmax(l.asked / l.weights - 1, 0)};
}

static outlook outlook_of(const school *s, uint32_t cell) {
  outlook o = {.light = (double)s->m->rest + INDIRECT * s->usual};
  for (uint32_t i = 0; i < s->parts; i++) {
    o.of[i] = view_of(s, cell, i);
    o.light += o.of[i].mean;
  }
  return o;
}

// The mean square of what both ways find together, with p for questions.
static double noise_of(const outlook *o, uint32_t n, const double *p) {
  double sum = OTHER_NOISE * o->light * o->light;
  for (uint32_t i = 0; i < n; i++)
    if (o->of[i].square > 0)
      sum += o->of[i].square / (p[i] + o->of[i].scattered);
  return sum;
}

// The factor of the roots with which all of one question is dealt out.
static double whole_question(const outlook *o, uint32_t n) {
  double factor = HUGE_VAL;
  for (bool again = true; again;) {
    double budget = 1, roots = 0, before = factor;
    for (uint32_t i = 0; i < n; i++) {
      double root = sqrt(o->of[i].square);
      if (!(root * before > o->of[i].scattered)) continue;
      budget += o->of[i].scattered;
      roots += root;
    }
    if (roots > 0) factor = budget / roots;
    again = roots > 0 && factor < before;
  }
  return factor;
}

// The best densities of both ways together are as the roots of the mean
// squares; what scattered rays give is left away.  One more question is worth
// its cost where that is the share of the noise that it takes away.  The
// result is how often to ask at all.
static double deal(const outlook *o, uint32_t n, double *p) {
  double most = whole_question(o, n), asked = 1;
  enum { ROUNDS = 4 };
  for (int k = 0; k < ROUNDS; k++) {
    double factor = fmin(most, 1 / sqrt(COST * noise_of(o, n, p)));
    asked = 0;
    for (uint32_t i = 0; i < n; i++) {
      double root = sqrt(o->of[i].square);
      p[i] = root > 0 ? fmax(root * factor - o->of[i].scattered, 0) : 0;
      asked += p[i];
    }
  }
  return asked;
}

static light_cell conclude(school *s, uint32_t cell) {
  double p[LIGHT_PARTS_MOST];
  float weights[LIGHT_PARTS_MOST];
  outlook o = outlook_of(s, cell);
  if (cell == 0) s->usual = o.light;
  memcpy(p, s->share, sizeof p);
  double asked = deal(&o, s->parts, p), sure = 1 - (double)DOUBT;
  double doubt = fmax(asked, (double)LEAST_ASKED) - sure * asked;
  for (uint32_t i = 0; i < s->parts; i++)
    weights[i] = (float)(sure * p[i] + doubt * s->share[i]);
  return cell_of_weights(s->m, weights);
}

static float share_of(const light_cell *c, uint32_t part) {
  uint32_t below = part > 0 ? c->last[part - 1] + 1u : 0;
  return (float)(c->last[part] + 1u - below) / UNITS;
}

// How many times the noise times the time would be without memory: relative to
// the light of each cell, since eyes adapt.
static double gain_of(const school *s) {
  double without = 0, with = 0;
  for (uint32_t cell = 1; cell < s->cells; cell++) {
    double p[LIGHT_PARTS_MOST], asked = 0;
    for (uint32_t i = 0; i < s->parts; i++) {
      p[i] = (double)share_of(&s->m->cells[cell], i);
      asked += p[i];
    }
    outlook o = outlook_of(s, cell);
    double times = s->visits[cell] / (o.light * o.light);
    if (!isfinite(times)) continue;
    with += times * noise_of(&o, s->parts, p) * (1 + COST * asked);
    without += times * noise_of(&o, s->parts, s->share) * (1 + COST);
  }
  return with > 0 ? without / with : 0;
}

static void note(lore *l, const light_record *r) {
  double weight = (double)r->weight, find = (double)r->found * weight;
  l->asked++;
  l->weights += weight;
  l->finds += find;
  l->squares += find * (double)r->found;
}

static void attend(school *s, const light_record *records, size_t n) {
  for (size_t i = 0; i < n; i++) {
    const light_record *r = &records[i];
    size_t cell = s->m->cell_of[r->key];
    s->visits[cell]++;
    note(&s->of[r->part], r);
    note(&s->of[cell * s->parts + r->part], r);
    note(&s->region[region_of(r->key) * s->parts + r->part], r);
  }
}

static void weigh_powers(school *s) {
  double sum = 0;
  for (uint32_t i = 0; i < s->parts; i++)
    sum += (double)s->m->power[i];
  for (uint32_t i = 0; i < s->parts; i++)
    s->share[i] = (double)s->m->power[i] / sum;
}

double light_memory_learn(light_memory *m, const light_record *records,
                          size_t n, arena *mem) {
  arena scratch = {0};
  school s = {.m = m, .cells = 1, .parts = m->count};
  m->cell_of = ARENA_NEW(mem, uint16_t, KEYS);
  for (size_t i = 0; i < n; i++)
    if (m->cell_of[records[i].key] == 0 && s.cells < MOST_CELLS)
      m->cell_of[records[i].key] = (uint16_t)s.cells++;
  s.key_of = ARENA_NEW(&scratch, uint32_t, s.cells);
  for (uint32_t i = 0; i < KEYS; i++)
    s.key_of[m->cell_of[i]] = i;
  s.visits = ARENA_NEW(&scratch, uint32_t, s.cells);
  s.region = ARENA_NEW(&scratch, lore, (size_t)REGIONS * s.parts);
  s.of = ARENA_NEW(&scratch, lore, (size_t)s.cells * s.parts);
  weigh_powers(&s);
  attend(&s, records, n);
  m->cells = ARENA_NEW(mem, light_cell, s.cells);
  for (uint32_t i = 0; i < s.cells; i++)
    m->cells[i] = conclude(&s, i);
  double gain = gain_of(&s);
  arena_free(&scratch);
  return gain;
}

static const light_cell *cell_at(const light_memory *m, uint32_t key) {
  return &m->cells[m->cell_of[key]];
}

// Eight numbers in a register.
typedef uint16_t eight __attribute__((vector_size(16)));

// How many parts end before a unit: no branch depends on it.
static uint32_t count_below(const light_cell *c, uint16_t unit) {
  eight at = {unit, unit, unit, unit, unit, unit, unit, unit}, sum = {0};
  for (int i = 0; i < LIGHT_PARTS_MOST; i += 8) {
    eight last;
    memcpy(&last, c->last + i, sizeof last);
    sum -= (eight)(last < at);
  }
  uint32_t count = 0;
  for (int i = 0; i < 8; i++)
    count += sum[i];
  return count;
}

bool light_memory_pick(const light_memory *m, uint32_t key, float u,
                       uint32_t *part, float *share) {
  const light_cell *c = cell_at(m, key);
  *part = count_below(c, (uint16_t)(u * UNITS));
  if (*part >= m->count) return false;
  *share = share_of(c, *part);
  return true;
}

float light_memory_share(const light_memory *m, uint32_t key, uint32_t part) {
  return share_of(cell_at(m, key), part);
}

// light_memory.c

#include "light_memory.h"

#include <string.h>

enum { GRID = LIGHT_GRID, SIDES = LIGHT_SIDES, UNITS = LIGHT_UNITS };
enum { KEYS = GRID * GRID * GRID * SIDES };

// The share of questions that goes to all parts by their power: memory is not
// certain.
#define DOUBT 0.1f

// The least probability that any light is asked.
#define LEAST_ASKED 0.08f

// What a question costs, over all else that a path does at a vertex.
#define COST 0.25

// The relative variance of all light, whoever finds it.
#define OTHER_NOISE 0.3

// What surfaces around send back of the usual light.
#define AROUND 0.5

// The least share of scattered rays that meet surfaces.
#define LEAST_HIDDEN 0.01

// So many rows are one item of work.
enum { ROWS = 64 };

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
    m.power[i] = m.usual[i] = power[i];
    weights[i] = power[i] / sum;
  }
  m.cell_of = ARENA_NEW(mem, uint16_t, KEYS);
  m.cells = ARENA_NEW(mem, light_cell, 1);
  m.cells[0] = cell_of_weights(&m, weights);
  *out = m;
  return true;
}

// What lore of a part means: the irradiance; the mean square of a find; and the
// probability that a scattered ray goes there, in terms of that of a question.
typedef struct view {
  double mean, square, scattered;
} view;

// All parts from a cell; all light that is there; what of it comes from
// surfaces around, and the share of scattered rays that go to them.
typedef struct outlook {
  view of[LIGHT_PARTS_MOST];
  double light, around, hidden;
} outlook;

// Noise times time, with memory and without.
typedef struct bill {
  double with, without;
} bill;

// Learning.
typedef struct school {
  light_memory *m;
  double share[LIGHT_PARTS_MOST];  // of the power
  double usual_share[LIGHT_PARTS_MOST];
  light_lore lore;
  bill *bills;  // of cells, by row
  uint32_t parts;
  double usual;  // light, in all of the scene
} school;

// Exact where only questions go to the part, and where only scattered rays do.
static view view_of(const lore *l) {
  if (!(l->squares > 0)) return (view){0, 0, 0};
  return (view){l->finds / l->asked, l->squares / l->asked,
                l->squares / l->alone};
}

static outlook outlook_of(const school *s, uint32_t row) {
  outlook o = {.light = (double)s->m->rest, .hidden = 1};
  for (uint32_t i = 0; i < s->parts; i++) {
    view v = o.of[i] = view_of(&light_lore_row(&s->lore, row)[i]);
    o.light += v.mean;
    if (v.square > 0) o.hidden -= v.scattered * v.mean * v.mean / v.square;
  }
  o.hidden = fmin(fmax(o.hidden, LEAST_HIDDEN), 1);
  o.around = AROUND * s->usual * o.hidden;
  o.light += o.around;
  return o;
}

// What a question and a scattered ray find on average, with p for questions,
// and the variance of both together.
typedef struct finds {
  double asked, scattered, variance;
} finds;

static finds finds_of(const outlook *o, uint32_t n, const double *p) {
  finds f = {.scattered = o->around};
  double squares = OTHER_NOISE * o->light * o->light;
  squares += o->around * o->around / o->hidden;
  for (uint32_t i = 0; i < n; i++) {
    const view *v = &o->of[i];
    if (!(v->square > 0)) continue;
    double both = 1 / (p[i] + v->scattered);
    f.asked += v->mean * p[i] * both;
    f.scattered += v->mean * v->scattered * both;
    squares += v->square * both;
  }
  f.variance = squares - f.asked * f.asked - f.scattered * f.scattered;
  return f;
}

// The best densities of both ways together are in proportion to these.
static void weigh_roots(const outlook *o, uint32_t n, const finds *f,
                        double *roots) {
  double ahead = 2 * (f->scattered - f->asked);
  for (uint32_t i = 0; i < n; i++) {
    const view *v = &o->of[i];
    roots[i] = sqrt(fmax(v->square - ahead * v->mean * v->scattered, 0));
  }
}

// The factor of the roots with which all of one question is dealt out.
static double whole_question(const outlook *o, uint32_t n,
                             const double *roots) {
  double factor = HUGE_VAL;
  for (bool again = true; again;) {
    double budget = 1, sum = 0, before = factor;
    for (uint32_t i = 0; i < n; i++) {
      if (!(roots[i] * before > o->of[i].scattered)) continue;
      budget += o->of[i].scattered;
      sum += roots[i];
    }
    if (sum > 0) factor = budget / sum;
    again = sum > 0 && factor < before;
  }
  return factor;
}

// What scattered rays give is left away.  One more question is worth its cost
// where that is the share of the noise that it takes away.  Each round goes
// half of the way: the roots depend on p.  The result is how often to ask at
// all.
static double deal(const outlook *o, uint32_t n, double *p) {
  double asked = 1, roots[LIGHT_PARTS_MOST];
  enum { ROUNDS = 6 };
  for (int k = 0; k < ROUNDS; k++) {
    finds f = finds_of(o, n, p);
    weigh_roots(o, n, &f, roots);
    double factor =
        fmin(whole_question(o, n, roots), 1 / sqrt(COST * fmax(f.variance, 0)));
    asked = 0;
    for (uint32_t i = 0; i < n; i++) {
      double best = roots[i] > 0 ? roots[i] * factor - o->of[i].scattered : 0;
      p[i] = (p[i] + fmax(best, 0)) / 2;
      asked += p[i];
    }
  }
  return asked;
}

static light_cell cell_of_outlook(const school *s, const outlook *o) {
  double p[LIGHT_PARTS_MOST];
  float weights[LIGHT_PARTS_MOST];
  memcpy(p, s->share, sizeof p);
  double asked = deal(o, s->parts, p), sure = 1 - (double)DOUBT;
  double doubt = fmax(asked, (double)LEAST_ASKED) - sure * asked;
  for (uint32_t i = 0; i < s->parts; i++)
    weights[i] = (float)(sure * p[i] + doubt * s->usual_share[i]);
  return cell_of_weights(s->m, weights);
}

static float share_of(const light_cell *c, uint32_t part) {
  uint32_t below = part > 0 ? c->last[part - 1] + 1u : 0;
  return (float)(c->last[part] + 1u - below) / UNITS;
}

// Of all visits of a cell: relative to its light, since eyes adapt.
static bill bill_of(const school *s, uint32_t row, const outlook *o) {
  double p[LIGHT_PARTS_MOST], asked = 0;
  for (uint32_t i = 0; i < s->parts; i++) {
    p[i] = (double)share_of(&s->m->cells[row], i);
    asked += p[i];
  }
  double times = s->lore.visits[row] / (o->light * o->light);
  if (!isfinite(times)) return (bill){0, 0};
  finds with = finds_of(o, s->parts, p);
  finds without = finds_of(o, s->parts, s->usual_share);
  return (bill){times * with.variance * (1 + COST * asked),
                times * without.variance * (1 + COST)};
}

static void conclude(void *context, size_t item, int worker) {
  (void)worker;
  school *s = context;
  uint32_t from = (uint32_t)item * ROWS, to = from + ROWS;
  for (uint32_t row = from; row < to && row < s->lore.rows; row++) {
    outlook o = outlook_of(s, row);
    s->m->cells[row] = cell_of_outlook(s, &o);
    if (row > 0 && row < s->lore.cells) s->bills[row] = bill_of(s, row, &o);
  }
}

// How many times the noise times the time would be without memory.
static double gain_of(const school *s) {
  bill sum = {0, 0};
  for (uint32_t row = 1; row < s->lore.cells; row++) {
    sum.with += s->bills[row].with;
    sum.without += s->bills[row].without;
  }
  return sum.with > 0 ? sum.without / sum.with : 0;
}

static void weigh_powers(school *s) {
  double sum = 0, usual = 0;
  for (uint32_t i = 0; i < s->parts; i++) {
    sum += (double)s->m->power[i];
    usual += (double)s->m->usual[i];
  }
  for (uint32_t i = 0; i < s->parts; i++) {
    s->share[i] = (double)s->m->power[i] / sum;
    s->usual_share[i] = (double)s->m->usual[i] / usual;
  }
}

double light_memory_learn(light_memory *m, const light_record *records,
                          size_t n, arena *mem, pool *threads) {
  arena scratch = {0};
  school s = {.m = m, .parts = m->count};
  weigh_powers(&s);
  s.lore = light_lore_of(records, n, s.share, s.parts, mem, &scratch);
  s.bills = ARENA_NEW(&scratch, bill, s.lore.cells);
  s.usual = outlook_of(&s, 0).light;
  m->cell_of = s.lore.row_of[0];
  m->cells = ARENA_NEW(mem, light_cell, s.lore.rows);
  pool_run(threads, (s.lore.rows + ROWS - 1) / ROWS, conclude, &s);
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

// light_memory.c

#include "light_memory.h"

#include <string.h>

enum { GRID = LIGHT_GRID, SIDES = LIGHT_SIDES, UNITS = LIGHT_UNITS };
enum { KEYS = GRID * GRID * GRID * SIDES, PARTS = LIGHT_PARTS_MOST };

// The share of questions that goes to all parts by their power: memory is not
// certain.
#define DOUBT 0.1f

// The least probability that any light is asked.
#define LEAST_ASKED 0.08f

// What a question costs, over all else that a path does at a vertex.
#define COST 0.25f

// The relative variance of all light, whoever finds it.
#define OTHER_NOISE 0.3f

// What surfaces around send back of the usual light.
#define AROUND 0.5f

// The least share of scattered rays that meet surfaces.
#define LEAST_HIDDEN 0.01f

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
  int32_t units[PARTS], n = (int32_t)m->count, end = -1;
  for (int32_t i = 0; i < PARTS; i++)
    units[i] = 1 + (int32_t)(weights[i] * (float)(UNITS - n - 1));
  for (int32_t i = 0; i < PARTS; i++) {
    end = i < n ? end + units[i] : UNITS - 1;
    c.last[i] = (uint16_t)end;
  }
  return c;
}

bool light_memory_new(light_memory *out, const float *power, uint32_t count,
                      vec3 lo, vec3 hi, arena *mem) {
  light_memory m = {.lo = lo, .count = count};
  float longest = vec3_peak(vec3_sub(hi, lo));
  m.per_unit = GRID / longest;
  if (!(longest > 0 && isfinite(m.per_unit)) || !vec3_finite(lo)) return false;
  float weights[PARTS] = {0}, sum = 0;
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

// What lore of parts means, in units of lore: the irradiance; the mean square
// of a find; and the probability that a scattered ray goes there, in terms of
// that of a question.  All light that is there; what of it comes from surfaces
// around, and the share of scattered rays that go to them.
typedef struct outlook {
  float mean[PARTS], square[PARTS], scattered[PARTS];
  float light, around, hidden;
} outlook;

// Noise times time, with memory and without.
typedef struct bill {
  double with, without;
} bill;

// Learning.
typedef struct school {
  light_memory *m;
  float share[PARTS];  // of the power
  float usual_share[PARTS];
  light_lore lore;
  bill *bills;  // of cells, by row
  float usual;  // light, in all of the scene
} school;

// Four numbers in a register.
typedef float four __attribute__((vector_size(16)));

// The sum of as many numbers as there are parts, always in the same order.
static float sum_of(const float *x) {
  four a, b, even = {0}, odd = {0};
  for (int i = 0; i < PARTS; i += 8) {
    memcpy(&a, x + i, sizeof a);
    memcpy(&b, x + i + 4, sizeof b);
    even += a;
    odd += b;
  }
  even += odd;
  return (even[0] + even[2]) + (even[1] + even[3]);
}

// Exact where only questions go to the part, and where only scattered rays do.
// A part that brought nothing is as if all rays went there: they bring nothing.
static void view_parts(const lore *l, outlook *o, float *seen) {
  for (int i = 0; i < PARTS; i++) {
    bool any = l->squares[i] > 0;
    float mean = l->finds[i] / l->asked[i];
    float square = l->squares[i] / l->asked[i];
    float scattered = l->squares[i] / l->alone[i];
    float share = scattered * mean * (mean / square);
    o->mean[i] = any ? mean : 0;
    o->square[i] = any ? square : 0;
    o->scattered[i] = any ? scattered : 1;
    seen[i] = any ? share : 0;
  }
}

static outlook outlook_of(const school *s, uint32_t row) {
  outlook o;
  float seen[PARTS];
  view_parts(&s->lore.of[row], &o, seen);
  o.hidden = float_min(float_max(1 - sum_of(seen), LEAST_HIDDEN), 1);
  o.around = AROUND * s->usual * o.hidden;
  o.light = s->m->rest * s->lore.unit + sum_of(o.mean) + o.around;
  return o;
}

// What a question and a scattered ray find on average, with p for questions,
// and the variance of both together.
typedef struct finds {
  float asked, scattered, variance;
} finds;

static finds finds_of(const outlook *o, const float *p) {
  float asked[PARTS], scattered[PARTS], squares[PARTS];
  for (int i = 0; i < PARTS; i++) {
    float both = 1 / (p[i] + o->scattered[i]);
    asked[i] = o->mean[i] * p[i] * both;
    scattered[i] = o->mean[i] * o->scattered[i] * both;
    squares[i] = o->square[i] * both;
  }
  finds f = {sum_of(asked), o->around + sum_of(scattered), 0};
  f.variance = OTHER_NOISE * o->light * o->light +
               o->around * o->around / o->hidden + sum_of(squares) -
               f.asked * f.asked - f.scattered * f.scattered;
  return f;
}

// The best densities of both ways together are in proportion to these.
static void weigh_roots(const outlook *o, const finds *f, float *roots) {
  float ahead = 2 * (f->scattered - f->asked);
  for (int i = 0; i < PARTS; i++)
    roots[i] = sqrtf(
        float_max(o->square[i] - ahead * o->mean[i] * o->scattered[i], 0));
}

// The factor of the roots with which all of one question is dealt out.
static float whole_question(const outlook *o, const float *roots) {
  float factor = INFINITY;
  for (bool again = true; again;) {
    float budgets[PARTS], sums[PARTS], before = factor;
    for (int i = 0; i < PARTS; i++) {
      bool part = roots[i] * before > o->scattered[i];
      budgets[i] = part ? o->scattered[i] : 0;
      sums[i] = part ? roots[i] : 0;
    }
    float budget = 1 + sum_of(budgets), sum = sum_of(sums);
    if (sum > 0) factor = budget / sum;
    again = sum > 0 && factor < before;
  }
  return factor;
}

// What scattered rays give is left away.  One more question is worth its cost
// where that is the share of the noise that it takes away.  The roots depend on
// p, so there are rounds, and after the first each goes half of the way.  The
// result is how often to ask at all.
static float deal(const outlook *o, float *p) {
  float roots[PARTS];
  enum { ROUNDS = 3 };
  for (int k = 0; k < ROUNDS; k++) {
    finds f = finds_of(o, p);
    weigh_roots(o, &f, roots);
    float factor = float_min(whole_question(o, roots),
                             1 / sqrtf(COST * float_max(f.variance, 0)));
    for (int i = 0; i < PARTS; i++) {
      float best = roots[i] * factor - o->scattered[i];
      best = roots[i] > 0 ? best : 0;
      best = float_max(best, 0);
      p[i] = k > 0 ? (p[i] + best) / 2 : best;
    }
  }
  return sum_of(p);
}

static light_cell cell_of_outlook(const school *s, const outlook *o) {
  float p[PARTS], weights[PARTS];
  memcpy(p, s->share, sizeof p);
  float asked = deal(o, p), sure = 1 - DOUBT;
  float doubt = float_max(asked, LEAST_ASKED) - sure * asked;
  for (int i = 0; i < PARTS; i++)
    weights[i] = sure * p[i] + doubt * s->usual_share[i];
  return cell_of_weights(s->m, weights);
}

static float share_of(const light_cell *c, uint32_t part) {
  uint32_t below = part > 0 ? c->last[part - 1] + 1u : 0;
  return (float)(c->last[part] + 1u - below) / UNITS;
}

// Those of all parts.
static void shares_of(const light_memory *m, const light_cell *c, float *p) {
  p[0] = share_of(c, 0);
  for (int32_t i = 1; i < PARTS; i++)
    p[i] = (float)(c->last[i] - c->last[i - 1]) / UNITS;
  for (uint32_t i = m->count; i < PARTS; i++)
    p[i] = 0;
}

// Of all visits of a cell: relative to its light, since eyes adapt.
static bill bill_of(const school *s, uint32_t row, const outlook *o) {
  float p[PARTS];
  shares_of(s->m, &s->m->cells[row], p);
  double light = (double)o->light, asked = (double)sum_of(p);
  double times = s->lore.visits[row] / (light * light);
  if (!isfinite(times)) return (bill){0, 0};
  finds with = finds_of(o, p), without = finds_of(o, s->usual_share);
  double cost = (double)COST;
  return (bill){times * (double)with.variance * (1 + cost * asked),
                times * (double)without.variance * (1 + cost)};
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
  float sum = 0, usual = 0;
  for (uint32_t i = 0; i < s->m->count; i++) {
    sum += s->m->power[i];
    usual += s->m->usual[i];
  }
  for (uint32_t i = 0; i < s->m->count; i++) {
    s->share[i] = s->m->power[i] / sum;
    s->usual_share[i] = s->m->usual[i] / usual;
  }
}

double light_memory_learn(light_memory *m, const light_record *records,
                          size_t n, arena *mem, pool *threads) {
  arena scratch = {0};
  school s = {.m = m};
  weigh_powers(&s);
  s.lore = light_lore_of(records, n, s.share, mem, &scratch);
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

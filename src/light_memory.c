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

// The relative variance of all light, whoever finds it.
#define OTHER_NOISE 0.3

// What surfaces around send back of the usual light.
#define AROUND 0.5

// The least quotient of the densities of scattered rays and of a question, the
// least weight of a question, and the least share of scattered rays that meet
// surfaces.
#define LEAST_SCATTERED 0.01
#define LEAST_WEIGHT 1e-6
#define LEAST_HIDDEN 0.01

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
    m.power[i] = m.usual[i] = power[i];
    weights[i] = power[i] / sum;
  }
  m.cell_of = ARENA_NEW(mem, uint16_t, KEYS);
  m.cells = ARENA_NEW(mem, light_cell, 1);
  m.cells[0] = cell_of_weights(&m, weights);
  *out = m;
  return true;
}

// What is known of a part in a cell: sums over `asked` questions, of what they
// found, of its squares, and of those over the density of scattered rays.
typedef struct lore {
  double asked, finds, squares, alone;
} lore;

// What that means: the irradiance; the mean square of a find; and the
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

// Learning: lore by cell and part, the first cell for all; the same for
// regions of neighbours.
typedef struct school {
  light_memory *m;
  double share[LIGHT_PARTS_MOST];  // of the power
  double usual_share[LIGHT_PARTS_MOST];
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
  return (lore){own->asked + k * others.asked, own->finds + k * others.finds,
                own->squares + k * others.squares,
                own->alone + k * others.alone};
}

// Exact where only questions go to the part, and where only scattered rays do.
static view view_of(const school *s, uint32_t cell, uint32_t part) {
  lore l = s->of[part];
  if (cell > 0) {
    uint32_t region = region_of(s->key_of[cell]);
    l = refine(&s->region[region * s->parts + part], l);
    l = refine(&s->of[(size_t)cell * s->parts + part], l);
  }
  if (!(l.squares > 0)) return (view){0, 0, 0};
  return (view){l.finds / l.asked, l.squares / l.asked, l.squares / l.alone};
}

static outlook outlook_of(const school *s, uint32_t cell) {
  outlook o = {.light = (double)s->m->rest, .hidden = 1};
  for (uint32_t i = 0; i < s->parts; i++) {
    view v = o.of[i] = view_of(s, cell, i);
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

static light_cell conclude(school *s, uint32_t cell) {
  double p[LIGHT_PARTS_MOST];
  float weights[LIGHT_PARTS_MOST];
  outlook o = outlook_of(s, cell);
  if (cell == 0) s->usual = o.light;
  memcpy(p, s->share, sizeof p);
  double asked = deal(&o, s->parts, p), sure = 1 - (double)DOUBT;
  double doubt = fmax(asked, (double)LEAST_ASKED) - sure * asked;
  for (uint32_t i = 0; i < s->parts; i++)
    weights[i] = (float)(sure * p[i] + doubt * s->usual_share[i]);
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
    with += times * finds_of(&o, s->parts, p).variance * (1 + COST * asked);
    without +=
        times * finds_of(&o, s->parts, s->usual_share).variance * (1 + COST);
  }
  return with > 0 ? without / with : 0;
}

static void note(lore *l, const light_record *r, double share) {
  double find = (double)r->found;
  double scattered = 1 / fmax((double)r->weight, LEAST_WEIGHT) - 1;
  l->asked++;
  l->finds += find;
  l->squares += find * find;
  l->alone += find * find / (share * fmax(scattered, LEAST_SCATTERED));
}

static void attend(school *s, const light_record *records, size_t n) {
  for (size_t i = 0; i < n; i++) {
    const light_record *r = &records[i];
    size_t cell = s->m->cell_of[r->key];
    s->visits[cell]++;
    double share = s->share[r->part];
    note(&s->of[r->part], r, share);
    note(&s->of[cell * s->parts + r->part], r, share);
    note(&s->region[region_of(r->key) * s->parts + r->part], r, share);
  }
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

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

static float power_of(const light_memory *m, uint32_t part) {
  const light_emitter *e = &m->parts.tree->emitters[m->parts.of[part].emitter];
  uint32_t cuts = e->is_point ? 1 : m->parts.cuts;
  return e->power / (float)(cuts * cuts);
}

// A cell by weights whose sum is the probability to ask at all.  Each part
// keeps a unit: what shines may be asked.
static light_cell cell_of_weights(const light_memory *m, const float *weights) {
  light_cell c;
  uint32_t n = m->parts.count, end = 0;
  for (uint32_t i = 0; i < LIGHT_PARTS_MOST; i++) {
    if (i < n) end += 1 + (uint32_t)(weights[i] * (float)(UNITS - n - 1));
    c.last[i] = (uint16_t)(i < n ? end - 1 : UNITS - 1);
  }
  return c;
}

bool light_memory_new(light_memory *out, const light_tree *t, vec3 lo, vec3 hi,
                      arena *mem) {
  light_memory m = {.lo = lo};
  float longest = vec3_peak(vec3_sub(hi, lo));
  m.per_unit = GRID / longest;
  if (!(longest > 0 && isfinite(m.per_unit)) || !vec3_finite(lo)) return false;
  if (!light_parts_of(&m.parts, t, mem)) return false;
  float weights[LIGHT_PARTS_MOST], power = 0;
  for (uint32_t i = 0; i < m.parts.count; i++)
    power += power_of(&m, i);
  for (uint32_t i = 0; i < m.parts.count; i++)
    weights[i] = power_of(&m, i) / power;
  m.cell_of = ARENA_NEW(mem, uint16_t, KEYS);
  m.cells = ARENA_NEW(mem, light_cell, 1);
  m.cells[0] = cell_of_weights(&m, weights);
  *out = m;
  return true;
}

// What is known of a part in a cell.
typedef struct lore {
  double squares;
  uint32_t asked;
} lore;

// Learning: lore by cell and part, the first cell for all; the same for
// regions of neighbours.
typedef struct school {
  light_memory *m;
  lore *of, *region;
  uint32_t *key_of, *visits;  // by cell
  uint32_t cells, parts;
  double whole;  // root of the mean square, summed over the parts, of all
} school;

static uint32_t region_of(uint32_t key) {
  uint32_t side = key % SIDES, x = key / SIDES % GRID;
  uint32_t y = key / SIDES / GRID % GRID, z = key / SIDES / GRID / GRID;
  return ((z / NEAR * SOME + y / NEAR) * SOME + x / NEAR) * SIDES + side;
}

static double refine(const lore *own, double usual) {
  return (own->squares + (double)SHARED * usual) /
         ((double)own->asked + (double)SHARED);
}

static double mean_square(const school *s, uint32_t cell, uint32_t part) {
  const lore *all = &s->of[part];
  double usual = all->asked > 0 ? all->squares / all->asked : 0;
  if (cell == 0) return usual;
  usual =
      refine(&s->region[region_of(s->key_of[cell]) * s->parts + part], usual);
  return refine(&s->of[(size_t)cell * s->parts + part], usual);
}

// The best probabilities are as the roots of the mean squares, and so is how
// often to ask at all.
static light_cell conclude(school *s, uint32_t cell) {
  float weights[LIGHT_PARTS_MOST], power = 0;
  double sum = 0;
  for (uint32_t i = 0; i < s->parts; i++) {
    weights[i] = (float)sqrt(mean_square(s, cell, i));
    sum += (double)weights[i];
    power += power_of(s->m, i);
  }
  if (cell == 0) s->whole = sum;
  float doubt = sum > 0 ? DOUBT : 1, asked = 1;
  if (sum > 0) asked = float_min((float)(2 * sum / s->whole), 1);
  asked = float_max(asked, LEAST_ASKED);
  for (uint32_t i = 0; i < s->parts; i++) {
    float known = sum > 0 ? (float)((double)weights[i] / sum) : 0;
    weights[i] = (1 - doubt) * known + doubt * (power_of(s->m, i) / power);
    weights[i] *= asked;
  }
  return cell_of_weights(s->m, weights);
}

static float share_of(const light_cell *c, uint32_t part) {
  uint32_t below = part > 0 ? c->last[part - 1] + 1u : 0;
  return (float)(c->last[part] + 1u - below) / UNITS;
}

// The mean square of what a question brings in a cell, over that if parts are
// asked by their power.
typedef struct outlook {
  double by_power, by_memory;
} outlook;

static void look_at(const school *s, uint32_t cell, double power, outlook *o) {
  const light_cell *c = &s->m->cells[cell];
  for (uint32_t i = 0; i < s->parts; i++) {
    double share = (double)share_of(c, i), square = mean_square(s, cell, i);
    if (!(share > 0)) continue;
    o->by_memory += (double)s->visits[cell] * square / share;
    o->by_power +=
        (double)s->visits[cell] * square * power / (double)power_of(s->m, i);
  }
}

// How many times as many questions the same would take without memory.
static double gain_of(const school *s) {
  double power = 0;
  outlook all = {0, 0};
  for (uint32_t i = 0; i < s->parts; i++)
    power += (double)power_of(s->m, i);
  for (uint32_t cell = 1; cell < s->cells; cell++)
    look_at(s, cell, power, &all);
  return all.by_memory > 0 ? all.by_power / all.by_memory : 0;
}

static void attend(school *s, const light_record *records, size_t n) {
  for (size_t i = 0; i < n; i++) {
    const light_record *r = &records[i];
    size_t cell = s->m->cell_of[r->key];
    lore *of[3] = {&s->of[r->part], &s->of[cell * s->parts + r->part],
                   &s->region[region_of(r->key) * s->parts + r->part]};
    s->visits[cell]++;
    for (int k = 0; k < 3; k++) {
      of[k]->asked++;
      of[k]->squares += (double)r->square;
    }
  }
}

double light_memory_learn(light_memory *m, const light_record *records,
                          size_t n, arena *mem) {
  arena scratch = {0};
  school s = {.m = m, .cells = 1, .parts = m->parts.count};
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
  if (*part >= m->parts.count) return false;
  *share = share_of(c, *part);
  return true;
}

float light_memory_share(const light_memory *m, uint32_t key, uint32_t part) {
  return share_of(cell_at(m, key), part);
}

// light_memory.c

#include "light_memory.h"

// Cells along the longest side of the scene.
enum { GRID = 24, SIDES = 6, KEYS = GRID * GRID * GRID * SIDES };

// So many cells, cubed, are neighbours, who know about the same.
enum { NEAR = 3, SOME = GRID / NEAR, REGIONS = SOME * SOME * SOME * SIDES };

// The share of questions that goes to all parts by their power: memory is not
// certain.
#define DOUBT 0.1f

// A cell takes its own records for as certain as so many of all cells.
#define SHARED 2.0f

// The least probability that any light is asked.
#define LEAST_ASKED 0.08f

static float axis_of(vec3 v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static uint32_t step_of(float x) {
  return x > 0 ? (uint32_t)float_min(x, GRID - 1) : 0;
}

// The axis that n runs along, and in which direction.
static uint32_t side_of(vec3 n) {
  vec3 a = vec3_abs(n);
  int axis = a.x >= a.y ? (a.x >= a.z ? 0 : 2) : (a.y >= a.z ? 1 : 2);
  return 2 * (uint32_t)axis + (axis_of(n, axis) < 0);
}

uint32_t light_memory_key(const light_memory *m, vec3 p, vec3 n) {
  vec3 at = vec3_scale(vec3_sub(p, m->lo), m->per_unit);
  uint32_t key = (step_of(at.z) * GRID + step_of(at.y)) * GRID + step_of(at.x);
  return key * SIDES + side_of(n);
}

static float power_of(const light_memory *m, uint32_t part) {
  const light_emitter *e = &m->parts.tree->emitters[m->parts.of[part].emitter];
  uint32_t cuts = e->is_point ? 1 : m->parts.cuts;
  return e->power / (float)(cuts * cuts);
}

static pick pick_of(const float *weights, uint32_t n, arena *mem) {
  pick p = pick_new(mem, n);
  double sum;
  pick_weigh(&p, weights, &sum);
  return p;
}

bool light_memory_new(light_memory *out, const light_tree *t, vec3 lo, vec3 hi,
                      arena *mem) {
  light_memory m = {.lo = lo};
  float longest = vec3_peak(vec3_sub(hi, lo));
  m.per_unit = GRID / longest;
  if (!(longest > 0 && isfinite(m.per_unit)) || !vec3_finite(lo)) return false;
  if (!light_parts_of(&m.parts, t, mem)) return false;
  float weights[LIGHT_PARTS_MOST + 1] = {0};
  for (uint32_t i = 0; i < m.parts.count; i++)
    weights[i] = power_of(&m, i);
  m.cell_of = ARENA_NEW(mem, uint32_t, KEYS);
  m.cells = ARENA_NEW(mem, pick, 1);
  m.cells[0] = pick_of(weights, m.parts.count + 1, mem);
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
static pick conclude(school *s, uint32_t cell, arena *mem) {
  float weights[LIGHT_PARTS_MOST + 1] = {0}, power = 0;
  double sum = 0;
  for (uint32_t i = 0; i < s->parts; i++) {
    weights[i] = (float)sqrt(mean_square(s, cell, i));
    sum += (double)weights[i];
    power += power_of(s->m, i);
  }
  if (cell == 0) s->whole = sum;
  float known = sum > 0 ? (1 - DOUBT) / (float)sum : 0;
  float doubt = sum > 0 ? DOUBT / power : 1 / power;
  float asked = 1;
  if (sum > 0) asked = float_min((float)(2 * sum / s->whole), 1);
  asked = float_max(asked, LEAST_ASKED);
  for (uint32_t i = 0; i < s->parts; i++)
    weights[i] = asked * (known * weights[i] + doubt * power_of(s->m, i));
  weights[s->parts] = 1 - asked;
  return pick_of(weights, s->parts + 1, mem);
}

// The mean square of what a question brings in a cell, over that if parts are
// asked by their power.
typedef struct outlook {
  double by_power, by_memory;
} outlook;

static void look_at(const school *s, uint32_t cell, double power, outlook *o) {
  const pick *p = &s->m->cells[cell];
  for (uint32_t i = 0; i < s->parts; i++) {
    double share = (double)pick_share(p, i), square = mean_square(s, cell, i);
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
  for (size_t i = 0; i < KEYS; i++)
    m->cell_of[i] = 0;
  for (size_t i = 0; i < n; i++)
    if (m->cell_of[records[i].key] == 0) m->cell_of[records[i].key] = s.cells++;
  s.key_of = ARENA_NEW(&scratch, uint32_t, s.cells);
  for (uint32_t i = 0; i < KEYS; i++)
    s.key_of[m->cell_of[i]] = i;
  s.visits = ARENA_NEW(&scratch, uint32_t, s.cells);
  s.region = ARENA_NEW(&scratch, lore, (size_t)REGIONS * s.parts);
  s.of = ARENA_NEW(&scratch, lore, (size_t)s.cells * s.parts);
  attend(&s, records, n);
  m->cells = ARENA_NEW(mem, pick, s.cells);
  for (uint32_t i = 0; i < s.cells; i++)
    m->cells[i] = conclude(&s, i, mem);
  double gain = gain_of(&s);
  arena_free(&scratch);
  return gain;
}

bool light_memory_pick(const light_memory *m, uint32_t key, float u,
                       uint32_t *part, float *share) {
  *part = pick_at(&m->cells[m->cell_of[key]], &u, share);
  return *part < m->parts.count;
}

float light_memory_share(const light_memory *m, uint32_t key, uint32_t part) {
  return pick_share(&m->cells[m->cell_of[key]], part);
}

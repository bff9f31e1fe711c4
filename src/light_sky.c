// light_sky.c

#include "light_sky.h"

// The most tiles across.
enum { TILES = 128 };

// The light of some tiles: its power, and the sum of power times direction.
typedef struct lot {
  double power, x, y, z;
} lot;

// Tiles from (x0, y0) up to (x1, y1), and where to cut them best: by rows or by
// columns, at which of them, and what that is worth.
typedef struct block {
  int x0, y0, x1, y1;
  lot all;
  bool by_rows;
  int at;
  double worth;  // 0: there is nothing to cut
} block;

typedef struct cutter {
  const light_env *env;
  lot *tiles;
  int shift, across, down;
} cutter;

static void lot_add(lot *a, const lot *b) {
  a->power += b->power;
  a->x += b->x;
  a->y += b->y;
  a->z += b->z;
}

// How far the light of a lot is spread, counted down from its power: the mean
// square of the chords to the middle of all, times the power.
static double lot_narrow(const lot *l) {
  double square = l->x * l->x + l->y * l->y + l->z * l->z;
  return l->power > 0 ? square / l->power : 0;
}

static int first_of(const cutter *c, int tile, int most) {
  int first = tile << c->shift;
  return first < most ? first : most;
}

static double power_of(const cutter *c, int x, int y) {
  const light_env *e = c->env;
  int i0 = first_of(c, x, e->map.width), i1 = first_of(c, x + 1, e->map.width);
  int j1 = first_of(c, y + 1, e->map.height + 1);
  double power = 0;
  for (int j = first_of(c, y, e->map.height + 1); j < j1; j++) {
    const uint32_t *upto = e->columns[j].upto;
    power += (double)(e->rows.upto[j + 1] - e->rows.upto[j]) *
             (double)(upto[i1] - upto[i0]);
  }
  return power;
}

static lot tile_of(const cutter *c, int x, int y) {
  lot l = {.power = power_of(c, x, y)};
  vec2 uv = {((float)x + 0.5f) / (float)c->across,
             ((float)y + 0.5f) / (float)c->down};
  vec3 d = env_direction(uv);
  l.x = l.power * (double)d.x;
  l.y = l.power * (double)d.y;
  l.z = l.power * (double)d.z;
  return l;
}

// The sums of the rows or of the columns of a block.
static int sum_lines(const cutter *c, const block *b, bool by_rows,
                     lot *lines) {
  int n = by_rows ? b->y1 - b->y0 : b->x1 - b->x0;
  for (int i = 0; i < n; i++)
    lines[i] = (lot){0};
  for (int y = b->y0; y < b->y1; y++)
    for (int x = b->x0; x < b->x1; x++)
      lot_add(&lines[by_rows ? y - b->y0 : x - b->x0],
              &c->tiles[y * c->across + x]);
  return n;
}

static void try_cuts(const cutter *c, block *b, bool by_rows) {
  lot lines[2 * TILES], left = {0};
  int n = sum_lines(c, b, by_rows, lines);
  for (int i = 0; i + 1 < n; i++) {
    lot_add(&left, &lines[i]);
    lot right = {b->all.power - left.power, b->all.x - left.x,
                 b->all.y - left.y, b->all.z - left.z};
    if (!(left.power > 0 && right.power > 0)) continue;
    double worth = lot_narrow(&left) + lot_narrow(&right) - lot_narrow(&b->all);
    if (!(worth > b->worth)) continue;
    b->worth = worth;
    b->by_rows = by_rows;
    b->at = i + 1;
  }
}

static block block_of(const cutter *c, int x0, int y0, int x1, int y1) {
  block b = {.x0 = x0, .y0 = y0, .x1 = x1, .y1 = y1};
  for (int y = y0; y < y1; y++)
    for (int x = x0; x < x1; x++)
      lot_add(&b.all, &c->tiles[y * c->across + x]);
  try_cuts(c, &b, true);
  try_cuts(c, &b, false);
  return b;
}

// Cut the block that is worth it most, again and again.
static uint32_t cut_blocks(const cutter *c, block *blocks, uint32_t most) {
  uint32_t n = 1;
  blocks[0] = block_of(c, 0, 0, c->across, c->down);
  while (n < most) {
    uint32_t best = 0;
    for (uint32_t i = 1; i < n; i++)
      if (blocks[i].worth > blocks[best].worth) best = i;
    block b = blocks[best];
    if (!(b.worth > 0)) break;
    int x = b.by_rows ? b.x1 : b.x0 + b.at, y = b.by_rows ? b.y0 + b.at : b.y1;
    blocks[best] = block_of(c, b.x0, b.y0, x, y);
    blocks[n++] = b.by_rows ? block_of(c, b.x0, y, b.x1, b.y1)
                            : block_of(c, x, b.y0, b.x1, b.y1);
  }
  return n;
}

static void fill_part(const cutter *c, const block *b, light_sky_part *out,
                      arena *mem) {
  const light_env *e = c->env;
  arena scratch = {0};
  out->row = first_of(c, b->y0, e->map.height + 1);
  int n = first_of(c, b->y1, e->map.height + 1) - out->row;
  int i0 = first_of(c, b->x0, e->map.width),
      i1 = first_of(c, b->x1, e->map.width);
  double *weights = ARENA_NEW(&scratch, double, (size_t)n);
  out->of_row = ARENA_NEW(mem, light_sky_row, (size_t)n);
  out->rows = pick_new(mem, (uint32_t)n);
  for (int k = 0; k < n; k++) {
    const uint32_t *upto = e->columns[out->row + k].upto;
    out->of_row[k] = (light_sky_row){upto[i0], upto[i1], 0};
    weights[k] = (double)(pick_share(&e->rows, (uint32_t)(out->row + k)) *
                          (float)(upto[i1] - upto[i0]));
  }
  double sum;
  pick_weigh(&out->rows, weights, &sum);
  for (int k = 0; k < n; k++) {
    light_sky_row *r = &out->of_row[k];
    if (r->last == r->first) continue;
    r->each = pick_share(&out->rows, (uint32_t)k) * (float)PICK_UNITS /
              (float)(r->last - r->first);
  }
  arena_free(&scratch);
}

static cutter cutter_of(const light_env *e) {
  cutter c = {.env = e};
  while ((e->map.width - 1) >> c.shift >= TILES ||
         e->map.height >> c.shift >= 2 * TILES)
    c.shift++;
  c.across = ((e->map.width - 1) >> c.shift) + 1;
  c.down = (e->map.height >> c.shift) + 1;
  return c;
}

static void fill_tiles(cutter *c, arena *mem) {
  c->tiles = ARENA_NEW(mem, lot, (size_t)c->across * (size_t)c->down);
  for (int y = 0; y < c->down; y++)
    for (int x = 0; x < c->across; x++)
      c->tiles[y * c->across + x] = tile_of(c, x, y);
}

bool light_sky_of(light_sky *out, const light_env *of, uint32_t most,
                  arena *mem) {
  if (!(of->irradiance > 0)) return false;
  arena scratch = {0};
  cutter c = cutter_of(of);
  fill_tiles(&c, &scratch);
  block blocks[LIGHT_PARTS_MOST];
  *out = (light_sky){.env = of, .shift = c.shift, .across = c.across};
  out->count = cut_blocks(&c, blocks, most);
  out->part_of = ARENA_NEW(mem, uint8_t, (size_t)c.across * (size_t)c.down);
  double power = 0;
  for (uint32_t k = 0; k < out->count; k++)
    power += blocks[k].all.power;
  for (uint32_t k = 0; k < out->count; k++) {
    const block *b = &blocks[k];
    out->power[k] = (float)(b->all.power / power);
    fill_part(&c, b, &out->parts[k], mem);
    for (int y = b->y0; y < b->y1; y++)
      for (int x = b->x0; x < b->x1; x++)
        out->part_of[y * c.across + x] = (uint8_t)k;
  }
  arena_free(&scratch);
  return true;
}

void light_sky_usual(const light_sky *s, const light_env *of, float *power) {
  const cutter c = cutter_of(of);
  double sum[LIGHT_PARTS_MOST] = {0}, all = 0;
  for (int i = 0; i < c.across * c.down; i++) {
    double light = power_of(&c, i % c.across, i / c.across);
    sum[s->part_of[i]] += light;
    all += light;
  }
  for (uint32_t k = 0; k < s->count; k++)
    power[k] = (float)(sum[k] / all);
}

// The unit that picks, of all columns of a row, what u picks of those of a
// part.
static double within(const light_sky_row *r, float u) {
  return r->first + (double)u * (r->last - r->first);
}

static light_env_spot find_row(const light_sky *s, uint32_t part, vec2 u) {
  const light_sky_part *p = &s->parts[part];
  light_env_spot spot = {.u = u};
  float share;
  uint32_t k = pick_at(&p->rows, &spot.u.y, &share);
  spot.row = p->row + (int)k;
  spot.unit = within(&p->of_row[k], u.x);
  spot.u.x = (float)(spot.unit / PICK_UNITS);
  spot.share = p->of_row[k].each;
  pick_expect(&s->env->columns[spot.row], spot.u.x);
  return spot;
}

void light_sky_spots(const light_sky *s, const uint32_t *part, const vec2 *u,
                     size_t n, light_env_spot *out) {
  for (size_t k = 0; k < n; k++)
    out[k] = find_row(s, part[k], u[k]);
  light_env_find_columns(s->env, out, n);
}

void light_sky_samples(const light_sky *s, const uint32_t *part, const vec2 *u,
                       size_t n, env_sample *out) {
  light_env_spot spots[LIGHT_TOGETHER];
  for (size_t i = 0; i < n; i += LIGHT_TOGETHER) {
    size_t some = n - i < LIGHT_TOGETHER ? n - i : LIGHT_TOGETHER;
    light_sky_spots(s, part + i, u + i, some, spots);
    for (size_t k = 0; k < some; k++)
      out[i + k] = light_env_sample_cell(s->env, &spots[k]);
  }
}

env_sample light_sky_sample(const light_sky *s, uint32_t part, vec2 u) {
  env_sample one;
  light_sky_samples(s, &part, &u, 1, &one);
  return one;
}

// light_env.irradiance is a fourth of all that the table stands for.
float light_sky_worth(const light_sky *s, uint32_t part) {
  return 4 * s->env->irradiance * s->power[part];
}

float light_sky_density(const light_sky *s, vec2 uv, uint32_t *part) {
  light_env_place at = light_env_place_of(s->env, uv);
  *part =
      s->part_of[(at.row >> s->shift) * s->across + (at.column >> s->shift)];
  const light_sky_part *p = &s->parts[*part];
  float share = pick_share(&s->env->columns[at.row], (uint32_t)at.column);
  return light_env_cell_density(s->env, &at, uv.y,
                                share * p->of_row[at.row - p->row].each);
}

// aim_build.c — a tree over where light comes down; in each leaf spheres around
// the points of mirrors and glass that it came from.

#include "aim_build.h"

#include <string.h>

// A leaf has no more photons than these, or no side longer than this share of
// the scene; with fewer than the last it is dark.
enum { LEAF_MOST = 96, LEAF_LEAST = 4 };
#define LEAF_SMALL (1.0f / 256)

// Spheres are larger than what is in them, because photons are few: so many
// times, and by so many mean distances of photons.
#define MARGIN 1.25f
#define SPACING 2.5f

// But no smaller than this share of their leaf.
#define SPHERE_SMALL 0.02f

// The deepest a tree can be: boxes are halved.
enum { DEEPEST = 64 };

// Photons on one side of a box, for a node.
typedef struct plot {
  uint32_t first, count, node;
  vec3 lo, hi;
} plot;

typedef struct gardener {
  aim_photon *of;
  double tries;
  aim_node *nodes;
  aim_cell *cells;
  size_t node_room, node_count, cell_room, cell_count;
} gardener;

// The first of two new nodes.
static uint32_t new_nodes(gardener *g) {
  g->nodes =
      array_grow(g->nodes, &g->node_room, g->node_count + 2, sizeof *g->nodes);
  g->node_count += 2;
  return (uint32_t)g->node_count - 2;
}

static uint32_t new_cell(gardener *g, const aim_cell *c) {
  g->cells =
      array_grow(g->cells, &g->cell_room, g->cell_count + 1, sizeof *g->cells);
  g->cells[g->cell_count++] = *c;
  return (uint32_t)g->cell_count - 1;
}

static void put(vec3 *v, int axis, float x) {
  *(axis == 0 ? &v->x : axis == 1 ? &v->y : &v->z) = x;
}

static int longest(vec3 d) {
  if (d.x >= d.y && d.x >= d.z) return 0;
  return d.y >= d.z ? 1 : 2;
}

// The photons of a list that come before `at` on an axis, by where they came
// down or by where they came from, put first; how many.
static uint32_t part(aim_photon *p, uint32_t n, int axis, float at, bool by_y) {
  uint32_t left = 0, right = n;
  while (left < right) {
    aim_photon q = p[left];
    if (vec3_axis(by_y ? q.y : q.x, axis) < at) {
      left++;
      continue;
    }
    p[left] = p[--right];
    p[right] = q;
  }
  return left;
}

// Photons that one sphere holds; worth: the sum of power times radiance.
typedef struct bunch {
  uint32_t first, count;
  vec3 lo, hi;
  float worth;
} bunch;

static bunch bunch_of(const aim_photon *p, uint32_t first, uint32_t count) {
  bunch b = {first, count, p[first].y, p[first].y, 0};
  for (uint32_t i = first; i < first + count; i++) {
    b.lo = vec3_min(b.lo, p[i].y);
    b.hi = vec3_max(b.hi, p[i].y);
    b.worth += p[i].power * p[i].radiance;
  }
  return b;
}

// What to halve first.
static float size_of(const bunch *b) {
  if (b->count < 2) return 0;
  return vec3_length(vec3_sub(b->hi, b->lo)) * sqrtf(b->worth);
}

// Halve the largest bunches until there are enough; how many there are.
static uint32_t gather(aim_photon *p, const plot *s, bunch *of) {
  uint32_t n = 1;
  of[0] = bunch_of(p, s->first, s->count);
  while (n < AIM_SPHERES) {
    uint32_t k = 0;
    for (uint32_t i = 1; i < n; i++)
      if (size_of(&of[i]) > size_of(&of[k])) k = i;
    bunch b = of[k];
    if (!(size_of(&b) > 0)) break;
    int axis = longest(vec3_sub(b.hi, b.lo));
    float at = 0.5f * (vec3_axis(b.lo, axis) + vec3_axis(b.hi, axis));
    uint32_t left = part(p + b.first, b.count, axis, at, true);
    if (left == 0 || left == b.count) break;
    of[k] = bunch_of(p, b.first, left);
    of[n++] = bunch_of(p, b.first + left, b.count - left);
  }
  return n;
}

// The mean square that a ray into the sphere brings to white matt surfaces of
// all the leaf together: of the radiance, by cosine over pi, over the density.
static double square_of(const aim_photon *p, const bunch *b, vec3 middle,
                        float radius) {
  double sum = 0;
  for (uint32_t i = b->first; i < b->first + b->count; i++) {
    float angle = 2 * PI * aim_cone(vec3_sub(middle, p[i].x), radius);
    sum += (double)(p[i].power * p[i].radiance * p[i].cosine * angle);
  }
  return sum / (double)(PI * PI);
}

// The leaf's area, were it all one surface.
static float area_of(const plot *s, uint32_t side) {
  vec3 d = vec3_sub(s->hi, s->lo);
  uint32_t axis = side / 2;
  return axis == 0 ? d.y * d.z : axis == 1 ? d.x * d.z : d.x * d.y;
}

static aim_cell conclude(const gardener *g, const plot *s, uint32_t side) {
  aim_photon *p = g->of;
  aim_cell c = {0};
  bunch of[AIM_SPHERES];
  if (s->count < LEAF_LEAST) return c;
  bunch all = bunch_of(p, s->first, s->count);
  uint32_t n = gather(p, s, of);
  float spacing =
      0.5f * vec3_length(vec3_sub(all.hi, all.lo)) / (float)s->count;
  float least = SPHERE_SMALL * vec3_length(vec3_sub(s->hi, s->lo));
  double sum = 0, scattered = (double)all.worth / (double)PI;
  for (uint32_t i = 0; i < n; i++) {
    vec3 middle = vec3_scale(vec3_add(of[i].lo, of[i].hi), 0.5f);
    float r = MARGIN * 0.5f * vec3_length(vec3_sub(of[i].hi, of[i].lo));
    r = float_max(r + SPACING * spacing, least);
    sum += sqrt(square_of(p, &of[i], middle, r));
    c.upto[i] = (float)sum;
    c.x[i] = middle.x;
    c.y[i] = middle.y;
    c.z[i] = middle.z;
    c.radius[i] = r;
  }
  c.root = (float)(sum / sqrt((double)area_of(s, side) * g->tries));
  c.least = (float)(sum * sum / scattered);
  if (!(c.least > 0 && c.least < INFINITY && c.root < INFINITY)) return c;
  for (uint32_t i = 0; i < n; i++)
    c.upto[i] = i + 1 == n ? 1 : (float)((double)c.upto[i] / sum);
  c.count = n;
  return c;
}

static void plant(gardener *g, plot all, uint32_t side, float small) {
  plot stack[DEEPEST + 2];
  uint32_t depth = 0;
  stack[depth++] = all;
  while (depth > 0) {
    plot s = stack[--depth];
    vec3 d = vec3_sub(s.hi, s.lo);
    int axis = longest(d);
    if (s.count <= LEAF_MOST || !(vec3_axis(d, axis) > small) ||
        depth >= DEEPEST) {
      aim_cell c = conclude(g, &s, side);
      g->nodes[s.node] = (aim_node){0, AIM_LEAF, new_cell(g, &c)};
      continue;
    }
    float at = 0.5f * (vec3_axis(s.lo, axis) + vec3_axis(s.hi, axis));
    uint32_t left = part(g->of + s.first, s.count, axis, at, false);
    uint32_t next = new_nodes(g);
    g->nodes[s.node] = (aim_node){at, (uint32_t)axis, next};
    plot a = {s.first, left, next, s.lo, s.hi};
    plot b = {s.first + left, s.count - left, next + 1, s.lo, s.hi};
    put(&a.hi, axis, at);
    put(&b.lo, axis, at);
    stack[depth++] = b;
    stack[depth++] = a;
  }
}

void aim_build(aim_map *out, const aim_photons *photons, vec3 lo, vec3 hi,
               arena *mem) {
  arena scratch = {0};
  gardener g = {.of = ARENA_NEW(&scratch, aim_photon, photons->count),
                .tries = photons->tries};
  for (uint32_t i = 0; i < LIGHT_SIDES; i += 2)
    new_nodes(&g);
  uint32_t end = 0;
  for (uint32_t side = 0; side < LIGHT_SIDES; side++) {
    plot all = {.first = end, .node = side, .lo = lo, .hi = hi};
    for (size_t i = 0; i < photons->count; i++)
      if (light_side(photons->of[i].n) == side) g.of[end++] = photons->of[i];
    all.count = end - all.first;
    plant(&g, all, side, LEAF_SMALL * vec3_peak(vec3_sub(hi, lo)));
  }
  *out = (aim_map){.nodes = ARENA_NEW(mem, aim_node, g.node_count),
                   .cells = ARENA_NEW(mem, aim_cell, g.cell_count)};
  memcpy(out->nodes, g.nodes, g.node_count * sizeof *g.nodes);
  memcpy(out->cells, g.cells, g.cell_count * sizeof *g.cells);
  array_free(g.nodes);
  array_free(g.cells);
  arena_free(&scratch);
}

// light_part.c

#include "light_part.h"

// Cell (i, j) of a triangle cut n times along each edge: a triangle like the
// whole, or the one beside it, turned.
static bool cut(light_part *out, const light_triangle *t, vec2 at, float step) {
  out->at = at;
  out->ab = (vec2){step, 0};
  out->ac = (vec2){0, step};
  vec3 a = vec3_mad(vec3_mad(t->a, at.x, t->ab), at.y, t->ac);
  vec3 b = vec3_mad(a, step, t->ab), c = vec3_mad(a, step, t->ac);
  return light_triangle_of(&out->shape, a, b, c);
}

// The number of a cell in its triangle: rows of 2 n - 1, 2 n - 3, ... 1.
static uint32_t cell_number(uint32_t n, uint32_t i, uint32_t j, bool turned) {
  return i * (2 * n - i) + 2 * j + turned;
}

static bool cut_triangle(light_part *out, const light_triangle *t, uint32_t n) {
  float step = 1 / (float)n;
  bool good = true;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = 0; i + j < n; j++) {
      vec2 at = {(float)i * step, (float)j * step};
      vec2 far = {(float)(i + 1) * step, (float)(j + 1) * step};
      good &= cut(&out[cell_number(n, i, j, false)], t, at, step);
      if (i + j + 1 == n) continue;
      good &= cut(&out[cell_number(n, i, j, true)], t, far, -step);
    }
  return good;
}

bool light_parts_of(light_parts *out, const light_tree *t, arena *mem) {
  if (t->count == 0 || t->count > LIGHT_PARTS_EMITTERS) return false;
  light_parts p = {.tree = t, .cuts = 1};
  while ((p.cuts + 1) * (p.cuts + 1) * t->count <= LIGHT_PARTS_MOST)
    p.cuts++;
  p.of = ARENA_NEW(mem, light_part, (size_t)p.cuts * p.cuts * t->count);
  p.first = ARENA_NEW(mem, uint32_t, t->count);
  for (uint32_t e = 0; e < t->count; e++) {
    const light_emitter *of = &t->emitters[e];
    uint32_t n = of->is_point ? 1 : p.cuts;
    p.first[e] = p.count;
    if (!of->is_point && !cut_triangle(&p.of[p.count], &of->shape, n))
      return false;
    for (uint32_t i = 0; i < n * n; i++)
      p.of[p.count++].emitter = e;
  }
  *out = p;
  return true;
}

float light_parts_power(const light_parts *p, uint32_t part) {
  const light_emitter *e = &p->tree->emitters[p->of[part].emitter];
  uint32_t cuts = e->is_point ? 1 : p->cuts;
  return e->power / (float)(cuts * cuts);
}

// Twice the area over which d and e stretch, as seen along n.
static float across(vec3 d, vec3 e, vec3 n) {
  return vec3_dot(vec3_cross(d, e), n);
}

// The cell that x falls into, of those from 0 to last.
static uint32_t cell_of(float x, uint32_t last) {
  uint32_t i = x > 0 ? (uint32_t)float_min(x, (float)last) : 0;
  return i;
}

uint32_t light_parts_at(const light_parts *p, uint32_t emitter, vec3 q) {
  const light_triangle *t = &p->tree->emitters[emitter].shape;
  if (p->cuts == 1 || p->tree->emitters[emitter].is_point)
    return p->first[emitter];
  vec3 d = vec3_sub(q, t->a);
  float scale = (float)p->cuts / (2 * t->area);
  float b = across(d, t->ac, t->n) * scale, c = across(t->ab, d, t->n) * scale;
  uint32_t i = cell_of(b, p->cuts - 1), j = cell_of(c, p->cuts - 1 - i);
  bool turned = i + j + 1 < p->cuts && b - (float)i + c - (float)j > 1;
  return p->first[emitter] + cell_number(p->cuts, i, j, turned);
}

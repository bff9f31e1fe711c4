// aim.c

#include "aim.h"

#include "bsdf.h"
#include "light_memory.h"
#include "num.h"

const aim_cell *aim_at(const aim_map *m, vec3 p, vec3 n) {
  const float at[3] = {p.x, p.y, p.z};
  const aim_node *k = &m->nodes[light_side(n)];
  while (k->axis != AIM_LEAF)
    k = &m->nodes[k->next + (at[k->axis] >= k->at)];
  const aim_cell *c = &m->cells[k->next];
  return c->count > 0 ? c : NULL;
}

// n aimed rays beside a scattered one leave about 1 / (1 / B + n / S) of its
// mean square B, where S is that of one aimed ray; each costs the same.  The
// best n is where the derivative is that cost.
float aim_asked(const aim_map *m, const aim_cell *c, float throughput) {
  float n = m->keen * throughput * c->root - c->least;
  return float_min(float_max(n, 0), AIM_RAYS);
}

float aim_gain(const aim_cell *c, float asked, float throughput) {
  float scale = throughput * c->root;
  return scale * scale / c->least * asked / (c->least + asked);
}

float aim_cone(vec3 d, float radius) {
  float s2 = radius * radius / vec3_dot(d, d);
  return s2 < 1 ? s2 / (1 + sqrtf(1 - s2)) : 2;
}

static vec3 middle_of(const aim_cell *c, uint32_t i) {
  return (vec3){c->x[i], c->y[i], c->z[i]};
}

// Half the square of the distance of two unit vectors is 1 less the cosine
// between them, without its rounding.
float aim_pdf(const aim_cell *c, vec3 o, vec3 wi) {
  float sum = 0, before = 0;
  for (uint32_t i = 0; i < c->count; i++) {
    vec3 d = vec3_sub(middle_of(c, i), o);
    float cone = aim_cone(d, c->radius[i]), share = c->upto[i] - before;
    vec3 off = vec3_sub(wi, vec3_unit(d));
    if (vec3_dot(off, off) <= 2 * cone) sum += share / cone;
    before = c->upto[i];
  }
  return sum / (2 * PI);
}

vec3 aim_sample(const aim_cell *c, vec3 o, vec3 u, float *pdf) {
  uint32_t i = 0;
  while (i + 1 < c->count && u.z >= c->upto[i])
    i++;
  vec3 d = vec3_sub(middle_of(c, i), o), n = vec3_unit(d), t, b;
  float drop = aim_cone(d, c->radius[i]) * u.x;
  float sine = sqrtf(drop * (2 - drop));
  vec2 round = num_circle(u.y);
  bsdf_basis(n, &t, &b);
  vec3 side = vec3_mad(vec3_scale(t, round.x), round.y, b);
  vec3 wi = vec3_unit(vec3_mad(vec3_scale(n, 1 - drop), sine, side));
  *pdf = aim_pdf(c, o, wi);
  return wi;
}

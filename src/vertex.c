// vertex.c

#include "vertex.h"

// The most sheets a shadow ray looks through.
enum { SHADOW_MAX_SHEETS = 1000 };

vec3 vertex_local(const vertex *v, vec3 w) {
  return (vec3){vec3_dot(w, v->t), vec3_dot(w, v->b), vec3_dot(w, v->n)};
}

vec3 vertex_world(const vertex *v, vec3 w) {
  vec3 sum = vec3_scale(v->t, w.x);
  return vec3_unit(vec3_mad(vec3_mad(sum, w.y, v->b), w.z, v->n));
}

void vertex_face(vertex *v, const scene *s, const hit *h) {
  v->ns = surface_mapped_normal(s, &v->at, h);
  v->ng = v->at.ng;
  if (v->at.front) return;
  v->ng = vec3_neg(v->ng);
  v->ns = vec3_neg(v->ns);
}

vertex vertex_at(const scene *s, const hit *h, vec3 d) {
  vertex v = {.at = surface_at(s, h, d), .wo = vec3_unit(vec3_neg(d))};
  vertex_face(&v, s, h);
  return v;
}

// The normal for b: mirrors and glass want one whose directions lie on the
// right sides of the facet, others one that faces the viewer.
static void orient(vertex *v, const bsdf *b) {
  switch (b->kind) {
  case BSDF_MIRROR: v->n = surface_bend(v->ns, v->ng, v->wo); break;
  case BSDF_GLASS:
    v->n = surface_bend_glass(v->ns, v->ng, v->wo, b->eta);
    break;
  case BSDF_LAMBERT:
  case BSDF_BLINN_PHONG:
  case BSDF_ROUGH: v->n = surface_face(v->ns, v->wo); break;
  }
  bsdf_basis(v->n, &v->t, &v->b);
}

matter vertex_matter(vertex *v, const dfg *table, float u) {
  float cos_o = float_min(float_max(vec3_dot(v->ns, v->wo), 0), 1);
  matter m = matter_choose(table, &v->at, cos_o, u);
  if (!v->at.front && m.bsdf.kind == BSDF_GLASS) m.bsdf.eta = 1 / m.bsdf.eta;
  orient(v, &m.bsdf);
  return m;
}

ray vertex_leave(const vertex *v, const bsdf *b, const bsdf_sample *d,
                 vec3 incoming, int *inside) {
  vec3 wi = vertex_world(v, d->wi);
  bool held = b->kind == BSDF_GLASS && !v->at.front && !d->transmitted;
  *inside = held ? *inside + 1 : 0;
  if (*inside > VERTEX_TRAPPED_AFTER && v->at.smooth)
    return surface_ray(&v->at, incoming);
  if (d->delta)
    return surface_ray(&v->at, surface_keep_side(&v->at, wi, d->transmitted));
  return surface_smooth_ray(&v->at, wi);
}

light_ray light_ray_of(const light *l, vec3 p) {
  if (l->kind == LIGHT_DIR)
    return (light_ray){.wi = vec3_unit(vec3_neg(l->at)), .power = l->power};
  vec3 d = vec3_sub(l->at, p);
  float r2 = vec3_dot(d, d);
  vec3 power = r2 > 0 ? vec3_scale(l->power, 1 / r2) : vec3_all(0);
  return (light_ray){true, l->at, vec3_unit(d), power};
}

ray light_ray_shadow(const light_ray *l, const surface *from, bool smooth) {
  if (l->is_point) return surface_ray_to(from, l->to, smooth);
  return smooth ? surface_smooth_ray(from, l->wi) : surface_ray(from, l->wi);
}

bool scene_has_sheets(const scene *s) {
  for (size_t i = 0; i < s->material_count; i++)
    if (s->materials[i].passes) return true;
  return false;
}

float light_ray_through(const light_ray *l, const path_world *w,
                        const surface *from, path_stats *stats) {
  ray r = light_ray_shadow(l, from, true);
  float share = 1;
  hit h;
  stats->through++;
  for (int i = 0; i < SHADOW_MAX_SHEETS; i++) {
    stats->rays++;
    if (!w->tracer.closest(w->tracer.tree, &r, &h)) break;
    surface s = surface_at(w->scene, &h, r.d);
    if (!matter_passes(&s)) return 0;
    share *= 1 - matter_opacity(&s);
    if (!(share > 0)) return 0;
    r = light_ray_shadow(l, &s, false);
  }
  return share;
}

// first_hit.c

#include "first_hit.h"

first_hit first_hit_of(const path_world *w, const camera_view *v, const ray *r,
                       path_stats *stats) {
  hit h;
  stats->rays++;
  if (!w->tracer.closest(w->tracer.tree, r, &h)) return (first_hit){0};
  surface s = surface_at(w->scene, &h, r->d);
  float depth = vec3_dot(vec3_sub(s.p, v->eye), v->forward);
  return (first_hit){true, depth, surface_mapped_normal(w->scene, &s, &h),
                     matter_albedo(&s)};
}

float first_hit_farthest(const scene *s, const camera_view *v) {
  float far = 0;
  for (int i = 0; i < 8; i++) {
    vec3 corner = {i & 1 ? s->hi.x : s->lo.x, i & 2 ? s->hi.y : s->lo.y,
                   i & 4 ? s->hi.z : s->lo.z};
    far = fmaxf(far, vec3_dot(vec3_sub(corner, v->eye), v->forward));
  }
  return far > 0 ? far : 1;
}

vec3 first_hit_shade(const first_hit *f, render_shading of, float farthest) {
  switch (of) {
  case RENDER_NORMAL:
    if (!f->found) break;
    return vec3_scale(vec3_add(f->normal, vec3_all(1)), 0.5f);
  case RENDER_DEPTH:
    return vec3_all(f->found ? fminf(f->depth / farthest, 1) : 1);
  case RENDER_ALBEDO: return f->albedo;
  case RENDER_RADIANCE: break;
  }
  return vec3_all(0);
}

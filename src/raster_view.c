// raster_view.c

#include "raster_view.h"

raster_window raster_window_of(const raster_settings *set) {
  if (set->x1 > 0) return (raster_window){set->x0, set->y0, set->x1, set->y1};
  return (raster_window){0, 0, set->width, set->height};
}

// The farthest corner of the scene's box along the view axis, as in render.c.
static float farthest_corner(const scene *s, const camera_view *v) {
  float far = 0;
  for (int i = 0; i < 8; i++) {
    vec3 corner = {i & 1 ? s->hi.x : s->lo.x, i & 2 ? s->hi.y : s->lo.y,
                   i & 4 ? s->hi.z : s->lo.z};
    far = fmaxf(far, vec3_dot(vec3_sub(corner, v->eye), v->forward));
  }
  return far > 0 ? far : 1;
}

// The nearest that is drawn, as a share of the farthest.
#define NEAR_SHARE 1e-5f
#define NEAR_SHARE_PLAIN 1e-3f

static void put_row(raster_matrix *m, int i, vec3 v, vec3 eye) {
  m->m[i] = v.x;
  m->m[4 + i] = v.y;
  m->m[8 + i] = v.z;
  m->m[12 + i] = -vec3_dot(v, eye);
}

// A point q from the eye is seen at film x = (q.right / |right|^2) / z + c in
// pixels, where z = q.forward and c belongs to the middle of the view; times
// 2 z / width and less z it is clip x.  Both are linear in q: a matrix.
static vec3 film_row(vec3 step, const camera_view *v, int from, int to) {
  float s2 = vec3_dot(step, step);
  float c = -vec3_dot(v->corner, step) / s2;
  float scale = 2 / (float)(to - from);
  vec3 row = vec3_scale(step, scale / s2);
  return vec3_mad(row, scale * (c - (float)from) - 1, v->forward);
}

raster_view raster_view_of(const camera_view *v, raster_window w,
                           const scene *s, raster_space space) {
  raster_view out = {.eye = vec3_sub(v->eye, space.origin),
                     .forward = v->forward,
                     .farthest = farthest_corner(s, v)};
  vec3 x = film_row(v->right, v, w.x0, w.x1);
  vec3 y = vec3_neg(film_row(v->down, v, w.y0, w.y1));
  put_row(&out.clip, 0, x, out.eye);
  put_row(&out.clip, 1, y, out.eye);
  put_row(&out.clip, 3, v->forward, out.eye);
  float share = space.reversed ? NEAR_SHARE : NEAR_SHARE_PLAIN;
  float near = share * out.farthest;
  put_row(&out.clip, 2, space.reversed ? vec3_all(0) : v->forward, out.eye);
  out.clip.m[14] += space.reversed ? near : -2 * near;
  float wide = (float)(w.x1 - w.x0), high = (float)(w.y1 - w.y0);
  vec3 left = vec3_mad(v->corner, (float)w.x0, v->right);
  out.corner = vec3_mad(left, (float)w.y1, v->down);
  out.right = vec3_scale(v->right, wide);
  out.up = vec3_scale(v->down, -high);
  return out;
}

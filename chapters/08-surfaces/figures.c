// figures.c — the pictures of chapter 8, and the tables that its text quotes.

#include "../../tests/solids.h"
#include "../easel.h"
#include "num.h"
#include "surface.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Where the pictures go.
typedef struct output {
  const char *folder;
  arena mem;
} output;

// The next of a sequence of numbers in [0, 1).
static float dice(uint32_t *state) {
  *state = *state * 1664525u + 1013904223u;
  return (float)(*state >> 8) * 0x1p-24f;
}

// Uniform over the sphere.
static vec3 dice_direction(uint32_t *state) {
  for (;;) {
    float x = 2 * dice(state) - 1, y = 2 * dice(state) - 1;
    vec3 v = {x, y, 2 * dice(state) - 1};
    float l2 = vec3_dot(v, v);
    if (l2 > 1e-4f && l2 <= 1) return vec3_unit(v);
  }
}

// A scene with its tree and one directional light.
typedef struct stage {
  scene scene;
  bvh tree;
  vec3 to_light;  // unit
} stage;

static stage stage_of(const solid *s, bool smooth, vec3 light_at, arena *mem) {
  return (stage){solid_scene(s, smooth), solid_tree(s, mem),
                 vec3_unit(light_at)};
}

// A hit and the ray that made it, which is what leaving needs to know.
typedef struct arrival {
  ray ray;
  hit hit;
  surface at;
} arrival;

// The ways to leave a surface that this chapter compares.
typedef enum leaving {
  LEAVE_NAIVE,   // from o + t d
  LEAVE_FIXED,   // from o + t d, hits below t = 1e-3 ignored
  LEAVE_SCALED,  // from o + t d, moved by bits of the float, 1/65536 near 0
  LEAVE_BOUND,   // from the barycentric point, by its bound in float
  LEAVE_FACET,   // surface_ray
  LEAVE_SMOOTH,  // surface_smooth_ray
} leaving;

// Source: Waechter and Binder, "A Fast and Robust Method for Avoiding
// Self-Intersection", Ray Tracing Gems, 2019.
static float scaled_step(float p, float n) {
  if (fabsf(p) < 1.0f / 32) return p + n / 65536;
  int32_t bits, steps = (int32_t)(256 * n);
  memcpy(&bits, &p, sizeof bits);
  bits += p < 0 ? -steps : steps;
  memcpy(&p, &bits, sizeof bits);
  return p;
}

// The point and its bound in float, as in PBRT; then the neighbour on n's side.
static float bound_step(const float p[3], const float b[3], float n,
                        float distance) {
  float x = b[0] * p[0] + b[1] * p[1] + b[2] * p[2];
  if (n == 0) return x;
  return nextafterf(x + distance * n, n > 0 ? INFINITY : -INFINITY);
}

static float bound_of(const float p[3], const float b[3]) {
  const float gamma7 = 7 * 0x1p-24f / (1 - 7 * 0x1p-24f);
  return gamma7 *
         (fabsf(b[0] * p[0]) + fabsf(b[1] * p[1]) + fabsf(b[2] * p[2]));
}

static vec3 bound_origin(const stage *s, const arrival *a, vec3 n) {
  const mesh *m = &s->scene.mesh;
  const uint32_t *i = m->position_index + 3 * (size_t)a->hit.triangle;
  vec3 p = m->positions[i[0]], q = m->positions[i[1]], r = m->positions[i[2]];
  const float b[3] = {1 - a->hit.b1 - a->hit.b2, a->hit.b1, a->hit.b2};
  const float x[3] = {p.x, q.x, r.x}, y[3] = {p.y, q.y, r.y},
              z[3] = {p.z, q.z, r.z};
  vec3 bound = {bound_of(x, b), bound_of(y, b), bound_of(z, b)};
  float distance = vec3_dot(vec3_abs(n), bound);
  return (vec3){bound_step(x, b, n.x, distance),
                bound_step(y, b, n.y, distance),
                bound_step(z, b, n.z, distance)};
}

static ray leave(const stage *s, const arrival *a, vec3 w, leaving how) {
  vec3 along = vec3_mad(a->ray.o, a->hit.t, a->ray.d), n = a->at.ng;
  if (vec3_dot(n, w) < 0) n = vec3_neg(n);
  ray r = ray_from(along, w);
  switch (how) {
  case LEAVE_NAIVE: return r;
  case LEAVE_FIXED: r.tmin = 1e-3f; return r;
  case LEAVE_SCALED:
    r.o = (vec3){scaled_step(along.x, n.x), scaled_step(along.y, n.y),
                 scaled_step(along.z, n.z)};
    return r;
  case LEAVE_BOUND: r.o = bound_origin(s, a, n); return r;
  case LEAVE_FACET: return surface_ray(&a->at, w);
  case LEAVE_SMOOTH: return surface_smooth_ray(&a->at, w);
  }
  return r;
}

// The first thing that a ray meets; false when nothing.
static bool arrive(const stage *s, ray r, arrival *a) {
  a->ray = r;
  if (!bvh_closest(&s->tree, &r, &a->hit)) return false;
  a->at = surface_at(&s->scene, &a->hit, r.d);
  return true;
}

// Of rays that reach a closed convex mesh from outside and leave it again, the
// shares in percent that hit it on the way out, and that find no other side on
// the way in.
static void leave_table_row(const stage *s, float size, vec3 middle,
                            const char *label) {
  const int count = 50000;
  printf("%-18s", label);
  for (int how = LEAVE_NAIVE; how <= LEAVE_FACET; how++) {
    uint32_t state = 1;
    int stuck = 0, leaked = 0, seen = 0;
    while (seen < count) {
      vec3 target = vec3_mad(middle, 0.7f * size, dice_direction(&state));
      vec3 o = vec3_mad(middle, 4 * size, dice_direction(&state));
      arrival a;
      if (!arrive(s, ray_from(o, vec3_unit(vec3_sub(target, o))), &a)) continue;
      seen++;
      vec3 out = dice_direction(&state);
      if (vec3_dot(out, a.at.ng) < 0) out = vec3_neg(out);
      hit other;
      ray r = leave(s, &a, out, (leaving)how);
      stuck += bvh_closest(&s->tree, &r, &other);
      r = leave(s, &a, vec3_neg(out), (leaving)how);
      leaked += !bvh_closest(&s->tree, &r, &other);
    }
    printf(" %7.3f %7.3f", 100.0 * stuck / count, 100.0 * leaked / count);
  }
  printf("\n");
}

static void leave_table(void) {
  static const struct {
    const char *label;
    float size, at;
    bool cube;
  } row[7] = {{"ball 1e-6", 1e-6f, 0, false},
              {"ball 1e-3", 1e-3f, 0, false},
              {"ball 1", 1, 0, false},
              {"ball 1e3", 1e3f, 0, false},
              {"ball 1e6", 1e6f, 0, false},
              {"ball 100 at 1e6", 100, 1e6f, false},
              {"cube 100 at 1e6", 100, 1e6f, true}};
  printf("self-hits and leaks, percent of rays\n%-18s%16s%16s%16s%16s%16s\n",
         "", "o + t d", "tmin 1e-3", "1/65536 floor", "float bound", "facet");
  for (int k = 0; k < 7; k++) {
    arena mem = {0};
    solid s = row[k].cube ? solid_cube(&mem) : solid_icosphere(&mem, 2);
    solid_turn(&s);
    vec3 middle = {row[k].at, 0.7f * row[k].at, -0.9f * row[k].at};
    solid_place(&s, row[k].size, middle);
    stage st = stage_of(&s, false, middle, &mem);
    leave_table_row(&st, row[k].size, middle, row[k].label);
    arena_free(&mem);
  }
}

// What a picture is of: how rays leave, and what a hit looks like.
typedef struct shot {
  const stage *stage;
  camera_view view;
  leaving how;
  vec3 (*look)(const struct shot *s, const arrival *a);
} shot;

static camera_view view_of(vec3 eye, vec3 target, float fov, int w, int h) {
  camera c = {.eye = eye, .target = target, .up = {0, 1, 0}, .fov_deg = fov};
  camera_view v;
  error err;
  if (!camera_view_of(&v, &c, w, h, &err)) exit(2);
  return v;
}

// Render one tile of im, whose left upper corner is (x0, 0), with n x n rays a
// pixel; where nothing is hit the tile stays as it is.
static void tile(image im, int x0, const shot *s, int width, int n) {
  for (int y = 0; y < im.height; y++)
    for (int x = 0; x < width; x++) {
      vec3 *pixel = &im.pixels[y * im.width + x0 + x], sum = {0, 0, 0};
      for (int k = 0; k < n * n; k++) {
        float u = ((float)(k % n) + 0.5f) / (float)n;
        float v = ((float)(k / n) + 0.5f) / (float)n;
        arrival a;
        ray r = camera_ray(&s->view, (float)x + u, (float)y + v);
        bool seen = arrive(s->stage, r, &a);
        sum = vec3_add(sum, seen ? s->look(s, &a) : *pixel);
      }
      *pixel = vec3_scale(sum, 1 / (float)(n * n));
    }
}

// The cosine to the light, 0 in shadow; a little light from everywhere so that
// the shape of what is dark can be seen.
static float lit(const shot *s, const arrival *a, vec3 n) {
  float cosine = vec3_dot(n, s->stage->to_light);
  if (!(cosine > 0)) return 0;
  ray r = leave(s->stage, a, s->stage->to_light, s->how);
  return bvh_any(&s->stage->tree, &r) ? 0 : cosine;
}

static vec3 look_flat(const shot *s, const arrival *a) {
  return vec3_all(0.02f + 0.75f * lit(s, a, a->at.ng));
}

static vec3 look_smooth(const shot *s, const arrival *a) {
  return vec3_all(0.02f + 0.75f * lit(s, a, a->at.ns));
}

// A ball over a floor, both of triangles.
static solid ball_on_floor(arena *mem, int level, float scale, vec3 at) {
  solid s = solid_icosphere(mem, level);
  solid all = solid_new(mem, level + 1);
  for (uint32_t i = 0; i < s.vertices; i++)
    solid_vertex(&all, s.p[i]);
  for (uint32_t i = 0; i < s.triangles; i++)
    solid_triangle(&all, s.index[3 * i], s.index[3 * i + 1],
                   s.index[3 * i + 2]);
  uint32_t v[4];
  for (int k = 0; k < 4; k++)
    v[k] = solid_vertex(
        &all, (vec3){k & 1 ? 30.0f : -31.0f, -1, k & 2 ? 29.0f : -30.0f});
  solid_triangle(&all, v[0], v[2], v[1]);
  solid_triangle(&all, v[1], v[2], v[3]);
  solid_place(&all, scale, at);
  return all;
}

static void floor_tile(output *o, image im, int x0, float scale, leaving how) {
  vec3 at = {37 * scale, 11 * scale, -23 * scale};
  solid s = ball_on_floor(&o->mem, 3, scale, at);
  stage st = stage_of(&s, false, (vec3){-2, 3, 1}, &o->mem);
  vec3 eye = vec3_mad(at, scale, (vec3){1, 3, 6});
  vec3 target = vec3_mad(at, scale, (vec3){0.3f, -0.4f, 0});
  shot v = {&st, view_of(eye, target, 30, 156, im.height), how, look_flat};
  tile(im, x0, &v, 156, 2);
}

// The same ball three times: rays from o + t d; with tmin = 1e-3, on a ball
// with a radius of 3e-4; and from the facet, at that size too.
static void paint_acne(output *o) {
  image im = paper(&o->mem, 480, 160);
  floor_tile(o, im, 0, 1, LEAVE_NAIVE);
  floor_tile(o, im, 162, 3e-4f, LEAVE_FIXED);
  floor_tile(o, im, 324, 3e-4f, LEAVE_FACET);
  publish(o->folder, "acne", im);
}

static void ball_tile(output *o, image im, int x0, int level, const shot *as) {
  solid s = solid_icosphere(&o->mem, level);
  solid_turn(&s);
  stage st = stage_of(&s, true, (vec3){3, 2, 0.5f}, &o->mem);
  shot v = *as;
  v.stage = &st;
  v.view = view_of((vec3){0, 0, 7}, (vec3){0, 0, 0}, 17.5f, 156, im.height);
  tile(im, x0, &v, 156, 3);
}

static void paint_terminator(output *o) {
  image im = tinted(&o->mem, 480, 160, vec3_all(0.05f));
  ball_tile(o, im, 0, 2, &(shot){.how = LEAVE_FACET, .look = look_flat});
  ball_tile(o, im, 162, 2, &(shot){.how = LEAVE_FACET, .look = look_smooth});
  ball_tile(o, im, 324, 2, &(shot){.how = LEAVE_SMOOTH, .look = look_smooth});
  publish(o->folder, "terminator", im);
}

// The sky in the mirror direction about n, with the glare of its sun damped;
// the inside of the ball, which is dark, where that direction is below the
// facet.
static vec3 sky_mirrored(const shot *s, const arrival *a, vec3 n) {
  vec3 wo = vec3_neg(a->ray.d);
  vec3 r = vec3_sub(vec3_scale(n, 2 * vec3_dot(wo, n)), wo);
  if (vec3_dot(r, a->at.ng) <= 0) return (vec3){0, 0, 0};
  vec3 c = env_radiance(&s->stage->scene.env, r);
  return (vec3){c.x / (1 + 0.2f * c.x), c.y / (1 + 0.2f * c.y),
                c.z / (1 + 0.2f * c.z)};
}

static vec3 look_mirror_flat(const shot *s, const arrival *a) {
  return sky_mirrored(s, a, a->at.ng);
}

static vec3 look_mirror_smooth(const shot *s, const arrival *a) {
  return sky_mirrored(s, a, a->at.ns);
}

static vec3 look_mirror_bent(const shot *s, const arrival *a) {
  vec3 wo = vec3_neg(a->ray.d);
  return sky_mirrored(s, a, surface_bend(a->at.ns, a->at.ng, wo));
}

static void paint_mirror(output *o) {
  image im = tinted(&o->mem, 480, 160, (vec3){0.62f, 0.68f, 0.74f});
  ball_tile(o, im, 0, 1, &(shot){.look = look_mirror_flat});
  ball_tile(o, im, 162, 1, &(shot){.look = look_mirror_smooth});
  ball_tile(o, im, 324, 1, &(shot){.look = look_mirror_bent});
  publish(o->folder, "mirror", im);
}

static void cube_tile(output *o, image im, int x0, const shot *as) {
  solid s = solid_cube(&o->mem);
  stage st = stage_of(&s, true, (vec3){-0.25f, 1, 0.9f}, &o->mem);
  shot v = *as;
  v.stage = &st;
  v.view = view_of((vec3){5, 4, 7}, (vec3){0, 0, 0}, 23, 156, im.height);
  tile(im, x0, &v, 156, 3);
}

static void paint_cube(output *o) {
  image im = tinted(&o->mem, 480, 160, vec3_all(0.05f));
  cube_tile(o, im, 0, &(shot){.how = LEAVE_FACET, .look = look_flat});
  cube_tile(o, im, 162, &(shot){.how = LEAVE_FACET, .look = look_smooth});
  cube_tile(o, im, 324, &(shot){.how = LEAVE_SMOOTH, .look = look_smooth});
  publish(o->folder, "cube", im);
}

// Fill the disc of radius r pixels around the point (x, y) of the plane, which
// the picture shows from -1.2 to 1.2.
static void ink(image im, vec3 at, float r, vec3 c) {
  float scale = (float)im.width / 2.4f;
  float px = (at.x + 1.2f) * scale, py = (1.2f - at.y) * scale;
  for (int y = (int)(py - r); y <= (int)(py + r) + 1; y++)
    for (int x = (int)(px - r); x <= (int)(px + r) + 1; x++) {
      float dx = (float)x + 0.5f - px, dy = (float)y + 0.5f - py;
      bool inside = x >= 0 && y >= 0 && x < im.width && y < im.height;
      if (inside && dx * dx + dy * dy < r * r) im.pixels[y * im.width + x] = c;
    }
}

// A picture of a third of the width and height.
static image thirded(output *o, image from) {
  image im = image_new(&o->mem, from.width / 3, from.height / 3);
  for (int y = 0; y < from.height; y++)
    for (int x = 0; x < from.width; x++) {
      vec3 *to = &im.pixels[y / 3 * im.width + x / 3];
      *to = vec3_mad(*to, 1.0f / 9, from.pixels[y * from.width + x]);
    }
  return im;
}

// A slice through an icosahedron: the sphere, the facets, the lifted points,
// and some interpolated normals.
static void paint_slice(output *o) {
  const vec3 sphere = {0.45f, 0.45f, 0.45f}, facet = {0.05f, 0.05f, 0.05f},
             lifted = {0.8f, 0.1f, 0.05f}, normal = {0.1f, 0.3f, 0.7f};
  solid s = solid_icosphere(&o->mem, 0);
  stage st = stage_of(&s, true, (vec3){0, 0, 1}, &o->mem);
  image im = paper(&o->mem, 960, 960);
  const int n = 6000;
  for (int k = 0; k < n; k++) {
    vec2 c = num_circle((float)k / (float)n);
    vec3 out = {c.x, c.y, 0};
    ink(im, out, 2.5f, sphere);
    arrival a;
    vec3 eye = vec3_scale(out, 3);
    if (!arrive(&st, ray_from(eye, vec3_neg(out)), &a)) continue;
    ink(im, a.at.p, 3.5f, facet);
    ink(im, a.at.p_smooth, 3.5f, lifted);
    for (int j = 0; k % 150 == 75 && j < 100; j++)
      ink(im, vec3_mad(a.at.p, 0.0018f * (float)j, a.at.ns), 2, normal);
  }
  publish(o->folder, "slice", thirded(o, im));
}

// A globe of wide x high patches with texture coordinates.
typedef struct globe {
  solid solid;
  vec2 *uv;
} globe;

static globe globe_of(output *o, int wide, int high) {
  globe g = {.uv = ARENA_NEW(&o->mem, vec2, (size_t)((wide + 1) * (high + 1)))};
  g.solid = solid_new(&o->mem, 5);
  for (int y = 0; y <= high; y++)
    for (int x = 0; x <= wide; x++) {
      vec2 uv = {(float)x / (float)wide, (float)y / (float)high};
      g.uv[solid_vertex(&g.solid, env_direction((vec2){uv.x, 1 - uv.y}))] = uv;
    }
  for (int y = 0; y < high; y++)
    for (int x = 0; x < wide; x++) {
      uint32_t a = (uint32_t)(y * (wide + 1) + x), b = a + 1;
      uint32_t c = a + (uint32_t)wide + 1, d = c + 1;
      if (y > 0) solid_triangle(&g.solid, a, d, b);
      if (y < high - 1) solid_triangle(&g.solid, a, c, d);
    }
  return g;
}

// Heights of 512 x 256 texels: two waves that cross.
static texture waves(output *o) {
  float *height = ARENA_NEW(&o->mem, float, 512 * 256);
  for (int i = 0; i < 512 * 256; i++) {
    float u = ((float)(i % 512) + 0.5f) / 512, v = (float)(i / 512) / 256;
    float a = num_circle(24 * u - floorf(24 * u)).x;
    float b = num_circle(12 * v - floorf(12 * v)).x;
    height[i] = 0.5f + 0.25f * (a + b);
  }
  return (texture){.width = 512,
                   .height = 256,
                   .channels = 1,
                   .floats = height,
                   .is_linear = true};
}

static vec3 look_bumped(const shot *s, const arrival *a) {
  vec3 n = surface_mapped_normal(&s->stage->scene, &a->at, &a->hit);
  return vec3_all(0.02f + 0.75f * lit(s, a, n));
}

static vec3 look_bumped_mirror(const shot *s, const arrival *a) {
  vec3 n = surface_mapped_normal(&s->stage->scene, &a->at, &a->hit);
  vec3 wo = vec3_neg(a->ray.d);
  return sky_mirrored(s, a, surface_bend(n, a->at.ng, wo));
}

static void paint_bump(output *o) {
  image im = tinted(&o->mem, 480, 160, (vec3){0.62f, 0.68f, 0.74f});
  globe g = globe_of(o, 48, 24);
  texture map = waves(o);
  material m = {.map_bump = {.image = &map,
                             .options = {.scale = {1, 1, 1}, .bump = 0.06f}}};
  stage st = stage_of(&g.solid, true, (vec3){3, 2, 1.5f}, &o->mem);
  shot v = {.stage = &st, .how = LEAVE_SMOOTH, .look = look_smooth};
  v.view = view_of((vec3){0, 2, 6.7f}, (vec3){0, 0, 0}, 17.5f, 156, im.height);
  tile(im, 0, &v, 156, 3);
  uint32_t *all = ARENA_NEW(&o->mem, uint32_t, g.solid.triangles);
  st.scene.mesh.texcoords = g.uv;
  st.scene.mesh.texcoord_index = g.solid.index;
  st.scene.materials = &m;
  st.scene.material_of = all;
  v.look = look_bumped;
  tile(im, 162, &v, 156, 3);
  v.look = look_bumped_mirror;
  tile(im, 324, &v, 156, 3);
  publish(o->folder, "bump", im);
}

// Errors of an icosphere's light against the sphere's, at random points under
// random directional lights: root mean square, and the share in percent that
// is black although the sphere is lit.
static void terminator_row(const stage *s, const char *label, leaving how,
                           bool smooth) {
  const int count = 200000;
  uint32_t state = 7;
  double sum = 0;
  int black = 0;
  for (int k = 0; k < count; k++) {
    vec3 target = vec3_scale(dice_direction(&state), 0.5f);
    vec3 to_light = dice_direction(&state);
    arrival a;
    vec3 eye = vec3_scale(target, 10);
    if (!arrive(s, ray_from(eye, vec3_neg(vec3_unit(target))), &a)) continue;
    float cosine = vec3_dot(smooth ? a.at.ns : a.at.ng, to_light);
    ray r = leave(s, &a, to_light, how);
    bool dark = !(cosine > 0) || bvh_any(&s->tree, &r);
    if (how == LEAVE_FACET && vec3_dot(a.at.ng, to_light) <= 0) dark = true;
    float got = dark ? 0 : cosine;
    float truth = fmaxf(vec3_dot(vec3_unit(a.at.p), to_light), 0);
    sum += (double)((got - truth) * (got - truth));
    black += dark && truth > 1e-5f;
  }
  printf("%-10s %8.5f %8.3f\n", label, sqrt(sum / count),
         100.0 * black / count);
}

// The same over the pixels of a picture from afar, with the light at right
// angles to the view: there a pixel's facet lies behind its point of the
// sphere, and that counts too.
static void terminator_seen(const stage *s, const char *label, leaving how,
                            bool smooth) {
  double sum = 0;
  int seen = 0;
  for (int i = 0; i < 500 * 500; i++) {
    float x = (float)(i % 500) / 250 - 0.998f;
    float y = (float)(i / 500) / 250 - 0.998f;
    arrival a;
    if (!arrive(s, ray_from((vec3){x, y, 5}, (vec3){0, 0, -1}), &a)) continue;
    shot v = {.stage = s, .how = how};
    float got = lit(&v, &a, smooth ? a.at.ns : a.at.ng);
    if (how == LEAVE_FACET && vec3_dot(a.at.ng, s->to_light) <= 0) got = 0;
    float truth = fmaxf(x * s->to_light.x + y * s->to_light.y, 0);
    sum += (double)((got - truth) * (got - truth));
    seen++;
  }
  printf("%-10s %8.5f\n", label, sqrt(sum / seen));
}

static void terminator_table(output *o) {
  for (int level = 1; level <= 3; level++) {
    solid s = solid_icosphere(&o->mem, level);
    stage st = stage_of(&s, true, (vec3){1, 0, 0}, &o->mem);
    printf("icosphere of level %d: rms error, wrongly black in percent\n",
           level);
    terminator_row(&st, "facets", LEAVE_FACET, false);
    terminator_row(&st, "smooth", LEAVE_FACET, true);
    terminator_row(&st, "lifted", LEAVE_SMOOTH, true);
  }
  solid s = solid_icosphere(&o->mem, 2);
  stage st = stage_of(&s, true, (vec3){1, 0.3f, 0}, &o->mem);
  printf("icosphere of level 2 as a picture: rms error\n");
  terminator_seen(&st, "facets", LEAVE_FACET, false);
  terminator_seen(&st, "smooth", LEAVE_FACET, true);
  terminator_seen(&st, "lifted", LEAVE_SMOOTH, true);
}

// The share in percent of mirror directions below the facet, over all pixels
// of an icosphere seen from afar.
static void mirror_table(output *o) {
  printf("mirror directions below the facet, percent: as interpolated, bent\n");
  for (int level = 1; level <= 4; level++) {
    solid s = solid_icosphere(&o->mem, level);
    stage st = stage_of(&s, true, (vec3){1, 0, 0}, &o->mem);
    int seen = 0, below[2] = {0, 0};
    for (int i = 0; i < 500 * 500; i++) {
      vec3 eye = {(float)(i % 500) / 250 - 0.998f,
                  (float)(i / 500) / 250 - 0.998f, 5};
      vec3 wo = {0, 0, 1};
      arrival a;
      if (!arrive(&st, ray_from(eye, vec3_neg(wo)), &a)) continue;
      seen++;
      vec3 n[2] = {a.at.ns, surface_bend(a.at.ns, a.at.ng, wo)};
      for (int k = 0; k < 2; k++) {
        vec3 r = vec3_sub(vec3_scale(n[k], 2 * vec3_dot(wo, n[k])), wo);
        below[k] += vec3_dot(r, a.at.ng) <= 0;
      }
    }
    printf("level %d %7.3f %7.3f\n", level, 100.0 * below[0] / seen,
           100.0 * below[1] / seen);
  }
}

// What a smooth body of albedo .8 reflects in a furnace when directions below
// the facet end the path, go through it, or leave from the lifted point.
static void furnace_row(const stage *s, const char *label, leaving how,
                        bool ends) {
  const int count = 200000;
  uint32_t state = 3;
  double reflected = 0, bounces = 0;
  int paths = 0;
  while (paths < count) {
    vec3 d = dice_direction(&state);
    vec3 aim = vec3_scale(dice_direction(&state), 0.9f);
    arrival a;
    if (!arrive(s, ray_from(vec3_mad(aim, -9, d), d), &a)) continue;
    paths++;
    double left = 1;
    for (int k = 0; k < 1000; k++) {
      vec3 ng = a.at.front ? a.at.ng : vec3_neg(a.at.ng);
      vec3 n = a.at.front ? a.at.ns : vec3_neg(a.at.ns);
      n = surface_face(n, vec3_unit(vec3_neg(a.ray.d)));
      vec3 around = vec3_scale(dice_direction(&state), 0.99999f);
      vec3 wi = vec3_unit(vec3_add(n, around));
      left *= 0.8;
      bounces++;
      if (ends && vec3_dot(wi, ng) <= 0) left = 0;
      ray r = leave(s, &a, wi, how);
      if (!(left > 0) || !arrive(s, r, &a)) break;
    }
    reflected += left;
  }
  printf("%-14s %8.5f %8.4f\n", label, reflected / count, bounces / count);
}

static void furnace_table(output *o) {
  for (int k = 0; k < 2; k++) {
    solid s = k == 0 ? solid_cube(&o->mem) : solid_icosphere(&o->mem, 1);
    stage st = stage_of(&s, true, (vec3){1, 0, 0}, &o->mem);
    printf("white furnace, albedo .8, %s: reflected, bounces per path\n",
           k == 0 ? "smooth cube" : "icosphere of level 1");
    furnace_row(&st, "end", LEAVE_FACET, true);
    furnace_row(&st, "go through", LEAVE_FACET, false);
    furnace_row(&st, "lifted", LEAVE_SMOOTH, false);
  }
}

// The share in percent of points on triangles with one corner `far` times as
// far away as the others, near the edge opposite that corner, that are farther
// from the true point than their bound says: in float, and as surface_at does
// it.
static void bound_row(float far) {
  const int count = 200000;
  uint32_t state = 5;
  int wrong[2] = {0, 0};
  for (int k = 0; k < count; k++) {
    vec3 p[3] = {vec3_scale(dice_direction(&state), far),
                 dice_direction(&state), dice_direction(&state)};
    uint32_t index[3] = {0, 1, 2};
    solid s = {.p = p, .index = index, .vertices = 3, .triangles = 1};
    scene w = solid_scene(&s, false);
    hit h = {.t = 1, .b1 = dice(&state) * dice(&state)};
    h.b2 = (1 - h.b1) * (1 - dice(&state) / far);
    surface at = surface_at(&w, &h, (vec3){0, 0, -1});
    const float b[3] = {1 - h.b1 - h.b2, h.b1, h.b2};
    const float x[3] = {p[0].x, p[1].x, p[2].x};
    double b1 = (double)h.b1, b2 = (double)h.b2;
    double truth =
        (1 - b1 - b2) * (double)x[0] + b1 * (double)x[1] + b2 * (double)x[2];
    float plain = b[0] * x[0] + b[1] * x[1] + b[2] * x[2];
    wrong[0] += fabs((double)plain - truth) > (double)bound_of(x, b);
    wrong[1] += fabs((double)at.p.x - truth) > (double)at.p_error.x;
  }
  printf("%-8g %8.3f %8.3f\n", (double)far, 100.0 * wrong[0] / count,
         100.0 * wrong[1] / count);
}

int main(int argc, char **argv) {
  output o = {argc > 1 ? argv[1] : ".", {0}};
  paint_acne(&o);
  paint_slice(&o);
  paint_terminator(&o);
  paint_cube(&o);
  paint_mirror(&o);
  paint_bump(&o);
  printf("points beyond their bound, percent: in float, in double\n");
  for (int k = 0; k < 4; k++)
    bound_row((float[]){1, 10, 100, 1000}[k]);
  leave_table();
  terminator_table(&o);
  furnace_table(&o);
  mirror_table(&o);
  arena_free(&o.mem);
  return 0;
}

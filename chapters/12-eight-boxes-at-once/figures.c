// figures.c — the pictures of chapter 12, and the numbers its text quotes.

#include "../easel.h"
#include "bvh_split.h"
#include "camera.h"
#include "num.h"
#include "rays.h"
#include "rng.h"
#include "triangle.h"
#include "wide.h"
#include "wide_patch.h"

#include <stdio.h>
#include <stdlib.h>

// Where the pictures go, and the threads that make them.
typedef struct output {
  const char *folder;
  arena mem;
  pool *threads;
} output;

// ---- A mesh by formula ----

// A mesh that is being filled; its arrays are large enough from the start.
typedef struct rock {
  vec3 *p;
  uint32_t *index;
  uint32_t vertices, triangles;
} rock;

static float wave(float x) {
  return num_circle(x - floorf(x)).y;
}

// Bumps of six sizes on the unit sphere.
static vec3 rock_point(vec3 d) {
  float r = 1, size = 0.16f, often = 0.37f;
  for (int k = 0; k < 6; k++) {
    vec3 u = vec3_scale(d, often);
    r += size * wave(u.x + 0.6f * wave(u.y)) * wave(u.y + 0.6f * wave(u.z)) *
         wave(u.z + 0.1f * (float)k);
    size *= 0.55f;
    often *= 2.1f;
  }
  return vec3_scale(d, r);
}

// Six faces of n x n cells, pushed out to the sphere.
static rock rock_of(arena *mem, uint32_t n) {
  size_t cells = 6 * (size_t)n * n, points = 6 * (size_t)(n + 1) * (n + 1);
  rock m = {ARENA_NEW(mem, vec3, points), ARENA_NEW(mem, uint32_t, 6 * cells),
            0, 0};
  for (int f = 0; f < 6; f++) {
    uint32_t first = m.vertices, row = n + 1;
    for (uint32_t i = 0; i < row * row; i++) {
      float u = 2 * (float)(i % row) / (float)n - 1;
      float v = 2 * (float)(i / row) / (float)n - 1, s = f & 1 ? 1 : -1;
      vec3 d = f < 2   ? (vec3){s, s * u, v}
               : f < 4 ? (vec3){v, s, s * u}
                       : (vec3){s * u, v, s};
      m.p[m.vertices++] = rock_point(vec3_unit(d));
    }
    for (uint32_t i = 0; i < n * n; i++) {
      uint32_t a = first + i / n * row + i % n, b = a + row;
      uint32_t *t = m.index + 3 * (size_t)m.triangles;
      t[0] = t[4] = a;
      t[1] = t[3] = a + 1;
      t[2] = t[5] = b;
      t[3] = b;
      t[4] = a + 1;
      t[5] = b + 1;
      m.triangles += 2;
    }
  }
  return m;
}

// ---- Heat ----

// From black through red to white, for x from 0 to 1.
static vec3 heat_color(float x) {
  static const vec3 stops[6] = {{0, 0, 0.02f},     {0.03f, 0.02f, 0.35f},
                                {0.35f, 0, 0.25f}, {0.85f, 0.12f, 0.01f},
                                {1, 0.65f, 0.05f}, {1, 1, 0.9f}};
  float at = fminf(fmaxf(x, 0), 0.9999f) * 5;
  int k = (int)at;
  return vec3_lerp(stops[k], stops[k + 1], at - (float)k);
}

// Nodes that the ray of each pixel visits, in the binary tree and in the wide
// one, by the same colours: white is 60.
static void draw_heats(output *o, const bvh *b, const wide_tree *w) {
  const camera c = {NULL, {1.4f, 1.6f, 3.2f}, {0, 0, 0}, {0, 1, 0}, 36};
  const wide_level *level = wide_level_at(0);
  camera_view view;
  error err;
  if (!camera_view_of(&view, &c, 236, 236, &err)) exit(3);
  image im = image_new(&o->mem, 480, 236);
  double sum[2] = {0};
  for (int i = 0; i < 480 * 236; i++)
    im.pixels[i] = (vec3){1, 1, 1};
  for (int i = 0; i < 236 * 236; i++) {
    ray r = camera_ray(&view, (float)(i % 236) + 0.5f, (float)(i / 236) + 0.5f);
    hit h;
    bvh_visits v[2] = {{0}};
    bvh_closest_counted(b, &r, &h, &v[0]);
    level->closest_counted(w, &r, &h, &v[1]);
    for (int k = 0; k < 2; k++) {
      sum[k] += v[k].nodes;
      im.pixels[i / 236 * 480 + 244 * k + i % 236] =
          heat_color((float)v[k].nodes / 60);
    }
  }
  publish(o->folder, "heat", im);
  printf("nodes a pixel: binary %.1f, wide %.1f\n", sum[0] / (236 * 236),
         sum[1] / (236 * 236));
}

// ---- Triangles that are cut ----

// A beam of three sides from a to b.
static void add_beam(rock *m, vec3 a, vec3 b) {
  vec3 d = vec3_sub(b, a);
  vec3 u = vec3_unit(vec3_cross(d, (vec3){d.y, d.z, d.x}));
  vec3 v = vec3_cross(vec3_unit(d), u);
  uint32_t first = m->vertices;
  for (int i = 0; i < 3; i++) {
    vec2 c = num_circle((float)i / 3);
    vec3 off = vec3_mad(vec3_scale(u, 0.012f * c.x), 0.012f * c.y, v);
    m->p[m->vertices++] = vec3_add(a, off);
    m->p[m->vertices++] = vec3_add(b, off);
  }
  for (uint32_t i = 0; i < 3; i++) {
    uint32_t p = first + 2 * i, q = first + 2 * ((i + 1) % 3);
    const uint32_t corner[6] = {p, q, q + 1, p, q + 1, p + 1};
    for (int k = 0; k < 6; k++)
      m->index[3 * (size_t)m->triangles + (size_t)k] = corner[k];
    m->triangles += 2;
  }
}

// A rock in a tangle of beams, and what its trees cost each pixel: triangles
// whole, and cut.  White is 120 nodes.
static void draw_cuts(output *o) {
  enum { BEAMS = 400 };
  rock small = rock_of(&o->mem, 40);
  rock m = {ARENA_NEW(&o->mem, vec3, small.vertices + 6 * BEAMS),
            ARENA_NEW(&o->mem, uint32_t, 3 * (small.triangles + 6 * BEAMS)),
            small.vertices, small.triangles};
  for (uint32_t i = 0; i < small.vertices; i++)
    m.p[i] = vec3_scale(small.p[i], 0.7f);
  for (uint32_t i = 0; i < 3 * small.triangles; i++)
    m.index[i] = small.index[i];
  for (int i = 0; i < BEAMS; i++) {
    float x[6];
    for (int k = 0; k < 6; k++)
      x[k] = 1.5f * wave(0.618034f * (float)(i * 6 + k) * (float)(k + 1));
    add_beam(&m, (vec3){x[0], x[1], x[2]}, (vec3){x[3], x[4], x[5]});
  }
  bvh of = {.positions = m.p, .index = m.index, .triangle_count = m.triangles};
  bvh b[2];
  wide_tree w[2];
  for (int k = 0; k < 2; k++) {
    bvh_split_build(&b[k], &of, k ? HUGE_VAL : 0, &o->mem, o->threads);
    wide_tree_build(&w[k], &b[k], &o->mem, o->threads);
  }
  const camera c = {NULL, {1.4f, 1.6f, 4.2f}, {0, 0, 0}, {0, 1, 0}, 36};
  camera_view view;
  error err;
  if (!camera_view_of(&view, &c, 236, 236, &err)) exit(3);
  image im = image_new(&o->mem, 480, 236);
  double sum[2] = {0};
  for (int i = 0; i < 480 * 236; i++)
    im.pixels[i] = (vec3){1, 1, 1};
  for (int i = 0; i < 2 * 236 * 236; i++) {
    int at = i / 2, k = i % 2;
    ray r =
        camera_ray(&view, (float)(at % 236) + 0.5f, (float)(at / 236) + 0.5f);
    hit h;
    bvh_visits v = {0};
    wide_level_at(0)->closest_counted(&w[k], &r, &h, &v);
    sum[k] += v.nodes;
    im.pixels[at / 236 * 480 + 244 * k + at % 236] =
        heat_color((float)v.nodes / 120);
  }
  publish(o->folder, "cuts", im);
  printf("tangle of %u triangles: nodes a pixel %.1f -> %.1f, cost %.1f -> "
         "%.1f, %u parts more\n",
         m.triangles, sum[0] / (236 * 236), sum[1] / (236 * 236), b[0].cost,
         b[1].cost, b[1].refs - b[1].kept);
}

// ---- What a fused multiply-add does ----

// Whether a ray from the origin along d passes through a triangle, by the edge
// functions as a compiler makes them that may fuse x y - z w into one rounding
// of x y and none of the difference.  A zero counts as inside.
static bool fused_hit(vec3 d, const vec3 p[3]) {
  ray_shear s = ray_shear_of(d);
  float x[3], y[3], e[3];
  for (int i = 0; i < 3; i++) {
    const float a[3] = {p[i].x, p[i].y, p[i].z};
    float z = a[s.kz];
    if (z * (s.sz > 0 ? 1.0f : -1.0f) <= 0) return false;
    x[i] = fmaf(-s.sx, z, a[(s.kz + 1) % 3]);
    y[i] = fmaf(-s.sy, z, a[(s.kz + 2) % 3]);
  }
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    e[i] = fmaf(x[k], y[j], -(y[k] * x[j]));
  }
  bool less = e[0] < 0 || e[1] < 0 || e[2] < 0;
  return !(less && (e[0] > 0 || e[1] > 0 || e[2] > 0));
}

// A rock of rings, closed: neighbours share their vertices.
static rock closed_rock(arena *mem, uint32_t rings, uint32_t sides) {
  size_t points = (size_t)(rings - 1) * sides + 2;
  rock m = {ARENA_NEW(mem, vec3, points), ARENA_NEW(mem, uint32_t, 6 * points),
            0, 0};
  for (uint32_t j = 1; j < rings; j++)
    for (uint32_t i = 0; i < sides; i++) {
      vec2 a = num_circle((float)i / (float)sides);
      vec2 b = num_circle(0.5f * (float)j / (float)rings);
      m.p[m.vertices++] = rock_point((vec3){b.y * a.x, b.x, b.y * a.y});
    }
  uint32_t north = m.vertices++, south = m.vertices++;
  m.p[north] = rock_point((vec3){0, 1, 0});
  m.p[south] = rock_point((vec3){0, -1, 0});
  for (uint32_t j = 0; j < rings; j++)
    for (uint32_t i = 0; i < sides; i++) {
      uint32_t k = (i + 1) % sides, up = (j - 1) * sides, down = j * sides;
      const uint32_t t[6] = {j > 0 ? up + i : north,
                             down + k,
                             down + i,
                             up + i,
                             j > 0 ? up + k : north,
                             j + 1 < rings ? down + k : south};
      for (int c = j + 1 < rings ? 0 : 3; c < (j > 0 ? 6 : 3); c++)
        m.index[3 * m.triangles + (uint32_t)(c % 3)] = t[c],
                                                 m.triangles += c % 3 == 2;
    }
  return m;
}

// A point of the map of all directions, as a disc.
static void map_dot(image im, vec3 d, int radius, vec3 c) {
  vec3 u = vec3_unit(d);
  int x = (int)(480 * (0.5f + atan2f(u.x, -u.z) / (2 * PI)));
  int y = (int)(240 * acosf(u.y) / PI);
  for (int q = y - radius; q <= y + radius; q++)
    for (int w = x - radius; w <= x + radius; w++)
      if (w >= 0 && w < 480 && q >= 0 && q < 240) im.pixels[q * 480 + w] = c;
}

// Whether a ray from the origin meets no triangle: by fused edge functions,
// and by triangle_hit.
static void ask_both(const rock *m, vec3 d, bool leaks[2]) {
  ray r = ray_from((vec3){0, 0, 0}, d);
  ray_shear s = ray_shear_of(d);
  leaks[0] = leaks[1] = true;
  for (uint32_t t = 0; t < m->triangles && (leaks[0] || leaks[1]); t++) {
    const uint32_t *v = m->index + 3 * (size_t)t;
    vec3 p[3] = {m->p[v[0]], m->p[v[1]], m->p[v[2]]};
    hit h;
    if (fused_hit(d, p)) leaks[0] = false;
    if (triangle_hit(&r, &s, p[0], p[1], p[2], &h)) leaks[1] = false;
  }
}

// Rays from the middle of a closed rock at points of its edges, as a map of
// directions: grey those that hit, red those that find a way out.
static void draw_leaks(output *o) {
  rock m = closed_rock(&o->mem, 22, 40);
  image im = image_new(&o->mem, 480, 240);
  uint32_t rays = 0, count[2] = {0};
  for (int i = 0; i < 480 * 240; i++)
    im.pixels[i] = (vec3){1, 1, 1};
  for (int pass = 0; pass < 2; pass++)
    for (uint32_t i = 0; i < 3 * m.triangles; i++) {
      vec3 a = m.p[m.index[i]], b = m.p[m.index[i - i % 3 + (i + 1) % 3]];
      for (int k = 1; k < 24; k++) {
        vec3 d = vec3_lerp(a, b, (float)k / 24);
        bool leaks[2] = {false, false};
        if (pass == 1) ask_both(&m, d, leaks);
        if (pass == 0) map_dot(im, d, 0, (vec3){0.45f, 0.45f, 0.5f});
        if (leaks[0]) map_dot(im, d, 1, (vec3){0.8f, 0.02f, 0.02f});
        rays += (uint32_t)pass;
        count[0] += leaks[0];
        count[1] += leaks[1];
      }
    }
  publish(o->folder, "fused", im);
  printf("of %u rays leak: %u with fused edge functions, %u with facet's\n",
         rays, count[0], count[1]);
}

// ---- Waiting ----

static void fill(image im, int x0, int y0, int width, int height, vec3 c) {
  for (int y = y0; y < y0 + height; y++)
    for (int x = x0; x < x0 + width && x < im.width; x++)
      im.pixels[y * im.width + x] = c;
}

// Four rays of five steps each: a step is work and then a wait for memory.
// Above, one ray after the other; below, each step of another ray.
static void draw_waiting(output *o) {
  static const vec3 color[4] = {{0.75f, 0.2f, 0.05f},
                                {0.05f, 0.35f, 0.6f},
                                {0.1f, 0.45f, 0.12f},
                                {0.6f, 0.4f, 0.02f}};
  const int work = 7, wait = 17, high = 16;
  image im = image_new(&o->mem, 480, 190);
  fill(im, 0, 0, 480, 190, (vec3){1, 1, 1});
  for (int r = 0; r < 4; r++)
    for (int k = 0; k < 5; k++) {
      int x = (5 * r + k) * (work + wait), y = 8 + 20 * r;
      fill(im, x, y, work, high, color[r]);
      fill(im, x + work, y + high / 2 - 1, wait, 2,
           vec3_lerp(color[r], vec3_all(1), 0.6f));
      x = k * (work + wait) + r * work;
      y = 108 + 20 * r;
      fill(im, x, y, work, high, color[r]);
      fill(im, x + work, y + high / 2 - 1, wait, 2,
           vec3_lerp(color[r], vec3_all(1), 0.6f));
    }
  fill(im, 0, 94, 480, 1, (vec3){0.5f, 0.5f, 0.5f});
  publish(o->folder, "waiting", im);
}

// ---- Eight bits ----

// The outline of a box, of which x and y are seen, in a picture whose unit is
// the frame of a node.
static void outline(image im, const float box[4], vec3 c, int thick) {
  int x0 = (int)(12 + 456 * box[0]), x1 = (int)(12 + 456 * box[2]);
  int y0 = (int)(228 - 216 * box[3]), y1 = (int)(228 - 216 * box[1]);
  fill(im, x0, y0, x1 - x0, thick, c);
  fill(im, x0, y1 - thick, x1 - x0, thick, c);
  fill(im, x0, y0, thick, y1 - y0, c);
  fill(im, x1 - thick, y0, thick, y1 - y0, c);
}

// The children of the root as the binary tree bounds them, and as bytes would
// if there were only 16 instead of 256 planes along an axis.
static void draw_planes(output *o, const bvh *b, const wide_cost *costs) {
  uint32_t child[WIDE], n = wide_children(b, costs, 0, child);
  const bvh_node *all = &b->nodes[0];
  float wx = all->hi.x - all->lo.x, wy = all->hi.y - all->lo.y;
  image im = image_new(&o->mem, 480, 240);
  fill(im, 0, 0, 480, 240, (vec3){1, 1, 1});
  for (int k = 0; k <= 15; k++) {
    fill(im, 12 + 456 * k / 15, 12, 1, 216, (vec3){0.8f, 0.8f, 0.8f});
    fill(im, 12, 228 - 216 * k / 15, 456, 1, (vec3){0.8f, 0.8f, 0.8f});
  }
  for (uint32_t i = 0; i < n; i++) {
    const bvh_node *c = &b->nodes[child[i]];
    float box[4] = {(c->lo.x - all->lo.x) / wx, (c->lo.y - all->lo.y) / wy,
                    (c->hi.x - all->lo.x) / wx, (c->hi.y - all->lo.y) / wy};
    float out[4] = {floorf(15 * box[0]) / 15, floorf(15 * box[1]) / 15,
                    ceilf(15 * box[2]) / 15, ceilf(15 * box[3]) / 15};
    outline(im, out, (vec3){0.85f, 0.25f, 0.1f}, 1);
    outline(im, box, (vec3){0.02f, 0.1f, 0.35f}, 2);
  }
  publish(o->folder, "planes", im);
}

// ---- Patches ----

// A ball of the cells of a rock, half of which are cut along a valley, and a
// die with round edges.
static void make_balls(rock out[2], arena *mem, uint32_t n) {
  for (int k = 0; k < 2; k++) {
    out[k] = rock_of(mem, n);
    for (uint32_t i = 0; i < out[k].vertices; i++) {
      vec3 d = vec3_unit(out[k].p[i]), e = vec3_mul(d, d);
      e = vec3_mul(e, e);
      float root = sqrtf(sqrtf(sqrtf(vec3_dot(e, e))));
      out[k].p[i] = k == 0 ? d : vec3_scale(d, 0.75f / root);
    }
  }
}

// A colour for each patch of more than a leaf; grey where there is none.
static vec3 patch_color(const wide_tree *w, uint32_t triangle) {
  uint32_t child = w->patch != NULL ? w->patch[triangle] : 0;
  if (child == 0) return vec3_all(0.12f);
  if (child & WIDE_LEAF_BIT) return vec3_all(0.3f);
  rng r = rng_of(12, child, 0);
  float x = rng_next(&r), y = rng_next(&r);
  return vec3_mad(vec3_all(0.15f), 0.8f, (vec3){x, y, rng_next(&r)});
}

// What rays that leave each triangle of a ball and a die pass over.
static void draw_patches(output *o) {
  const camera c = {NULL, {1.4f, 1.6f, 3.2f}, {0, 0, 0}, {0, 1, 0}, 36};
  rock balls[2];
  camera_view view;
  error err;
  make_balls(balls, &o->mem, 40);
  if (!camera_view_of(&view, &c, 236, 236, &err)) exit(3);
  image im = image_new(&o->mem, 480, 236);
  fill(im, 0, 0, 480, 236, (vec3){1, 1, 1});
  for (int k = 0; k < 2; k++) {
    const rock *m = &balls[k];
    bvh b;
    wide_tree w;
    uint32_t inner = 0;
    bvh_build(&b, m->p, m->index, m->triangles, BVH_SAH, &o->mem, o->threads);
    wide_tree_build(&w, &b, &o->mem, o->threads);
    wide_patches_find(&w, m->triangles, &o->mem, o->threads);
    for (int i = 0; i < 236 * 236; i++) {
      ray r =
          camera_ray(&view, (float)(i % 236) + 0.5f, (float)(i / 236) + 0.5f);
      hit h;
      if (wide_tracer(&w).closest(&w, &r, &h))
        im.pixels[i / 236 * 480 + 244 * k + i % 236] =
            patch_color(&w, h.triangle);
    }
    for (uint32_t i = 0; w.patch != NULL && i < m->triangles; i++)
      inner += w.patch[i] != 0 && !(w.patch[i] & WIDE_LEAF_BIT);
    printf("%u of %u triangles have a patch of more than a leaf\n", inner,
           m->triangles);
  }
  publish(o->folder, "patches", im);
}

// Height over the plane of the triangle from 190 to 290 of a tilted plane
// through its nearer edge, with a slope of 1/4 for the eye.
static float tilted(float x, int edge) {
  return edge == 0 ? (190 - x) / 4 : (x - 290) / 4;
}

static void thick_line(image im, vec2 a, vec2 b, vec3 c) {
  for (int k = -1; k <= 1; k++)
    draw_thin_line(im, (vec2){a.x, a.y + (float)k}, (vec2){b.x, b.y + (float)k},
                   c);
}

// A triangle from the side, and the planes below which a triangle may be
// passed over by a ray that climbs away from it.
static void draw_valley(output *o) {
  const float level = 130;
  const vec3 grey = vec3_all(0.35f), blue = {0.02f, 0.15f, 0.6f};
  image im = paper(&o->mem, 480, 190);
  for (int i = 0; i < 480 * 190; i++) {
    float x = (float)(i % 480), h = level - (float)(i / 480);
    bool below = h <= 0 || h <= tilted(x, 0) || h <= tilted(x, 1);
    if (below) im.pixels[i] = (vec3){0.8f, 0.87f, 0.95f};
  }
  draw_thin_line(im, (vec2){0, level}, (vec2){479, level}, grey);
  for (int edge = 0; edge < 2; edge++)
    draw_thin_line(im, (vec2){0, level - tilted(0, edge)},
                   (vec2){479, level - tilted(479, edge)}, grey);
  thick_line(im, (vec2){190, level}, (vec2){70, level - 18}, blue);
  thick_line(im, (vec2){70, level - 18}, (vec2){10, level + 40}, blue);
  thick_line(im, (vec2){290, level}, (vec2){380, level + 30}, blue);
  thick_line(im, (vec2){380, level + 30}, (vec2){430, level - 75},
             (vec3){0.75f, 0.04f, 0.02f});
  thick_line(im, (vec2){190, level}, (vec2){290, level}, (vec3){0, 0, 0});
  thick_line(im, (vec2){240, level}, (vec2){4, level - 65},
             (vec3){0.85f, 0.4f, 0.02f});
  publish(o->folder, "valley", im);
}

// ---- Visits ----

// How many children a node has, in the mean.
static double children_of(const wide_tree *w) {
  uint64_t sum = 0;
  for (uint32_t i = 0; i < w->node_count; i++)
    sum += (uint64_t)__builtin_popcount(w->nodes[i].valid);
  return (double)sum / w->node_count;
}

// A table of what rays visit in either tree, kind by kind.
static void print_visits(output *o, const rock *r, const bvh *b,
                         const wide_tree *w) {
  mesh m = {.positions = r->p,
            .position_count = r->vertices,
            .position_index = r->index,
            .triangle_count = r->triangles};
  ray_source from = {.m = &m, .tree = wide_tracer(w), .size = 200};
  from.limit = 40000;
  for (int k = 0; k < RAYS_KINDS; k++) {
    ray_set s;
    double n[2] = {0}, t[2] = {0};
    rays_generate(&s, (ray_kind)k, &from, &o->mem);
    for (size_t i = 0; i < s.count; i++) {
      hit h;
      bvh_visits v[2] = {{0}};
      bvh_closest_counted(b, &s.rays[i], &h, &v[0]);
      wide_level_at(0)->closest_counted(w, &s.rays[i], &h, &v[1]);
      for (int q = 0; q < 2; q++) {
        n[q] += v[q].nodes;
        t[q] += v[q].triangles;
      }
    }
    double c = (double)s.count;
    printf("%-8s nodes %.1f -> %.1f, triangles %.1f -> %.1f\n",
           rays_kind_name((ray_kind)k), n[0] / c, n[1] / c, t[0] / c, t[1] / c);
  }
  printf("%u binary nodes, %u wide ones of %.2f children; bytes a triangle "
         "%.1f\n",
         b->node_count, w->node_count, children_of(w),
         (double)wide_tree_bytes(w) / r->triangles);
}

// Nodes and triangles that a ray visits in rocks ten times as fine each time.
static void print_growth(output *o) {
  static const uint32_t cells[4] = {13, 41, 129, 408};
  for (int i = 0; i < 4; i++) {
    arena mem = {0};
    rock r = rock_of(&mem, cells[i]);
    bvh b;
    wide_tree w;
    bvh_build(&b, r.p, r.index, r.triangles, BVH_COARSE, &mem, o->threads);
    wide_tree_build(&w, &b, &mem, o->threads);
    mesh m = {.positions = r.p,
              .position_count = r.vertices,
              .position_index = r.index,
              .triangle_count = r.triangles};
    ray_source from = {
        .m = &m, .tree = wide_tracer(&w), .size = 200, .limit = 40000};
    printf("%u triangles, %.2f children a node:", r.triangles, children_of(&w));
    for (int k = RAYS_PRIMARY; k <= RAYS_BOUNCE; k += RAYS_BOUNCE) {
      ray_set s;
      double n = 0, t = 0;
      rays_generate(&s, (ray_kind)k, &from, &mem);
      for (size_t j = 0; j < s.count; j++) {
        hit h;
        bvh_visits v = {0};
        wide_level_at(0)->closest_counted(&w, &s.rays[j], &h, &v);
        n += v.nodes;
        t += v.triangles;
      }
      printf(" %s %.1f nodes, %.1f triangles;", rays_kind_name((ray_kind)k),
             n / (double)s.count, t / (double)s.count);
    }
    printf("\n");
    arena_free(&mem);
  }
}

int main(int argc, char **argv) {
  output o = {.folder = argc > 1 ? argv[1] : "."};
  o.threads = pool_new(&o.mem, pool_default_threads());
  rock m = rock_of(&o.mem, 100);
  bvh b;
  bvh_build(&b, m.p, m.index, m.triangles, BVH_SAH, &o.mem, o.threads);
  wide_tree w;
  wide_tree_build(&w, &b, &o.mem, o.threads);
  draw_heats(&o, &b, &w);
  draw_planes(&o, &b, wide_costs_of(&b, &o.mem, o.threads));
  draw_cuts(&o);
  draw_leaks(&o);
  draw_waiting(&o);
  draw_patches(&o);
  draw_valley(&o);
  print_visits(&o, &m, &b, &w);
  print_growth(&o);
  pool_free(o.threads);
  arena_free(&o.mem);
  return 0;
}

// figures.c — the pictures of chapter 3, and the numbers its text quotes.

#include "../easel.h"
#include "camera.h"
#include "env.h"
#include "num.h"
#include "texture.h"
#include "triangle.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

// Where the pictures go.
typedef struct output {
  const char *folder;
  arena mem;
} output;

// White paper of panes side by side with 4 pixels between them.
static image sheet(output *o, int panes, int width, int height) {
  image im = image_new(&o->mem, panes * (width + 4) - 4, height);
  for (int i = 0; i < im.width * im.height; i++)
    im.pixels[i] = vec3_all(1);
  return im;
}

// Pixel (x, y) of pane number `pane` of a sheet.
static vec3 *pane_pixel(image im, int pane, int width, int x, int y) {
  return &im.pixels[y * im.width + pane * (width + 4) + x];
}

// Triangles that share vertices.
typedef struct model {
  vec3 *positions;
  uint32_t *index;
  uint32_t vertices, triangles;
} model;

static model model_new(arena *mem, uint32_t vertices, uint32_t triangles) {
  return (model){ARENA_NEW(mem, vec3, vertices),
                 ARENA_NEW(mem, uint32_t, 3 * triangles), 0, 0};
}

static void add_triangle(model *m, uint32_t a, uint32_t b, uint32_t c) {
  uint32_t *v = m->index + 3 * m->triangles++;
  v[0] = a, v[1] = b, v[2] = c;
}

// The (2, 3) torus knot as a tube of `around` sides and `along` rings.
static model knot(arena *mem, uint32_t along, uint32_t around) {
  model m = model_new(mem, along * around, 2 * along * around);
  for (uint32_t i = 0; i < along; i++) {
    vec3 c[3];  // the curve here and a little before and after
    for (int k = 0; k < 3; k++) {
      float t = ((float)i + 0.02f * (float)(k - 1)) / (float)along;
      t -= floorf(t);
      float t2 = 2 * t - floorf(2 * t), t3 = 3 * t - floorf(3 * t);
      vec2 two = num_circle(t2), three = num_circle(t3);
      c[k] = (vec3){(2 + three.x) * two.x, (2 + three.x) * two.y, three.y};
    }
    vec3 ahead = vec3_unit(vec3_sub(c[2], c[0]));
    vec3 side = vec3_unit(vec3_cross(ahead, (vec3){0, 0, 1}));
    vec3 up = vec3_cross(side, ahead);
    for (uint32_t k = 0; k < around; k++) {
      vec2 a = num_circle((float)k / (float)around);
      vec3 p = vec3_mad(vec3_mad(c[1], 0.5f * a.x, side), 0.5f * a.y, up);
      m.positions[m.vertices++] = p;
      uint32_t i1 = (i + 1) % along * around, k1 = (k + 1) % around;
      add_triangle(&m, i * around + k, i1 + k, i1 + k1);
      add_triangle(&m, i * around + k, i1 + k1, i * around + k1);
    }
  }
  return m;
}

// The number of the vertex at p, which is new or found again by search.
static uint32_t vertex_at(model *m, vec3 p) {
  for (uint32_t i = 0; i < m->vertices; i++) {
    vec3 q = m->positions[i];
    if (p.x == q.x && p.y == q.y && p.z == q.z) return i;
  }
  m->positions[m->vertices] = p;
  return m->vertices++;
}

// An octahedron, each face cut into n x n and blown up to the unit sphere.
// Neighbours share vertices.
static model ball(arena *mem, int n) {
  static const int corner[2][3][2] = {{{0, 0}, {1, 0}, {0, 1}},
                                      {{1, 0}, {1, 1}, {0, 1}}};
  uint32_t faces = 8 * (uint32_t)(n * n);
  model m = model_new(mem, 3 * faces, faces);
  for (int octant = 0; octant < 8; octant++)
    for (int i = 0; i < n; i++)
      for (int k = 0; k < 2 * (n - i) - 1; k++) {
        uint32_t v[3];
        for (int c = 0; c < 3; c++) {
          int x = k / 2 + corner[k % 2][c][0], y = i + corner[k % 2][c][1];
          vec3 p = {(float)x, (float)y, (float)(n - x - y)};
          if (octant & 1) p.x = -p.x;
          if (octant & 2) p.y = -p.y;
          if (octant & 4) p.z = -p.z;
          v[c] = vertex_at(&m, vec3_unit(p));
        }
        add_triangle(&m, v[0], v[1], v[2]);
      }
  return m;
}

// Every vertex scaled, then moved.
static model placed(arena *mem, model m, vec3 scale, vec3 move) {
  vec3 *moved = ARENA_NEW(mem, vec3, m.vertices);
  for (uint32_t i = 0; i < m.vertices; i++)
    moved[i] = vec3_add(vec3_mul(m.positions[i], scale), move);
  m.positions = moved;
  return m;
}

// The three corners of triangle t.
static void corners_of(const model *m, uint32_t t, vec3 p[3]) {
  for (int k = 0; k < 3; k++)
    p[k] = m->positions[m->index[3 * t + (uint32_t)k]];
}

// The closest hit by asking every triangle.
static bool trace(const model *m, ray r, hit *h) {
  ray_shear s = ray_shear_of(r.d);
  bool found = false;
  for (uint32_t t = 0; t < m->triangles; t++) {
    vec3 p[3];
    corners_of(m, t, p);
    if (!triangle_hit(&r, &s, p[0], p[1], p[2], h)) continue;
    h->triangle = t;
    r.tmax = h->t;
    found = true;
  }
  return found;
}

static vec3 normal_of(const model *m, uint32_t t) {
  vec3 p[3];
  corners_of(m, t, p);
  return vec3_unit(vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0])));
}

static camera_view view_of(camera c, int width, int height) {
  camera_view v;
  error err;
  if (!camera_view_of(&v, &c, width, height, &err)) exit(2);
  return v;
}

// What a hit shows in the three panes: depth, normal, barycentric weights.
static void show_hit(const model *m, const hit *h, vec3 out[3]) {
  vec3 n = normal_of(m, h->triangle);
  double near = fmin(fmax((13.5 - (double)h->t) / 6.5, 0), 1);
  out[0] = vec3_all((float)srgb_decode(near));
  out[1] = vec3_scale(vec3_add(n, vec3_all(1)), 0.5f);
  out[2] = (vec3){1 - h->b1 - h->b2, h->b1, h->b2};
}

// The torus knot, three times.
static void draw_knot(output *o) {
  enum { SIDE = 156, SAMPLES = 2 };
  model m = knot(&o->mem, 60, 7);
  camera c = {NULL, {2, 3, 9.5f}, {0, 0, 0}, {0, 1, 0}, 43};
  camera_view v = view_of(c, SIDE, SIDE);
  image im = sheet(o, 3, SIDE, SIDE);
  for (int i = 0; i < SIDE * SIDE; i++) {
    vec3 sum[3] = {{0, 0, 0}};
    for (int s = 0; s < SAMPLES * SAMPLES; s++) {
      float x = (float)(i % SIDE) + ((float)(s % SAMPLES) + 0.5f) / SAMPLES;
      float y = (float)(i / SIDE) + ((float)(s / SAMPLES) + 0.5f) / SAMPLES;
      vec3 seen[3] = {{0, 0, 0}, {1, 1, 1}, {1, 1, 1}};
      hit h;
      if (trace(&m, camera_ray(&v, x, y), &h)) show_hit(&m, &h, seen);
      for (int k = 0; k < 3; k++)
        sum[k] = vec3_mad(sum[k], 1.0f / (SAMPLES * SAMPLES), seen[k]);
    }
    for (int k = 0; k < 3; k++)
      *pane_pixel(im, k, SIDE, i % SIDE, i / SIDE) = sum[k];
  }
  publish(o->folder, "knot", im);
}

// A cube of side 1 around p.
static void add_cube(model *m, vec3 p) {
  static const uint32_t quad[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                      {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  uint32_t first = m->vertices;
  for (int i = 0; i < 8; i++)
    m->positions[m->vertices++] =
        vec3_add(p, (vec3){i & 1 ? 0.5f : -0.5f, i & 2 ? 0.5f : -0.5f,
                           i & 4 ? 0.5f : -0.5f});
  for (int i = 0; i < 6; i++) {
    const uint32_t *q = quad[i];
    add_triangle(m, first + q[0], first + q[1], first + q[2]);
    add_triangle(m, first + q[0], first + q[2], first + q[3]);
  }
}

// The light of a cube's face with normal n, without any source of light.
static vec3 cube_color(vec3 n) {
  float light = 0.45f + 0.3f * n.y + 0.15f * n.z - 0.2f * n.x;
  return vec3_scale((vec3){1, 0.75f, 0.5f}, light);
}

// The mean of 3 x 3 rays of pixel (x, y): cubes before a sky.
static vec3 cubes_at(const model *m, const camera_view *v, int x, int y) {
  env sky = {.kind = ENV_SKY, .scale = 0.8f};
  vec3 sum = vec3_all(0);
  for (int s = 0; s < 9; s++) {
    ray r = camera_ray(v, (float)x + ((float)(s % 3) + 0.5f) / 3,
                       (float)y + ((float)(s / 3) + 0.5f) / 3);
    hit h;
    vec3 seen = trace(m, r, &h) ? cube_color(normal_of(m, h.triangle))
                                : env_radiance(&sky, r.d);
    sum = vec3_mad(sum, 1.0f / 9, seen);
  }
  return sum;
}

// Five cubes in a row along each axis, as the framing camera sees them.
static void draw_framing(output *o) {
  enum { WIDTH = 156, HEIGHT = 110 };
  const vec3 steps[3] = {{1.5f, 0, 0}, {0, 1.5f, 0}, {0, 0, 1.5f}};
  image im = sheet(o, 3, WIDTH, HEIGHT);
  for (int k = 0; k < 3; k++) {
    model m = model_new(&o->mem, 8 * 5, 12 * 5);
    for (int i = -2; i <= 2; i++)
      add_cube(&m, vec3_scale(steps[k], (float)i));
    vec3 half = vec3_mad(vec3_all(0.5f), 2, steps[k]);
    camera c = camera_framing(vec3_neg(half), half, (float)WIDTH / HEIGHT);
    camera_view v = view_of(c, WIDTH, HEIGHT);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
      *pane_pixel(im, k, WIDTH, i % WIDTH, i / WIDTH) =
          cubes_at(&m, &v, i % WIDTH, i / WIDTH);
  }
  publish(o->folder, "framing", im);
}

// Two rows of cubes, seen with three angles from such distances that the
// first cubes keep their size.
static void draw_fov(output *o) {
  enum { WIDTH = 156, HEIGHT = 140 };
  const float angles[3] = {12, 45, 95};
  model m = model_new(&o->mem, 8 * 10, 12 * 10);
  for (int i = 0; i < 5; i++) {
    add_cube(&m, (vec3){-1.1f, 0, -2.0f * (float)i});
    add_cube(&m, (vec3){1.1f, 0, -2.0f * (float)i});
  }
  image im = sheet(o, 3, WIDTH, HEIGHT);
  for (int k = 0; k < 3; k++) {
    vec2 half = num_circle(angles[k] / 720);
    float distance = 0.5f + 1.9f * half.x / half.y;
    vec3 eye = {0, 0.22f * distance, distance};
    camera c = {NULL, eye, {0, 0, 0.5f}, {0, 1, 0}, angles[k]};
    camera_view v = view_of(c, WIDTH, HEIGHT);
    printf("fov %.0f: from %.1f units\n", (double)angles[k], (double)distance);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
      *pane_pixel(im, k, WIDTH, i % WIDTH, i / WIDTH) =
          cubes_at(&m, &v, i % WIDTH, i / WIDTH);
  }
  publish(o->folder, "fov", im);
}

// All directions at once: the sky, and directions as colours with a line
// every 45 degrees.
static void draw_sky(output *o) {
  enum { WIDTH = 238, HEIGHT = 119 };
  env sky = {.kind = ENV_SKY, .scale = 0.8f};
  image im = sheet(o, 2, WIDTH, HEIGHT);
  for (int y = 0; y < HEIGHT; y++)
    for (int x = 0; x < WIDTH; x++) {
      vec2 uv = {((float)x + 0.5f) / WIDTH, ((float)y + 0.5f) / HEIGHT};
      vec3 d = env_direction(uv);
      *pane_pixel(im, 0, WIDTH, x, y) = env_radiance(&sky, d);
      float u8 = 8 * uv.x, v4 = 4 * uv.y;
      bool line = fabsf(u8 - floorf(u8 + 0.5f)) < 0.02f ||
                  fabsf(v4 - floorf(v4 + 0.5f)) < 0.02f;
      vec3 c = vec3_scale(vec3_add(d, vec3_all(1)), 0.5f);
      *pane_pixel(im, 1, WIDTH, x, y) = vec3_scale(c, line ? 0.25f : 1);
    }
  publish(o->folder, "sky", im);
  double sum = 0;
  for (int i = 0; i < 1000; i++)
    for (int k = 0; k < 1000; k++) {
      float h = 1 - ((float)i + 0.5f) / 500, s = sqrtf(1 - h * h);
      vec2 a = num_circle(((float)k + 0.5f) / 1000);
      vec3 l = env_radiance(&sky, (vec3){s * a.x, h, s * a.y});
      sum += (double)(0.2126f * l.x + 0.7152f * l.y + 0.0722f * l.z) / 0.8;
    }
  printf("mean luminance of the sky: %.4f\n", sum / 1e6);
}

// Four by four texels enlarged: nearest, bilinear repeated, bilinear clamped.
static void draw_texture(output *o) {
  enum { SIDE = 156 };
  static const uint8_t texels[48] = {
      240, 230, 200, 40,  60,  120, 240, 230, 200, 40,  60,  120,
      40,  60,  120, 240, 230, 200, 230, 90,  40,  240, 230, 200,
      240, 230, 200, 230, 90,  40,  240, 230, 200, 40,  60,  120,
      40,  60,  120, 240, 230, 200, 40,  60,  120, 240, 230, 200};
  float decode[256];
  for (int i = 0; i < 256; i++)
    decode[i] = (float)srgb_decode(i / 255.0);
  texture t = {.path = "texels",
               .width = 4,
               .height = 4,
               .channels = 3,
               .bytes = texels,
               .decode = decode};
  texture_map m = {&t, {.scale = {1, 1, 1}}, true, NULL};
  image im = sheet(o, 3, SIDE, SIDE);
  for (int pane = 0; pane < 3; pane++)
    for (int i = 0; i < SIDE * SIDE; i++) {
      float u = ((float)(i % SIDE) + 0.5f) / SIDE * 1.5f - 0.25f;
      float v = 1.25f - ((float)(i / SIDE) + 0.5f) / SIDE * 1.5f;
      if (pane == 0) u = (floorf(4 * u) + 0.5f) / 4;
      if (pane == 0) v = (floorf(4 * v) + 0.5f) / 4;
      m.options.clamp = pane == 2;
      *pane_pixel(im, pane, SIDE, i % SIDE, i / SIDE) =
          texture_rgb(&m, (vec2){u, v});
    }
  publish(o->folder, "texture", im);
}

// A question that a ray can be asked about a triangle.
typedef bool (*test)(const ray *r, const ray_shear *s, const vec3 p[3]);

// Source: Moller and Trumbore 1997.
static bool moller_trumbore(const ray *r, const ray_shear *s, const vec3 p[3]) {
  (void)s;
  vec3 e1 = vec3_sub(p[1], p[0]), e2 = vec3_sub(p[2], p[0]);
  vec3 n = vec3_cross(r->d, e2), from = vec3_sub(r->o, p[0]);
  float det = vec3_dot(e1, n);
  if (det == 0) return false;
  float b1 = vec3_dot(from, n) / det;
  vec3 q = vec3_cross(from, e1);
  float b2 = vec3_dot(r->d, q) / det;
  return b1 >= 0 && b2 >= 0 && b1 + b2 <= 1 && vec3_dot(e2, q) / det > 0;
}

// Sheared edge functions, but with the first product and the difference fused
// into one rounding, as a compiler does when it is let.
static bool fused(const ray *r, const ray_shear *s, const vec3 p[3]) {
  float x[3], y[3], z[3], e[3];
  for (int i = 0; i < 3; i++) {
    vec3 a = vec3_sub(p[i], r->o);
    vec3 b = s->kz == 2   ? a
             : s->kz == 0 ? (vec3){a.y, a.z, a.x}
                          : (vec3){a.z, a.x, a.y};
    x[i] = fmaf(-s->sx, b.z, b.x);
    y[i] = fmaf(-s->sy, b.z, b.y);
    z[i] = s->sz * b.z;
  }
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    e[i] = fmaf(x[k], y[j], -(y[k] * x[j]));
  }
  if ((e[0] < 0 || e[1] < 0 || e[2] < 0) && (e[0] > 0 || e[1] > 0 || e[2] > 0))
    return false;
  float det = e[0] + e[1] + e[2];
  return det != 0 && (e[0] * z[0] + e[1] * z[1] + e[2] * z[2]) / det > 0;
}

static bool watertight(const ray *r, const ray_shear *s, const vec3 p[3]) {
  hit h;
  return triangle_hit(r, s, p[0], p[1], p[2], &h);
}

// Whether any triangle answers yes.
static bool any_hit(const model *m, const ray *r, test ask) {
  ray_shear s = ray_shear_of(r->d);
  for (uint32_t t = 0; t < m->triangles; t++) {
    vec3 p[3];
    corners_of(m, t, p);
    if (ask(r, &s, p)) return true;
  }
  return false;
}

// A ball from within.  Where a pixel is near an edge its ray goes exactly to
// a point of that edge; black: no triangle is hit.
static void draw_leaks(output *o) {
  enum { SIDE = 236 };
  const test tests[2] = {moller_trumbore, watertight};
  model m = ball(&o->mem, 4);
  camera c = {NULL, {0.25f, 0.1f, 0.3f}, {0, 0, -1}, {0, 1, 0}, 75};
  camera_view v = view_of(c, SIDE, SIDE);
  image im = sheet(o, 2, SIDE, SIDE);
  for (int i = 0; i < SIDE * SIDE; i++) {
    ray r = camera_ray(&v, (float)(i % SIDE) + 0.5f, (float)(i / SIDE) + 0.5f);
    hit h;
    if (!trace(&m, r, &h)) continue;
    vec3 p[3], n = normal_of(&m, h.triangle);
    corners_of(&m, h.triangle, p);
    float b[3] = {1 - h.b1 - h.b2, h.b1, h.b2};
    int least = b[0] < b[1] ? (b[0] < b[2] ? 0 : 2) : (b[1] < b[2] ? 1 : 2);
    int j = (least + 1) % 3, k = (least + 2) % 3;
    bool edge = b[least] < 0.04f;
    if (edge) r.d = vec3_sub(vec3_lerp(p[j], p[k], b[k] / (b[j] + b[k])), r.o);
    float light = edge ? 0.45f : 0.7f + 0.25f * fabsf(n.y) - 0.1f * n.x;
    for (int pane = 0; pane < 2; pane++)
      *pane_pixel(im, pane, SIDE, i % SIDE, i / SIDE) =
          vec3_all(any_hit(&m, &r, tests[pane]) ? light : 0);
  }
  publish(o->folder, "leaks", im);
}

// The next of a sequence of numbers in [0, 1): xorshift64*.
static float uniform(uint64_t *state) {
  *state ^= *state >> 12;
  *state ^= *state << 25;
  *state ^= *state >> 27;
  return (float)((*state * UINT64_C(0x2545f4914f6cdd1d)) >> 40) * 0x1p-24f;
}

// Rays from inside m, a ball around `middle`, through random points of edges
// or through vertices; how many of n each test lets out.
static void count_leaks(const model *m, vec3 middle, bool vertex, int n,
                        int misses[3]) {
  const test tests[3] = {moller_trumbore, fused, watertight};
  uint64_t random = 88172645463325252;
  for (int k = 0; k < 3; k++)
    misses[k] = 0;
  for (int i = 0; i < n; i++) {
    uint32_t t = (uint32_t)(uniform(&random) * (float)m->triangles);
    vec3 p[3], q[3];
    corners_of(m, t, p);
    corners_of(m, (uint32_t)(uniform(&random) * (float)m->triangles), q);
    vec3 at = vertex ? p[0] : vec3_lerp(p[0], p[1], uniform(&random));
    vec3 from = vec3_lerp(middle, q[0], 0.9f * uniform(&random));
    ray r = ray_from(from, vec3_sub(at, from));
    for (int k = 0; k < 3; k++)
      misses[k] += !any_hit(m, &r, tests[k]);
  }
}

// The table of leaks.
static void print_leaks(output *o) {
  enum { RAYS = 100000 };
  model b = ball(&o->mem, 3);
  const vec3 zero = vec3_all(0), far = {1e6f, 1e6f, 1e6f};
  const struct {
    const char *name;
    vec3 scale, move;
  } rows[] = {{"radius 1", vec3_all(1), zero},
              {"radius 1e-6", vec3_all(1e-6f), zero},
              {"radius 100 at 1e6", vec3_all(100), far},
              {"a needle, 1 : 1e7", {1, 1, 1e7f}, zero}};
  printf("misses of %d rays through edges, then vertices:\n", RAYS);
  printf("%-18s %17s %17s %17s\n", "ball", "Moller-Trumbore", "fused", "ours");
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    model m = placed(&o->mem, b, rows[i].scale, rows[i].move);
    int edge[3], vertex[3];
    count_leaks(&m, rows[i].move, false, RAYS, edge);
    count_leaks(&m, rows[i].move, true, RAYS, vertex);
    printf("%-18s", rows[i].name);
    for (int k = 0; k < 3; k++)
      printf(" %8d %8d", edge[k], vertex[k]);
    printf("\n");
  }
}

// Seconds of work of this program, whatever else the machine does.
static double seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// Rays per second through every triangle of the knot, and tests per second.
static void print_speed(output *o) {
  model m = knot(&o->mem, 60, 7);
  camera c = {NULL, {2, 3, 9.5f}, {0, 0, 0}, {0, 1, 0}, 43};
  camera_view v = view_of(c, 100, 100);
  double best = HUGE_VAL;
  int hits = 0;
  for (int turn = 0; turn < 3; turn++) {
    double start = seconds();
    hits = 0;
    for (int i = 0; i < 10000; i++) {
      hit h;
      hits += trace(&m, camera_ray(&v, (float)(i % 100), (float)(i / 100)), &h);
    }
    best = fmin(best, seconds() - start);
  }
  printf("%u triangles, %d of 10000 rays hit\n", m.triangles, hits);
  printf("%.0f million tests a second, %.3f million rays a second\n",
         1e-6 * 10000 * m.triangles / best, 1e-6 * 10000 / best);
}

int main(int argc, char **argv) {
  if (argc != 2) return 2;
  output o = {.folder = argv[1]};
  draw_knot(&o);
  draw_fov(&o);
  draw_framing(&o);
  draw_sky(&o);
  draw_texture(&o);
  draw_leaks(&o);
  print_leaks(&o);
  print_speed(&o);
  arena_free(&o.mem);
  return 0;
}

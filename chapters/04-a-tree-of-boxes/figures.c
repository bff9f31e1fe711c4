// figures.c — the pictures of chapter 4, and the numbers its text quotes.

#include "../easel.h"
#include "aabb.h"
#include "bvh.h"
#include "camera.h"
#include "clock.h"
#include "num.h"
#include "rays.h"
#include "sah.h"
#include "slab.h"
#include "triangle.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Where the pictures go, and the threads that make them.
typedef struct output {
  const char *folder;
  arena mem;
  pool *threads;
} output;

// ---- Meshes by formula ----

// A mesh that is being filled; its arrays are large enough from the start.
static mesh mesh_room(arena *mem, size_t vertices, size_t triangles) {
  return (mesh){.positions = ARENA_NEW(mem, vec3, vertices),
                .position_index = ARENA_NEW(mem, uint32_t, 3 * triangles)};
}

// Number k of a sequence of numbers in [0, 1): fractions of the golden ratio's
// multiples, shuffled by a square.
static float scatter(uint32_t k) {
  uint64_t z = (uint64_t)(k + 1) * UINT64_C(0x9e3779b97f4a7c15);
  z = (z ^ (z >> 29)) * UINT64_C(0xbf58476d1ce4e5b9);
  return (float)(z >> 40) * 0x1p-24f;
}

// A surface p(u, v) over a grid of nu x nv cells, u and v in [0, 1].
typedef vec3 (*surface_map)(float u, float v, const float *shape);

static void add_grid(mesh *m, surface_map map, const float *shape, int nu,
                     int nv) {
  uint32_t first = (uint32_t)m->position_count, row = (uint32_t)nu + 1;
  for (int j = 0; j <= nv; j++)
    for (int i = 0; i <= nu; i++)
      m->positions[m->position_count++] =
          map((float)i / (float)nu, (float)j / (float)nv, shape);
  for (uint32_t j = 0; j < (uint32_t)nv; j++) {
    for (uint32_t i = 0; i < (uint32_t)nu; i++) {
      uint32_t a = first + j * row + i;
      const uint32_t six[6] = {a, a + row, a + 1, a + 1, a + row, a + row + 1};
      memcpy(m->position_index + 3 * m->triangle_count, six, sizeof six);
      m->triangle_count += 2;
    }
  }
}

// A point on the tube about a (2, 3) torus knot; shape: centre, size, radius
// of the tube.
static vec3 knot_point(float u, vec3 centre, float size) {
  vec2 p = num_circle(2 * u - floorf(2 * u));
  vec2 q = num_circle(3 * u - floorf(3 * u));
  float r = 0.7f + 0.3f * q.x;
  return vec3_mad(centre, size, (vec3){r * p.x, 0.4f * q.y, r * p.y});
}

static vec3 knot_map(float u, float v, const float *shape) {
  vec3 centre = {shape[0], shape[1], shape[2]};
  float w = u >= 1 ? 0 : u;
  vec3 p = knot_point(w, centre, shape[3]);
  vec3 next =
      knot_point(w + 1e-3f < 1 ? w + 1e-3f : w + 1e-3f - 1, centre, shape[3]);
  vec3 along = vec3_unit(vec3_sub(next, p));
  vec3 side = vec3_unit(vec3_cross(along, (vec3){0.1f, 1, 0.2f}));
  vec2 c = num_circle(v >= 1 ? 0 : v);
  vec3 out =
      vec3_add(vec3_scale(side, c.x), vec3_scale(vec3_cross(side, along), c.y));
  return vec3_mad(p, shape[4], out);
}

// A sphere; shape: centre, radius.
static vec3 sphere_map(float u, float v, const float *shape) {
  vec2 a = num_circle(u >= 1 ? 0 : u), b = num_circle(0.5f * v);
  vec3 d = {b.y * a.x, b.x, b.y * a.y};
  if (v <= 0 || v >= 1) d = (vec3){0, v <= 0 ? 1 : -1, 0};
  return vec3_mad((vec3){shape[0], shape[1], shape[2]}, shape[3], d);
}

// Hills over -5..5.
static vec3 hill_map(float u, float v, const float *shape) {
  float wave = num_circle(u * 0.97f).y * num_circle(v * 0.83f).x;
  float ripple = num_circle(u * 7.3f - floorf(u * 7.3f)).y *
                 num_circle(v * 6.1f - floorf(v * 6.1f)).y;
  return (vec3){10 * u - 5, shape[0] * (0.6f * wave + 0.1f * ripple),
                10 * v - 5};
}

static mesh knot_mesh(arena *mem, int nu, int nv, vec3 at) {
  mesh m = mesh_room(mem, (size_t)((nu + 1) * (nv + 1)), (size_t)(2 * nu * nv));
  const float shape[5] = {at.x, at.y, at.z, 1, 0.14f};
  add_grid(&m, knot_map, shape, nu, nv);
  return m;
}

// A stalk from shape[0..2] to shape[3..5]: long triangles.
static vec3 stalk_map(float u, float v, const float *shape) {
  vec3 a = {shape[0], shape[1], shape[2]}, b = {shape[3], shape[4], shape[5]};
  vec2 c = num_circle(u >= 1 ? 0 : u);
  vec3 round = {0.02f * (1 - v) * c.x, 0, 0.02f * (1 - v) * c.y};
  return vec3_add(vec3_lerp(a, b, v), round);
}

// Room for two triangles in each of n cells, at least.
static size_t garden_cells(int n, int fine) {
  return (size_t)(n * n / 16 + 40 * fine * fine / 2 + n * n / 8 + 6 * 128);
}

// A garden of about 2.8 n^2 triangles: hills of coarse cells, 40 balls of one
// fineness and all sizes, a knot, and 128 leaning stalks.
static mesh garden_mesh(arena *mem, int n) {
  int fine = n / 4;
  size_t cells = garden_cells(n, fine);
  mesh m = mesh_room(mem, 2 * cells + 1000, 2 * cells);
  const float height = 1, knot[5] = {0, 1.2f, 0, 1.2f, 0.16f};
  add_grid(&m, hill_map, &height, n / 4, n / 4);
  for (uint32_t k = 0; k < 40; k++) {
    float u = scatter(4 * k), v = scatter(4 * k + 1), s = scatter(4 * k + 2);
    vec3 p = hill_map(u, v, &height);
    float size = 0.05f + 0.45f * s * s * s;
    const float ball[4] = {p.x, p.y + size, p.z, size};
    add_grid(&m, sphere_map, ball, fine, fine / 2);
  }
  add_grid(&m, knot_map, knot, n, n / 8);
  for (uint32_t k = 0; k < 128; k++) {
    float u = scatter(4 * k + 999), v = scatter(4 * k + 1000);
    vec3 p = hill_map(u, v, &height);
    const float stalk[6] = {p.x,        p.y,
                            p.z,        p.x + 2 * scatter(4 * k + 1001) - 1,
                            p.y + 2.5f, p.z + 2 * scatter(4 * k + 1002) - 1};
    add_grid(&m, stalk_map, stalk, 6, 1);
  }
  return m;
}

static bvh tree_of(const mesh *m, bvh_method method, output *o) {
  bvh b;
  bvh_build(&b, m->positions, m->position_index, (uint32_t)m->triangle_count,
            method, &o->mem, o->threads);
  return b;
}

// ---- Drawing ----

static const vec3 INK = {0.01f, 0.01f, 0.02f}, GREY = {0.45f, 0.45f, 0.45f},
                  RED = {0.75f, 0.03f, 0.02f}, BLUE = {0.02f, 0.1f, 0.6f},
                  GREEN = {0.01f, 0.3f, 0.05f}, ORANGE = {0.85f, 0.25f, 0.0f};

// Mix a share of c into a pixel; outside the picture nothing happens.
static void blend(image im, int x, int y, vec3 c, float share) {
  if (x < 0 || y < 0 || x >= im.width || y >= im.height) return;
  vec3 *p = &im.pixels[y * im.width + x];
  *p = vec3_lerp(*p, c, share);
}

static void box_fill(image im, int x0, int y0, int width, int height, vec3 c) {
  for (int y = y0; y < y0 + height; y++)
    for (int x = x0; x < x0 + width; x++)
      blend(im, x, y, c, 1);
}

// A smooth line a pixel wide: along its longer side, two pixels share a step.
static void line(image im, vec2 a, vec2 b, vec3 c, float share) {
  bool steep = fabsf(b.y - a.y) > fabsf(b.x - a.x);
  float u0 = steep ? a.y : a.x, v0 = steep ? a.x : a.y;
  float u1 = steep ? b.y : b.x, v1 = steep ? b.x : b.y;
  float slope = u1 != u0 ? (v1 - v0) / (u1 - u0) : 0;
  int from = (int)ceilf(fminf(u0, u1)), to = (int)floorf(fmaxf(u0, u1));
  for (int u = from; u <= to; u++) {
    float v = v0 + slope * ((float)u - u0), whole = floorf(v);
    for (int k = 0; k < 2; k++) {
      int w = (int)whole + k;
      float part = k ? v - whole : 1 - (v - whole);
      blend(im, steep ? w : u, steep ? u : w, c, share * part);
    }
  }
}

// Letters of 3 x 5 dots, rows from the top, five octal digits each.
static const struct {
  char letter;
  const char *rows;
} LETTERS[] = {{'0', "75557"}, {'1', "26227"}, {'2', "71747"}, {'3', "71717"},
               {'4', "55711"}, {'5', "74717"}, {'6', "74757"}, {'7', "71122"},
               {'8', "75757"}, {'9', "75717"}, {'.', "00002"}, {'-', "00700"},
               {'*', "05250"}, {'(', "12221"}, {')', "42224"}, {'=', "07070"},
               {'A', "25755"}, {'B', "65656"}, {'C', "34443"}, {'D', "65556"},
               {'E', "74647"}, {'F', "74644"}, {'G', "34553"}, {'H', "55755"},
               {'I', "72227"}, {'J', "11152"}, {'K', "55655"}, {'L', "44447"},
               {'M', "57755"}, {'N', "65555"}, {'O', "25552"}, {'P', "65644"},
               {'Q', "25573"}, {'R', "65655"}, {'S', "34216"}, {'T', "72222"},
               {'U', "55557"}, {'V', "55552"}, {'W', "55775"}, {'X', "55255"},
               {'Y', "55222"}, {'Z', "71247"}};

// Write text with its left upper corner at (x, y), dots of 2 x 2 pixels.
static void text(image im, int x, int y, vec3 c, const char *s) {
  for (; *s != 0; s++, x += 8) {
    for (size_t k = 0; k < sizeof LETTERS / sizeof *LETTERS; k++) {
      if (LETTERS[k].letter != *s) continue;
      for (int row = 0; row < 5; row++)
        for (int col = 0; col < 3; col++)
          if ((LETTERS[k].rows[row] - '0') >> (2 - col) & 1)
            box_fill(im, x + 2 * col, y + 2 * row, 2, 2, c);
    }
  }
}

static int text_width(const char *s) {
  return 8 * (int)strlen(s) - 2;
}

// Axes: the rectangle of the sheet that shows x0..x1, y0..y1.
typedef struct plot {
  image im;
  int left, top, width, height;
  float x0, x1, y0, y1;
} plot;

static vec2 plot_at(const plot *p, float x, float y) {
  return (vec2){(float)p->left +
                    (x - p->x0) / (p->x1 - p->x0) * (float)p->width,
                (float)(p->top + p->height) -
                    (y - p->y0) / (p->y1 - p->y0) * (float)p->height};
}

static void plot_line(const plot *p, vec2 a, vec2 b, vec3 c) {
  line(p->im, plot_at(p, a.x, a.y), plot_at(p, b.x, b.y), c, 1);
}

static void plot_dot(const plot *p, float x, float y, int radius, vec3 c) {
  vec2 at = plot_at(p, x, y);
  box_fill(p->im, (int)(at.x + 0.5f) - radius, (int)(at.y + 0.5f) - radius,
           2 * radius + 1, 2 * radius + 1, c);
}

// A tick with its label, on the x axis or on the y axis.
static void plot_tick(const plot *p, bool on_x, float at, const char *label) {
  vec2 c = plot_at(p, on_x ? at : p->x0, on_x ? p->y0 : at);
  int x = (int)c.x, y = (int)c.y;
  box_fill(p->im, on_x ? x : x - 4, y, on_x ? 1 : 4, on_x ? 4 : 1, INK);
  if (on_x)
    text(p->im, x - text_width(label) / 2, y + 7, INK, label);
  else
    text(p->im, x - 7 - text_width(label), y - 5, INK, label);
}

static void plot_frame(const plot *p) {
  box_fill(p->im, p->left, p->top, 1, p->height, INK);
  box_fill(p->im, p->left, p->top + p->height, p->width, 1, INK);
}

// ---- A mesh as seen ----

// A picture of a mesh inside a sheet, and how far each of its pixels is.
typedef struct panel {
  image im;
  int left, top, width, height;
  camera_view view;
  float *depth;
} panel;

static panel panel_of(output *o, image im, const int at[4], const camera *c) {
  error err;
  panel p = {im, at[0], at[1], at[2], at[3], .depth = NULL};
  p.depth = ARENA_NEW(&o->mem, float, (size_t)(at[2] * at[3]));
  if (!camera_view_of(&p.view, c, p.width, p.height, &err)) exit(3);
  return p;
}

// Light from the camera's upper left, on either side of a triangle.
static vec3 clay(const bvh *b, const hit *h, const ray *r, vec3 tint) {
  const uint32_t *v = b->index + 3 * (size_t)h->triangle;
  vec3 p0 = b->positions[v[0]];
  vec3 n = vec3_unit(vec3_cross(vec3_sub(b->positions[v[1]], p0),
                                vec3_sub(b->positions[v[2]], p0)));
  if (vec3_dot(n, r->d) > 0) n = vec3_neg(n);
  float lit = fmaxf(0, vec3_dot(n, (vec3){-0.42f, 0.82f, 0.39f}));
  return vec3_scale(tint, 0.12f + 0.8f * lit);
}

// Draw the mesh of a tree by `find`, with light on it.
static void panel_draw(panel *p, const bvh *b, tracer find, vec3 tint) {
  for (int i = 0; i < p->width * p->height; i++) {
    int x = i % p->width, y = i / p->width;
    ray r = camera_ray(&p->view, (float)x + 0.5f, (float)y + 0.5f);
    hit h;
    p->depth[i] = INFINITY;
    vec3 c = {0.82f, 0.85f, 0.9f};
    if (find.closest(find.tree, &r, &h)) {
      p->depth[i] = h.t;
      c = clay(b, &h, &r, tint);
    }
    blend(p->im, p->left + x, p->top + y, c, 1);
  }
}

// Where a point appears, in pixels of the panel, and its distance.
static vec3 panel_project(const panel *p, vec3 q) {
  const camera_view *c = &p->view;
  vec3 d = vec3_sub(q, c->eye);
  float s = vec3_dot(c->corner, c->forward) / vec3_dot(d, c->forward);
  vec3 on = vec3_sub(vec3_scale(d, s), c->corner);
  return (vec3){vec3_dot(on, c->right) / vec3_dot(c->right, c->right),
                vec3_dot(on, c->down) / vec3_dot(c->down, c->down),
                vec3_length(d)};
}

// An edge from a to b, faint where the mesh hides it.
static void panel_edge(const panel *p, vec3 a, vec3 b, vec3 c) {
  vec3 pa = panel_project(p, a), pb = panel_project(p, b);
  float length = fmaxf(fabsf(pb.x - pa.x), fabsf(pb.y - pa.y));
  int steps = (int)(length * 2) + 1;
  for (int i = 0; i <= steps; i++) {
    vec3 q = panel_project(p, vec3_lerp(a, b, (float)i / (float)steps));
    int x = (int)floorf(q.x), y = (int)floorf(q.y);
    if (x < 0 || y < 0 || x >= p->width || y >= p->height) continue;
    bool hidden = p->depth[y * p->width + x] < q.z * 0.999f;
    blend(p->im, p->left + x, p->top + y, c, hidden ? 0.12f : 0.6f);
  }
}

static void panel_box(const panel *p, vec3 lo, vec3 hi, vec3 c) {
  vec3 v[8];
  for (int k = 0; k < 8; k++)
    v[k] =
        (vec3){k & 1 ? hi.x : lo.x, k & 2 ? hi.y : lo.y, k & 4 ? hi.z : lo.z};
  for (int k = 0; k < 8; k++)
    for (int bit = 1; bit < 8; bit *= 2)
      if (!(k & bit)) panel_edge(p, v[k], v[k | bit], c);
}

// ---- Levels ----

// The boxes of the nodes at a depth, and of the leaves above it.
static void draw_level(const panel *p, const bvh *b, int depth) {
  uint32_t todo[BVH_MAX_DEPTH + 1];
  int level[BVH_MAX_DEPTH + 1], top = 1, shade = 0;
  static const vec3 inks[4] = {{0.75f, 0.03f, 0.02f},
                               {0.02f, 0.1f, 0.6f},
                               {0.01f, 0.3f, 0.05f},
                               {0.4f, 0.0f, 0.4f}};
  todo[0] = 0;
  level[0] = 0;
  while (top > 0) {
    top--;
    const bvh_node *n = &b->nodes[todo[top]];
    int d = level[top];
    if (d == depth || n->count > 0) {
      panel_box(p, n->lo, n->hi, inks[shade++ % 4]);
      continue;
    }
    for (uint32_t k = 0; k < 2; k++) {
      todo[top] = n->first + 1 - k;
      level[top++] = d + 1;
    }
  }
}

static void draw_levels(output *o) {
  mesh m = knot_mesh(&o->mem, 240, 24, (vec3){0, 0, 0});
  bvh b = tree_of(&m, BVH_SAH, o);
  image im = paper(&o->mem, 480, 360);
  const camera c = {NULL, {1.1f, 1.5f, 2.1f}, {0, 0, 0}, {0, 1, 0}, 36};
  for (int k = 0; k < 4; k++) {
    static const int depths[4] = {1, 3, 5, 8};
    panel p = panel_of(o, im, (int[4]){k % 2 * 242, k / 2 * 182, 238, 178}, &c);
    panel_draw(&p, &b, bvh_tracer(&b), (vec3){0.75f, 0.7f, 0.62f});
    draw_level(&p, &b, depths[k]);
    text(im, p.left + 6, p.top + 6, INK,
         arena_format(&o->mem, "LEVEL %d", depths[k]));
  }
  publish(o->folder, "levels", im);
  printf("knot: %zu triangles, %u nodes, depth %d, cost %.1f\n",
         m.triangle_count, b.node_count, b.depth, b.cost);
}

// ---- The price of a cut ----

// A lamp beside a table: 40 large triangles and 400 small ones.
static size_t lamp_refs(sah_ref *refs) {
  size_t n = 0;
  for (uint32_t i = 0; i < 440; i++) {
    bool lamp = i >= 40;
    float u = scatter(6 * i), v = scatter(6 * i + 1), w = scatter(6 * i + 2);
    vec2 c = num_circle(v);
    float size = lamp ? 0.012f : 0.06f, r = 0.1f * sqrtf(u);
    vec3 p = lamp ? (vec3){0.83f + r * c.x, 0.42f + r * c.y, 0.45f + 0.1f * w}
                  : (vec3){0.1f + 0.48f * u, 0.2f + 0.05f * v, w};
    vec3 e = {size * (0.5f + v), size * (lamp ? 0.5f + w : 0.3f), size};
    refs[n] = (sah_ref){.box = {{p.x - e.x, p.y - e.y, p.z - e.z},
                                {p.x + e.x, p.y + e.y, p.z + e.z}}};
    refs[n++].as.triangle = i;
  }
  return n;
}

static int by_centre_x(const void *a, const void *b) {
  const sah_ref *r = a, *s = b;
  float x = r->box.lo[0] + r->box.hi[0], y = s->box.lo[0] + s->box.hi[0];
  return (x > y) - (x < y);
}

// The exact curve: the cost of a cut behind each of n refs in order of their
// centres, relative to testing them all.
static void exact_costs(const sah_ref *refs, size_t n, double *cost) {
  sah_box left = sah_box_empty(), right = sah_box_empty();
  for (size_t i = n; i-- > 1;) {
    sah_box_join(&right, &refs[i].box);
    cost[i - 1] = sah_half_area(&right) * (double)(n - i);
  }
  for (size_t i = 0; i < n; i++) {
    sah_box_join(&left, &refs[i].box);
    if (i + 1 < n) cost[i] += sah_half_area(&left) * (double)(i + 1);
  }
  double all = sah_half_area(&left) * (double)n;
  for (size_t i = 0; i + 1 < n; i++)
    cost[i] /= all;
}

static float centre_x(const sah_ref *r) {
  return 0.5f * r->box.lo[0] + 0.5f * r->box.hi[0];
}

// The boxes from the front, the slices, and the cut's two sides.
static void draw_lamp(const plot *p, const sah_ref *refs, size_t n) {
  for (size_t i = 0; i < n; i++) {
    const sah_box *b = &refs[i].box;
    vec2 v[4] = {{b->lo[0], b->lo[1]},
                 {b->hi[0], b->lo[1]},
                 {b->hi[0], b->hi[1]},
                 {b->lo[0], b->hi[1]}};
    for (int k = 0; k < 4; k++)
      line(p->im, plot_at(p, v[k].x, v[k].y),
           plot_at(p, v[(k + 1) % 4].x, v[(k + 1) % 4].y), INK, 0.35f);
  }
}

static void draw_sides(const plot *p, const sah_split *s) {
  for (int side = 0; side < 2; side++) {
    const sah_box *b = side ? &s->right : &s->left;
    vec3 c = side ? BLUE : RED;
    vec2 lo = {b->lo[0], b->lo[1]}, hi = {b->hi[0], b->hi[1]};
    plot_line(p, lo, (vec2){hi.x, lo.y}, c);
    plot_line(p, lo, (vec2){lo.x, hi.y}, c);
    plot_line(p, hi, (vec2){hi.x, lo.y}, c);
    plot_line(p, hi, (vec2){lo.x, hi.y}, c);
  }
}

static void draw_cost(output *o) {
  sah_ref refs[440];
  double exact[440], binned[SAH_MAX_BINS];
  size_t n = lamp_refs(refs);
  qsort(refs, n, sizeof *refs, by_centre_x);
  exact_costs(refs, n, exact);
  sah_box box = sah_box_empty(), centres = box;
  for (size_t i = 0; i < n; i++) {
    sah_box_join(&box, &refs[i].box);
    sah_box_join_centre(&centres, &refs[i].box);
  }
  sah_grid g = sah_grid_of(&centres, SAH_MAX_BINS);
  sah_bins bins;
  sah_bins_clear(&bins, &g);
  sah_bins_add(&bins, &g, refs, n);
  sah_costs(&bins, &g, 0, binned);
  double area = sah_half_area(&box);
  // This figure is about one axis.
  g.scale[1] = g.scale[2] = 0;
  sah_split best = sah_best_split(&bins, &g, &box);
  image im = paper(&o->mem, 480, 360);
  plot scene = {im, 48, 6, 420, 118, 0, 1, 0, 0.62f};
  plot p = {im, 48, 140, 420, 180, 0, 1, 0, 1};
  draw_lamp(&scene, refs, n);
  draw_sides(&scene, &best);
  plot_frame(&p);
  for (size_t i = 0; i + 2 < n; i++)
    plot_line(&p, (vec2){centre_x(&refs[i]), (float)exact[i]},
              (vec2){centre_x(&refs[i + 1]), (float)exact[i + 1]}, GREY);
  float low = centres.lo[0], width = centres.hi[0] - low;
  for (int i = 0; i < SAH_MAX_BINS - 1; i++) {
    float x = low + width * (float)(i + 1) / SAH_MAX_BINS;
    if (isfinite(binned[i]))
      plot_dot(&p, x, (float)(binned[i] / (area * (double)n)), 2,
               best.axis == 0 && i == best.after ? RED : INK);
  }
  float middle = low + 0.5f * width, half = centre_x(&refs[n / 2]);
  float cut = low + width * (float)(best.after + 1) / SAH_MAX_BINS;
  plot_line(&p, (vec2){middle, 0}, (vec2){middle, 1}, ORANGE);
  plot_line(&p, (vec2){half, 0}, (vec2){half, 1}, GREEN);
  plot_line(&p, (vec2){cut, 0}, (vec2){cut, 1}, RED);
  text(im, (int)plot_at(&p, middle, 0).x - 54, 146, ORANGE, "MIDDLE");
  text(im, (int)plot_at(&p, half, 0).x + 8, 304, GREEN, "MEDIAN");
  text(im, (int)plot_at(&p, cut, 0).x + 8, 146, RED, "CHEAPEST");
  for (int k = 0; k <= 5; k++)
    plot_tick(&p, true, 0.2f * (float)k,
              arena_format(&o->mem, "%.1f", 0.2 * k));
  for (int k = 0; k <= 5; k++)
    plot_tick(&p, false, 0.2f * (float)k,
              arena_format(&o->mem, "%.1f", 0.2 * k));
  text(im, 180, 345, INK, "POSITION OF THE CUT");
  text(im, 52, 126, INK, "COST");
  publish(o->folder, "cost", im);
  printf("lamp: cost of the cheapest cut %.3f, middle %.3f, median %.3f\n",
         (best.cost / area - SAH_NODE_COST) / (double)n,
         binned[SAH_MAX_BINS / 2 - 1] / (area * (double)n), exact[n / 2]);
}

// ---- Heat ----

// From black over blue, red and yellow to white.
static vec3 heat_color(float x) {
  static const vec3 stops[6] = {{0, 0, 0.02f},     {0.03f, 0.02f, 0.35f},
                                {0.35f, 0, 0.25f}, {0.85f, 0.12f, 0.01f},
                                {1, 0.65f, 0.05f}, {1, 1, 0.9f}};
  float at = fminf(fmaxf(x, 0), 0.9999f) * 5;
  int k = (int)at;
  return vec3_lerp(stops[k], stops[k + 1], at - (float)k);
}

// How many nodes each pixel's ray visits; returns the mean.
static double draw_heat(image im, int left, const bvh *b,
                        const camera_view *view, float most) {
  double sum = 0;
  for (int i = 0; i < 236 * 236; i++) {
    ray r = camera_ray(view, (float)(i % 236) + 0.5f, (float)(i / 236) + 0.5f);
    hit h;
    bvh_visits v = {0};
    bvh_closest_counted(b, &r, &h, &v);
    sum += v.nodes;
    blend(im, left + i % 236, i / 236, heat_color((float)v.nodes / most), 1);
  }
  return sum / (236 * 236);
}

static void draw_heats(output *o, const mesh *m, const bvh *sah) {
  const camera c = {NULL, {4.2f, 4.4f, 7.5f}, {0, 0.1f, 0}, {0, 1, 0}, 50};
  const float most = 150;
  camera_view view;
  error err;
  if (!camera_view_of(&view, &c, 236, 236, &err)) exit(3);
  image im = paper(&o->mem, 480, 280);
  bvh median = tree_of(m, BVH_MEDIAN, o);
  double a = draw_heat(im, 0, &median, &view, most);
  double b = draw_heat(im, 244, sah, &view, most);
  for (int x = 0; x < 360; x++)
    box_fill(im, 60 + x, 262, 1, 14, heat_color((float)x / 360));
  for (int k = 0; k <= 3; k++) {
    const char *label = arena_format(&o->mem, "%d", 50 * k);
    text(im, 60 + 120 * k - text_width(label) / 2, 248, INK, label);
  }
  publish(o->folder, "heat", im);
  printf("garden: nodes a pixel, middle %.1f, SAH %.1f; cost %.1f, %.1f; "
         "depth %d, %d\n",
         a, b, median.cost, sah->cost, median.depth, sah->depth);
}

// ---- What goes wrong ----

// How to meet a box, four ways that are not facet's.
typedef enum slab_style {
  MINMAX,    // (lo - o) * inv, sorted and joined by min and max
  PRODUCTS,  // lo * inv - o * inv, by comparisons
  BARE,      // (lo - o) * inv, by comparisons, and nothing else
  FACTOR     // the same, far times 1 + 2 gamma(3)
} slab_style;

// A tree walked in one of those styles.
typedef struct wrong_tree {
  const bvh *b;
  slab_style style;
} wrong_tree;

// One axis: where the ray od[0] + t od[1] is between two planes.
static void wrong_axis(slab_style style, const float plane[2],
                       const float od[2], slab_span *span) {
  float inv = 1 / od[1], t[2];
  for (int k = 0; k < 2; k++)
    t[k] = style == PRODUCTS ? plane[k] * inv - od[0] * inv
                             : (plane[k] - od[0]) * inv;
  float near = inv < 0 ? t[1] : t[0], far = inv < 0 ? t[0] : t[1];
  if (style == MINMAX) {
    // As the machine's instructions do it: of NaN and a number, the second.
    near = t[0] < t[1] ? t[0] : t[1];
    far = t[0] > t[1] ? t[0] : t[1];
    span->near = span->near > near ? span->near : near;
    span->far = span->far < far ? span->far : far;
    return;
  }
  if (style == FACTOR) far *= 1 + 2 * (3 * 0x1p-24f / (1 - 3 * 0x1p-24f));
  if (near > span->near) span->near = near;
  if (far < span->far) span->far = far;
}

static bool wrong_box(slab_style style, const bvh_node *n, const ray *r) {
  const float lo[3] = {n->lo.x, n->lo.y, n->lo.z};
  const float hi[3] = {n->hi.x, n->hi.y, n->hi.z};
  const float o[3] = {r->o.x, r->o.y, r->o.z}, d[3] = {r->d.x, r->d.y, r->d.z};
  slab_span s = {r->tmin, r->tmax};
  for (int k = 0; k < 3; k++)
    wrong_axis(style, (float[2]){lo[k], hi[k]}, (float[2]){o[k], d[k]}, &s);
  return s.near <= s.far;
}

// The closest hit among what those boxes let through.
static bool wrong_closest(const void *tree, const ray *r, hit *h) {
  const wrong_tree *w = tree;
  const bvh *b = w->b;
  uint32_t todo[BVH_MAX_DEPTH + 1];
  int top = 1;
  bool found = false;
  ray left = *r;
  ray_shear shear = ray_shear_of(r->d);
  todo[0] = 0;
  while (top > 0) {
    const bvh_node *n = &b->nodes[todo[--top]];
    if (!wrong_box(w->style, n, &left)) continue;
    for (uint32_t i = n->first; i < n->first + n->count; i++) {
      const uint32_t *v = b->index + 3 * (size_t)b->order[i];
      if (!triangle_hit(&left, &shear, b->positions[v[0]], b->positions[v[1]],
                        b->positions[v[2]], h))
        continue;
      h->triangle = b->order[i];
      left.tmax = h->t;
      found = true;
    }
    if (n->count > 0) continue;
    todo[top++] = n->first;
    todo[top++] = n->first + 1;
  }
  return found;
}

// A block of a town: a box of 12 triangles, without its floor 10.
static vec3 block_corner(const float *b, uint32_t k) {
  return (vec3){b[k & 1 ? 3 : 0], b[k & 2 ? 4 : 1], b[k & 4 ? 5 : 2]};
}

static void add_block(mesh *m, const float *b) {
  static const uint32_t faces[30] = {2, 3, 6, 6, 3, 7, 0, 2, 4, 4,
                                     2, 6, 1, 5, 3, 3, 5, 7, 0, 1,
                                     2, 2, 1, 3, 4, 6, 5, 5, 6, 7};
  uint32_t first = (uint32_t)m->position_count;
  for (uint32_t k = 0; k < 8; k++)
    m->positions[m->position_count++] = block_corner(b, k);
  for (int k = 0; k < 30; k++)
    m->position_index[3 * m->triangle_count + (size_t)k] = first + faces[k];
  m->triangle_count += 10;
}

// Ground from -1 to 19.
static vec3 ground_map(float u, float v, const float *shape) {
  (void)shape;
  return (vec3){20 * u - 1, 0, 20 * v - 1};
}

// A town of whole numbers on ground of 20 x 20 tiles.
static mesh town_mesh(arena *mem) {
  mesh m = mesh_room(mem, 8 * 64 + 21 * 21, 10 * 64 + 2 * 20 * 20);
  add_grid(&m, ground_map, NULL, 20, 20);
  for (uint32_t k = 0; k < 64; k++) {
    float x = 1 + 2 * (float)(k % 8), z = 1 + 2 * (float)(k / 8);
    float h = floorf(1 + 7 * scatter(k) * scatter(k + 64));
    const float b[6] = {x, 0,
                        z, x + (scatter(k + 128) < 0.3f ? 2.0f : 1.0f),
                        h, z + (scatter(k + 192) < 0.3f ? 2.0f : 1.0f)};
    add_block(&m, b);
  }
  return m;
}

// The town straight from above, 13 rays a unit: one of 13 lies in the planes
// where tiles and walls meet.
static void draw_lost(output *o) {
  mesh m = town_mesh(&o->mem);
  bvh b = tree_of(&m, BVH_SAH, o);
  image im = paper(&o->mem, 480, 236);
  wrong_tree wrong = {&b, MINMAX};
  tracer by[2] = {{.tree = &wrong, .closest = wrong_closest}, bvh_tracer(&b)};
  size_t lost = 0;
  for (int i = 0; i < 472 * 236; i++) {
    int side = i % 472 / 236, x = i % 236, y = i / 472;
    ray r = ray_from((vec3){(float)(x - 1) / 13, 20, (float)(y - 1) / 13},
                     (vec3){0, -1, 0});
    hit h;
    bool found = by[side].closest(by[side].tree, &r, &h);
    lost += !found;
    float high = found ? (20 - h.t) / 8 : 0;
    vec3 c = {0.2f + 0.7f * high, 0.24f + 0.6f * high, 0.16f + 0.6f * high};
    if (!found) c = RED;
    blend(im, 244 * side + x, y, c, 1);
  }
  publish(o->folder, "lost", im);
  printf("town: %zu of %d pixels lost by min and max\n", lost, 236 * 236);
}

// Rays at points of each edge of each triangle.
enum { EDGE_RAYS = 300 };

// From `eye` inside a ball about `at`, rays at points of all its edges, on a
// map of directions from the centre; those that find nothing are marked on
// it.  Returns how many; im may have no pixels.
static size_t draw_edges(image im, const mesh *m, tracer find, vec3 at,
                         vec3 eye) {
  size_t lost = 0;
  for (size_t i = 0; i < 3 * m->triangle_count; i++) {
    vec3 a = m->positions[m->position_index[i]];
    vec3 b = m->positions[m->position_index[i % 3 == 2 ? i - 2 : i + 1]];
    for (int k = 0; k < EDGE_RAYS; k++) {
      vec3 q = vec3_lerp(a, b, (float)k / EDGE_RAYS);
      ray r = ray_from(eye, vec3_sub(q, eye));
      hit h;
      bool found = find.closest(find.tree, &r, &h);
      vec3 d = vec3_unit(vec3_sub(q, at));
      int x = (int)(num_turns(d.z, d.x) * (float)im.width);
      int y = (int)(num_acos_pi(d.y) * (float)im.height);
      if (found)
        blend(im, x, y, GREY, 0.05f);
      else
        box_fill(im, x - 2, y - 2, 5, 5, RED);
      lost += !found;
    }
  }
  return lost;
}

// The same without a picture, for every style and facet's own.
static void count_leaks(const char *name, const mesh *m, const bvh *b,
                        const vec3 at_eye[2]) {
  static const char *const names[5] = {"min and max", "products", "bare",
                                       "factor", "margins"};
  printf("%s, rays at edges that are lost of %zu:", name,
         3 * m->triangle_count * (size_t)EDGE_RAYS);
  for (int k = 0; k < 5; k++) {
    wrong_tree w = {b, (slab_style)k};
    tracer by =
        k < 4 ? (tracer){.tree = &w, .closest = wrong_closest} : bvh_tracer(b);
    printf(" %s %zu", names[k],
           draw_edges((image){0}, m, by, at_eye[0], at_eye[1]));
  }
  printf("\n");
}

// A ball about the origin, and one of radius 100 about a point a million
// units away.
static void draw_leaks(output *o) {
  const vec3 far = {1000000, 1000000, 1000000}, eye = {0.13f, 0.21f, -0.08f};
  mesh m = mesh_room(&o->mem, 33 * 17, 2 * 32 * 16);
  const float ball[4] = {0, 0, 0, 1};
  add_grid(&m, sphere_map, ball, 32, 16);
  bvh b = tree_of(&m, BVH_SAH, o);
  count_leaks("ball", &m, &b, (vec3[2]){{0, 0, 0}, eye});
  image im = paper(&o->mem, 480, 240);
  wrong_tree bare = {&b, BARE};
  tracer by = {.tree = &bare, .closest = wrong_closest};
  draw_edges(im, &m, by, (vec3){0, 0, 0}, eye);
  publish(o->folder, "leaks", im);
  for (size_t i = 0; i < m.position_count; i++)
    m.positions[i] = vec3_mad(far, 100, m.positions[i]);
  b = tree_of(&m, BVH_SAH, o);
  count_leaks("ball far away", &m, &b, (vec3[2]){far, vec3_mad(far, 100, eye)});
}

// ---- Growth ----

// Seconds to build, the best of three.
static double build_time(const mesh *m, bvh_method method, pool *threads) {
  double best = 1e9;
  for (int k = 0; k < 3; k++) {
    arena mem = {0};
    bvh b;
    bvh_build(&b, m->positions, m->position_index, (uint32_t)m->triangle_count,
              method, &mem, threads);
    if (b.seconds < best) best = b.seconds;
    arena_free(&mem);
  }
  return best;
}

// The mean of nodes and triangles visited by random rays.
static double mean_visits(const bvh *b, const ray_set *s) {
  double sum = 0;
  for (size_t i = 0; i < s->count; i++) {
    hit h;
    bvh_visits v = {0};
    bvh_closest_counted(b, &s->rays[i], &h, &v);
    sum += (double)v.nodes + (double)v.triangles;
  }
  return sum / (double)s->count;
}

static float log10_of(double x) {
  return num_log2((float)x) * 0.30103f;
}

static void draw_growth(output *o) {
  image im = paper(&o->mem, 480, 320);
  plot p = {im, 56, 10, 406, 266, 3, 6, 1, 6};
  vec2 before[3] = {{0}};
  static const char *const names[3] = {"EACH TRIANGLE", "MIDDLE", "SAH"};
  plot_frame(&p);
  for (int step = 0; step < 7; step++) {
    arena mem = {0};
    mesh m = garden_mesh(&mem, 8 << step);
    output scratch = {o->folder, {0}, o->threads};
    bvh sah = tree_of(&m, BVH_SAH, &scratch);
    bvh middle = tree_of(&m, BVH_MEDIAN, &scratch);
    ray_set s;
    ray_source from = {.m = &m, .tree = bvh_tracer(&sah), .limit = 4000};
    rays_generate(&s, RAYS_RANDOM, &from, &mem);
    double y[3] = {(double)m.triangle_count, mean_visits(&middle, &s),
                   mean_visits(&sah, &s)};
    printf("garden of %zu: middle %.1f, SAH %.1f\n", m.triangle_count, y[1],
           y[2]);
    for (int k = 0; k < 3; k++) {
      static const vec3 inks[3] = {
          {0.45f, 0.45f, 0.45f}, {0.85f, 0.25f, 0}, {0.75f, 0.03f, 0.02f}};
      vec2 at = {log10_of(y[0]), log10_of(y[k])};
      if (step > 0) plot_line(&p, before[k], at, inks[k]);
      plot_dot(&p, at.x, at.y, 2, inks[k]);
      before[k] = at;
      vec2 on = plot_at(&p, at.x, at.y);
      if (step == 6)
        text(im, (int)on.x - text_width(names[k]) - (k == 0 ? 40 : 0),
             (int)on.y + (k == 1 ? -18 : 8), inks[k], names[k]);
    }
    if (step == 6)
      printf("its build: %.3f s with 1 thread, %.3f s with %d\n",
             build_time(&m, BVH_SAH, NULL), build_time(&m, BVH_SAH, o->threads),
             pool_threads(o->threads));
    arena_free(&scratch.mem);
    arena_free(&mem);
  }
  for (int k = 3; k <= 6; k++)
    plot_tick(&p, true, (float)k, arena_format(&o->mem, "1E%d", k));
  for (int k = 1; k <= 6; k++)
    plot_tick(&p, false, (float)k, arena_format(&o->mem, "1E%d", k));
  text(im, 200, 303, INK, "TRIANGLES");
  text(im, 62, 12, INK, "VISITS A RAY");
  publish(o->folder, "growth", im);
}

// ---- The table ----

// The methods side by side, then rays a second by kind.
static void print_table(output *o, const mesh *m) {
  static const struct {
    const char *name;
    bvh_method method;
  } ways[4] = {{"middle", BVH_MEDIAN},
               {"SAH, 8 slices", BVH_SAH_8},
               {"SAH, 16 slices", BVH_SAH_16},
               {"SAH, 32 slices", BVH_SAH}};
  printf("%zu triangles; build seconds with 1 and %d threads, cost, million "
         "rays a second\n",
         m->triangle_count, pool_threads(o->threads));
  printf("%-15s %7s %7s %6s", "", "1", "all", "cost");
  for (int k = 0; k < RAYS_KINDS; k++)
    printf(" %8s", rays_kind_name((ray_kind)k));
  printf("\n");
  double list = 0;
  for (int w = 0; w < 4; w++) {
    arena mem = {0};
    bvh b = tree_of(m, ways[w].method, o);
    printf("%-15s %7.3f %7.3f %6.1f", ways[w].name,
           build_time(m, ways[w].method, NULL),
           build_time(m, ways[w].method, o->threads), b.cost);
    for (int k = 0; k < RAYS_KINDS; k++) {
      ray_set s;
      ray_source from = {m, bvh_tracer(&b), o->threads, 256, 1 << 16};
      rays_generate(&s, (ray_kind)k, &from, &mem);
      hit *hits = ARENA_NEW(&mem, hit, s.count);
      double t = rays_trace(hits, &s, bvh_tracer(&b), NULL, 3);
      printf(" %8.3f", (double)s.count / t * 1e-6);
      if (w < 3 || k > 0) continue;
      // The list is asked 40 rays of the primary ones.
      s.rays += s.count / 2;
      s.count = 40;
      t = rays_trace(hits, &s, brute_tracer(&b), NULL, 1);
      list = (double)s.count / t * 1e-6;
    }
    printf("\n");
    arena_free(&mem);
  }
  printf("the list, primary: %.6f\n", list);
}

int main(int argc, char **argv) {
  if (argc != 2) return fprintf(stderr, "usage: %s FOLDER\n", argv[0]), 2;
  output o = {.folder = argv[1]};
  o.threads = pool_new(&o.mem, pool_default_threads());
  draw_levels(&o);
  draw_cost(&o);
  mesh garden = garden_mesh(&o.mem, 256);
  bvh b = tree_of(&garden, BVH_SAH, &o);
  draw_heats(&o, &garden, &b);
  draw_lost(&o);
  draw_leaks(&o);
  draw_growth(&o);
  print_table(&o, &garden);
  pool_free(o.threads);
  arena_free(&o.mem);
  return 0;
}

// figures.c — the pictures of chapter 2, and the numbers its text quotes.

#include "../easel.h"
#include "mtl.h"
#include "normals.h"
#include "number.h"
#include "obj.h"
#include "polygon.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Where the pictures go.
typedef struct output {
  const char *folder;
  arena mem;
} output;

static void blend_pixel(image im, int x, int y, vec3 color, float alpha) {
  if (x < 0 || y < 0 || x >= im.width || y >= im.height || alpha <= 0) return;
  vec3 *p = &im.pixels[y * im.width + x];
  *p = vec3_lerp(*p, color, fminf(alpha, 1));
}

// A line of the given width in pixels; coverage falls off over one pixel.
static void draw_line(image im, vec2 a, vec2 b, float width, vec3 color,
                      float alpha) {
  float dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  int x0 = (int)floorf(fminf(a.x, b.x) - width - 1);
  int x1 = (int)ceilf(fmaxf(a.x, b.x) + width + 1);
  int y0 = (int)floorf(fminf(a.y, b.y) - width - 1);
  int y1 = (int)ceilf(fmaxf(a.y, b.y) + width + 1);
  for (int y = y0; y <= y1; y++)
    for (int x = x0; x <= x1; x++) {
      float px = (float)x + 0.5f - a.x, py = (float)y + 0.5f - a.y;
      float t = length2 > 0 ? (px * dx + py * dy) / length2 : 0;
      t = fminf(fmaxf(t, 0), 1);
      float d = hypotf(px - t * dx, py - t * dy);
      blend_pixel(im, x, y, color, alpha * (width / 2 + 0.5f - d));
    }
}

// Twice the signed area.
static float side(vec2 a, vec2 b, vec2 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// A filled triangle, 4 x 4 samples a pixel.
static void draw_triangle(image im, const vec2 t[3], vec3 color, float alpha) {
  float turn = side(t[0], t[1], t[2]) < 0 ? -1.0f : 1.0f;
  int x0 = (int)floorf(fminf(t[0].x, fminf(t[1].x, t[2].x)));
  int x1 = (int)ceilf(fmaxf(t[0].x, fmaxf(t[1].x, t[2].x)));
  int y0 = (int)floorf(fminf(t[0].y, fminf(t[1].y, t[2].y)));
  int y1 = (int)ceilf(fmaxf(t[0].y, fmaxf(t[1].y, t[2].y)));
  for (int y = y0; y <= y1; y++)
    for (int x = x0; x <= x1; x++) {
      int hits = 0;
      for (int k = 0; k < 16; k++) {
        vec2 p = {(float)x + 0.125f + 0.25f * (float)(k % 4),
                  (float)y + 0.125f + 0.25f * (float)(k / 4)};
        hits += turn * side(t[0], t[1], p) >= 0 &&
                turn * side(t[1], t[2], p) >= 0 &&
                turn * side(t[2], t[0], p) >= 0;
      }
      blend_pixel(im, x, y, color, alpha * (float)hits / 16);
    }
}

// Text that grows: an OBJ file in the making.
typedef struct writer {
  char *text;
  size_t length, room;
} writer;

static void add_text(writer *w, const char *line) {
  size_t n = strlen(line);
  w->text = array_grow(w->text, &w->room, w->length + n + 1, 1);
  memcpy(w->text + w->length, line, n + 1);
  w->length += n;
}

#define ADD(w, ...) \
  do { \
    char line_[512]; \
    snprintf(line_, sizeof line_, __VA_ARGS__); \
    add_text((w), line_); \
  } while (0)

// The goblet's outline from the foot to the bottom of the bowl, with what
// comes before the faces up to each point.
static const struct {
  double radius, height;
  const char *before;
} OUTLINE[] = {
    {0.74, 0.14, ""},
    {0.70, 0.22, "usemtl brass\ns 1\n"},
    {0.30, 0.30, ""},
    {0.13, 0.46, ""},
    {0.10, 0.72, ""},
    {0.20, 0.80, "s 2\n"},
    {0.23, 0.88, ""},
    {0.20, 0.96, ""},
    {0.10, 1.04, ""},
    {0.14, 1.14, "usemtl blue glass\ns 3\n"},
    {0.42, 1.28, ""},
    {0.62, 1.55, ""},
    {0.70, 1.90, ""},
    {0.72, 2.25, ""},
    {0.64, 2.25, "usemtl brass\ns 4\n"},
    {0.62, 1.92, "usemtl blue glass\ns 5\n"},
    {0.54, 1.62, ""},
    {0.36, 1.40, ""},
    {0.04, 1.30, ""},
};

enum {
  OUTLINE_POINTS = sizeof OUTLINE / sizeof OUTLINE[0],
  AROUND = 28,
  STAR = 20  // corners of the plate
};

// A plate in the form of a star, of two concave polygons and a rim of quads.
static void add_plate(writer *w) {
  add_text(w, "o plate\nusemtl slate\ns off\n");
  for (int level = 0; level < 2; level++)
    for (int i = 0; i < STAR; i++) {
      double a = 6.283185307179586 * i / STAR, r = i % 2 == 0 ? 1.3 : 0.95;
      ADD(w, "v %.4f %.4f %.4f\n", r * cos(a), 0.14 * level, -r * sin(a));
    }
  add_text(w, "f");
  for (int i = 0; i < STAR; i++)
    ADD(w, " %d", STAR + i + 1);
  add_text(w, "\nf");
  for (int i = STAR; i > 0; i--)
    ADD(w, " %d", i);
  add_text(w, "\n");
  for (int i = 0; i < STAR; i++) {
    int j = (i + 1) % STAR;
    ADD(w, "f %d %d %d %d\n", i + 1, j + 1, j + 1 + STAR, i + 1 + STAR);
  }
}

// A goblet on a plate, as a modeller would write it: rings of vertices, and
// after each ring the quads to the one before, in negative indices.
static writer goblet(void) {
  writer w = {0};
  add_text(&w, "mtllib goblet.mtl\n");
  add_plate(&w);
  add_text(&w, "o goblet\n");
  for (int k = 0; k < OUTLINE_POINTS; k++) {
    add_text(&w, OUTLINE[k].before);
    for (int i = 0; i < AROUND; i++) {
      double a = 6.283185307179586 * i / AROUND;
      ADD(&w, "v %.4f %.4f %.4f\n", OUTLINE[k].radius * cos(a),
          OUTLINE[k].height, -OUTLINE[k].radius * sin(a));
    }
    for (int i = 0; k > 0 && i < AROUND; i++) {
      int a = i - AROUND, b = (i + 1) % AROUND - AROUND;
      ADD(&w, "f %d %d %d %d\n", a - AROUND, b - AROUND, b, a);
    }
  }
  return w;
}

static const char GOBLET_MTL[] =
    "newmtl slate\nKd .13 .14 .17\nnewmtl brass\nKd .76 .50 .12\n"
    "newmtl blue glass\nKd .10 .28 .55\n";

static mesh read_writer(const writer *w, arena *mem) {
  mesh m;
  error err;
  obj_request q = {.path = "goblet.obj", .text = {w->text, w->length}};
  if (obj_read_request(&m, &q, mem, NULL, &err)) return m;
  fprintf(stderr, "%s\n", err.text);
  exit(3);
}

// An orthographic view: turned about the vertical, then tilted.  x and y in
// pixels, z towards the eye.
typedef struct view {
  float scale, x, y;  // pixels a unit; where the origin goes
} view;

static vec3 rotate(vec3 p) {
  const float ca = 0.9211f, sa = 0.3894f, ct = 0.8525f, st = 0.5227f;
  vec3 q = {ca * p.x + sa * p.z, p.y, -sa * p.x + ca * p.z};
  return (vec3){q.x, ct * q.y - st * q.z, st * q.y + ct * q.z};
}

static vec3 project(view v, vec3 p) {
  vec3 q = rotate(p);
  return (vec3){v.x + v.scale * q.x, v.y - v.scale * q.y, q.z};
}

// The edges of the triangles; those that turn away are faint.
static void draw_wires(image im, const mesh *m, view v) {
  for (int front = 0; front < 2; front++)
    for (size_t t = 0; t < m->triangle_count; t++) {
      vec3 p[3];
      for (int k = 0; k < 3; k++)
        p[k] = project(v, m->positions[m->position_index[3 * t + (size_t)k]]);
      vec2 q[3] = {{p[0].x, p[0].y}, {p[1].x, p[1].y}, {p[2].x, p[2].y}};
      if ((side(q[0], q[1], q[2]) < 0) != (front == 1)) continue;
      vec3 ink = front ? (vec3){0.02f, 0.05f, 0.15f} : vec3_all(0.55f);
      for (int k = 0; k < 3; k++)
        draw_line(im, q[k], q[(k + 1) % 3], 0.9f, ink, front ? 0.8f : 0.25f);
    }
}

// What a shaded picture needs.
typedef struct shading {
  const mesh *m;
  const vec3 *colors;  // of each triangle
  view v;
} shading;

// The light of a corner: from the left above, with some from everywhere.
static float corner_light(const mesh *m, size_t corner, vec3 flat_normal) {
  vec3 n = flat_normal;
  if (m->normal_index != NULL && m->normal_index[corner] != MESH_NONE)
    n = rotate(m->normals[m->normal_index[corner]]);
  if (n.z < 0) n = vec3_neg(n);
  float d = vec3_dot(n, vec3_unit((vec3){-0.5f, 0.6f, 0.7f}));
  return 0.18f + 0.9f * fmaxf(d, 0);
}

// Fill the picture with the nearest triangle of each sample, 3 x 3 a pixel.
static void draw_shaded(output *o, image im, const shading *s) {
  int w = 3 * im.width, h = 3 * im.height;
  image big = paper(&o->mem, w, h);
  float *depth = ARENA_NEW(&o->mem, float, (size_t)(w * h));
  for (int i = 0; i < w * h; i++)
    depth[i] = -INFINITY;
  view v = {3 * s->v.scale, 3 * s->v.x, 3 * s->v.y};
  for (size_t t = 0; t < s->m->triangle_count; t++) {
    vec3 p[3], r[3];
    float light[3];
    for (int k = 0; k < 3; k++) {
      vec3 at = s->m->positions[s->m->position_index[3 * t + (size_t)k]];
      p[k] = project(v, at);
      r[k] = rotate(at);
    }
    vec3 flat =
        vec3_unit(vec3_cross(vec3_sub(r[1], r[0]), vec3_sub(r[2], r[0])));
    for (int k = 0; k < 3; k++)
      light[k] = corner_light(s->m, 3 * t + (size_t)k, flat);
    vec2 q[3] = {{p[0].x, p[0].y}, {p[1].x, p[1].y}, {p[2].x, p[2].y}};
    float area = side(q[0], q[1], q[2]);
    if (area == 0) continue;
    int x0 = (int)fmaxf(0, floorf(fminf(q[0].x, fminf(q[1].x, q[2].x))));
    int x1 = (int)fminf((float)w - 1, fmaxf(q[0].x, fmaxf(q[1].x, q[2].x)));
    int y0 = (int)fmaxf(0, floorf(fminf(q[0].y, fminf(q[1].y, q[2].y))));
    int y1 = (int)fminf((float)h - 1, fmaxf(q[0].y, fmaxf(q[1].y, q[2].y)));
    for (int y = y0; y <= y1; y++)
      for (int x = x0; x <= x1; x++) {
        vec2 c = {(float)x + 0.5f, (float)y + 0.5f};
        float b0 = side(q[1], q[2], c) / area, b1 = side(q[2], q[0], c) / area;
        float b2 = 1 - b0 - b1;
        if (b0 < 0 || b1 < 0 || b2 < 0) continue;
        float z = b0 * p[0].z + b1 * p[1].z + b2 * p[2].z;
        if (z <= depth[y * w + x]) continue;
        depth[y * w + x] = z;
        big.pixels[y * w + x] = vec3_scale(
            s->colors[t], b0 * light[0] + b1 * light[1] + b2 * light[2]);
      }
  }
  for (int i = 0; i < im.width * im.height; i++) {
    vec3 sum = {0, 0, 0};
    for (int k = 0; k < 9; k++)
      sum = vec3_add(sum, big.pixels[(i / im.width * 3 + k / 3) * w +
                                     i % im.width * 3 + k % 3]);
    im.pixels[i] = vec3_scale(sum, 1.0f / 9);
  }
}

// Each triangle's colour: its material's Kd.
static vec3 *material_colors(const mesh *m, arena *mem) {
  mtl_library lib = {0};
  error err;
  span text = {GOBLET_MTL, sizeof GOBLET_MTL - 1};
  if (!mtl_read_text(&lib, text, "goblet.mtl", mem, NULL, &err)) exit(3);
  vec3 *colors = ARENA_NEW(mem, vec3, m->triangle_count);
  for (size_t r = 0; r < m->run_count; r++) {
    long i = mtl_find(&lib, m->material_names[m->runs[r].material]);
    for (uint32_t t = 0; t < m->runs[r].count; t++)
      colors[m->runs[r].first + t] = lib.materials[i].kd;
  }
  return colors;
}

// The goblet as wires and as surfaces in the colours of its materials.
static void picture_of_goblet(output *o, const writer *w) {
  mesh m = read_writer(w, &o->mem);
  image left = paper(&o->mem, 236, 270), right = paper(&o->mem, 236, 270);
  view v = {84, 118, 200};
  draw_wires(left, &m, v);
  normals_generate(&m, NORMALS_AUTO, 180, &o->mem, NULL);
  shading s = {&m, material_colors(&m, &o->mem), v};
  draw_shaded(o, right, &s);
  image sheet = paper(&o->mem, 480, 270);
  paste(sheet, left, 0, 0);
  paste(sheet, right, 244, 0);
  publish(o->folder, "goblet", sheet);
  printf("goblet: %zu bytes, %zu positions, %zu faces, %zu triangles, area "
         "%.4f, %zu runs\n",
         w->length, m.position_count, m.face_count, m.triangle_count,
         mesh_area(&m), m.run_count);
}

// Flat, by smoothing groups, and everything smooth.
static void picture_of_normals(output *o, const writer *w) {
  static const normals_mode MODES[3] = {NORMALS_FLAT, NORMALS_AUTO,
                                        NORMALS_SMOOTH};
  image sheet = paper(&o->mem, 474, 190);
  for (int k = 0; k < 3; k++) {
    mesh m = read_writer(w, &o->mem);
    normals_generate(&m, MODES[k], 180, &o->mem, NULL);
    vec3 *grey = ARENA_NEW(&o->mem, vec3, m.triangle_count);
    for (size_t t = 0; t < m.triangle_count; t++)
      grey[t] = vec3_all(0.75f);
    image pane = paper(&o->mem, 154, 190);
    shading s = {&m, grey, {56, 77, 142}};
    draw_shaded(o, pane, &s);
    paste(sheet, pane, 160 * k, 0);
    printf("normals, mode %d: %zu\n", (int)MODES[k], m.normal_count);
  }
  publish(o->folder, "normals", sheet);
}

// The same text when a reader resolves negative indices at its end, against
// all vertices, and when it does so at the line where they stand.
static void picture_of_indices(output *o, const writer *w) {
  mesh m = read_writer(w, &o->mem), wrong = m;
  size_t corners = 3 * m.triangle_count;
  wrong.position_index = ARENA_NEW(&o->mem, uint32_t, corners);
  memcpy(wrong.position_index, m.position_index, corners * sizeof(uint32_t));
  // Faces of ring k were written when rings 0..k were there: at the end the
  // same numbers reach back from the last ring.
  for (size_t c = 0; c < corners; c++) {
    uint32_t p = m.position_index[c];
    if (p < 2 * STAR) continue;
    size_t t = c / 3 * 3;
    uint32_t top = 0;
    for (size_t k = 0; k < 3; k++)
      if (m.position_index[t + k] > top) top = m.position_index[t + k];
    uint32_t ring = (top - 2 * STAR) / AROUND;
    wrong.position_index[c] = p + (OUTLINE_POINTS - 1 - ring) * AROUND;
  }
  image sheet = paper(&o->mem, 320, 190), pane = paper(&o->mem, 154, 190);
  view v = {56, 77, 142};
  draw_wires(pane, &wrong, v);
  paste(sheet, pane, 0, 0);
  pane = paper(&o->mem, 154, 190);
  draw_wires(pane, &m, v);
  paste(sheet, pane, 160, 0);
  publish(o->folder, "indices", sheet);
}

// A concave outline of 18 corners, a key.
static const vec3 KEY[] = {{0, 2, 0},       {1, 0.6f, 0},    {3, 0.4f, 0},
                           {4, 1.4f, 0},    {8, 1.4f, 0},    {8, 0.2f, 0},
                           {8.7f, 0.2f, 0}, {8.7f, 1.4f, 0}, {9.4f, 1.4f, 0},
                           {9.4f, 0.5f, 0}, {10, 0.5f, 0},   {10, 2.4f, 0},
                           {4, 2.4f, 0},    {3.2f, 3.6f, 0}, {2.4f, 3.2f, 0},
                           {3, 2.2f, 0},    {2, 1.4f, 0},    {1, 3.4f, 0}};

enum { KEY_CORNERS = sizeof KEY / sizeof KEY[0] };

static vec2 key_point(uint32_t i, float scale, float x, float y) {
  return (vec2){x + scale * KEY[i].x, y - scale * KEY[i].y};
}

static void draw_key_outline(image im, float scale, float x, float y) {
  for (uint32_t i = 0; i < KEY_CORNERS; i++)
    draw_line(im, key_point(i, scale, x, y),
              key_point((i + 1) % KEY_CORNERS, scale, x, y), 1.4f,
              (vec3){0.02f, 0.05f, 0.15f}, 1);
}

// Draw triangles [0, n) of the key in shades that tell their order.
static void draw_key(image im, const uint32_t *cut, size_t n, vec3 place) {
  float s = place.z, x = place.x, y = place.y;
  for (size_t i = 0; i < n; i++) {
    vec2 t[3];
    for (int k = 0; k < 3; k++)
      t[k] = key_point(cut[3 * i + (size_t)k], s, x, y);
    float f = (float)i / (KEY_CORNERS - 3);
    vec3 color =
        vec3_lerp((vec3){0.95f, 0.55f, 0.1f}, (vec3){0.1f, 0.35f, 0.75f}, f);
    draw_triangle(im, t, color, 0.55f);
    for (int k = 0; k < 3; k++)
      draw_line(im, t[k], t[(k + 1) % 3], 0.8f, vec3_all(0.1f), 0.5f);
  }
  draw_key_outline(im, s, x, y);
}

static double cut_area(const uint32_t *cut) {
  mesh m = {.positions = (vec3[KEY_CORNERS]){{0, 0, 0}},
            .triangle_count = KEY_CORNERS - 2};
  uint32_t index[3 * KEY_CORNERS];
  memcpy(m.positions, KEY, sizeof KEY);
  memcpy(index, cut, 3 * m.triangle_count * sizeof *cut);
  m.position_index = index;
  return mesh_area(&m);
}

// Ears one after the other; and the fan beside the ears.
static void pictures_of_ears(output *o) {
  uint32_t ears[3 * KEY_CORNERS], fan[3 * KEY_CORNERS];
  arena scratch = {0};
  bool clean = polygon_triangulate(KEY, KEY_CORNERS, ears, &scratch);
  arena_free(&scratch);
  for (uint32_t i = 0; i + 2 < KEY_CORNERS; i++)
    fan[3 * i] = 0, fan[3 * i + 1] = i + 1, fan[3 * i + 2] = i + 2;
  image sheet = paper(&o->mem, 476, 160);
  static const size_t STEPS[6] = {1, 3, 6, 9, 13, 16};
  for (int k = 0; k < 6; k++)
    draw_key(sheet, ears, STEPS[k],
             (vec3){6 + 158 * (float)(k % 3), 68 + 84 * (float)(k / 3), 14.6f});
  publish(o->folder, "ears", sheet);
  sheet = paper(&o->mem, 476, 104);
  draw_key(sheet, fan, KEY_CORNERS - 2, (vec3){8, 94, 22});
  draw_key(sheet, ears, KEY_CORNERS - 2, (vec3){246, 94, 22});
  publish(o->folder, "fan", sheet);
  double newell[3];
  polygon_newell(KEY, KEY_CORNERS, newell);
  printf("key: area %.4f, as a fan %.4f, by ears %.4f, clean %d\n",
         newell[2] / 2, cut_area(fan), cut_area(ears), clean);
}

// The way a float is often read: digit by digit in float arithmetic.
static float naive_float(const char *p) {
  float value = 0, scale = 1;
  for (; *p >= '0' && *p <= '9'; p++)
    value = value * 10 + (float)(*p - '0');
  if (*p == '.')
    for (p++; *p >= '0' && *p <= '9'; p++) {
      scale *= 0.1f;
      value += scale * (float)(*p - '0');
    }
  return value;
}

// A better one: digits in a double, one division, one rounding to float.
static float better_float(const char *p) {
  double value = 0, scale = 1;
  for (; *p >= '0' && *p <= '9'; p++)
    value = value * 10 + (*p - '0');
  if (*p == '.')
    for (p++; *p >= '0' && *p <= '9'; p++) {
      value = value * 10 + (*p - '0');
      scale *= 10;
    }
  return (float)(value / scale);
}

static float our_float(const char *p) {
  float value = 0;
  number_float(p, p + strlen(p), &value);
  return value;
}

static int ulps_apart(float a, float b) {
  int32_t i, j;
  memcpy(&i, &a, sizeof i);
  memcpy(&j, &b, sizeof j);
  return abs(i - j);
}

// How many of n decimals 0.dddd of the given length a reader gets wrong, and
// by how much at most.
static void count_wrong(const char *name, float (*read)(const char *),
                        int digits, int n) {
  uint64_t s = 88172645463325252u;
  int wrong = 0, worst = 0;
  for (int i = 0; i < n; i++) {
    char text[64] = "0.";
    for (int k = 0; k < digits; k++) {
      s ^= s << 13;
      s ^= s >> 7;
      s ^= s << 17;
      text[2 + k] = (char)('0' + s % 10);
    }
    int off = ulps_apart(read(text), strtof(text, NULL));
    wrong += off != 0;
    if (off > worst) worst = off;
  }
  printf("%s, %d decimals: %d of %d wrong, by up to %d units\n", name, digits,
         wrong, n, worst);
}

// One pixel per decimal 0.000000 .. 0.099999 in rows: white right, orange one
// unit in the last place off, dark more.
static void picture_of_numbers(output *o) {
  image im = paper(&o->mem, 400, 250);
  for (int i = 0; i < im.width * im.height; i++) {
    char text[16];
    snprintf(text, sizeof text, "0.%06d", i);
    int off = ulps_apart(naive_float(text), strtof(text, NULL));
    if (off == 1) im.pixels[i] = (vec3){0.95f, 0.45f, 0.05f};
    if (off > 1) im.pixels[i] = (vec3){0.25f, 0.02f, 0.05f};
  }
  publish(o->folder, "numbers", im);
  static const int DIGITS[] = {3, 6, 9, 16, 20};
  for (int k = 0; k < 5; k++) {
    count_wrong("float by digits", naive_float, DIGITS[k], 1000000);
    count_wrong("double by digits", better_float, DIGITS[k], 1000000);
    count_wrong("number_float", our_float, DIGITS[k], 1000000);
  }
  static const char BAD[] = "1.00000017881393432617187500000000001";
  printf("double, one digit behind a midpoint: %d\n",
         ulps_apart(better_float(BAD), our_float(BAD)));
}

int main(int argc, char **argv) {
  if (argc != 2) return 2;
  output o = {argv[1], {0}};
  writer w = goblet();
  picture_of_goblet(&o, &w);
  picture_of_normals(&o, &w);
  picture_of_indices(&o, &w);
  pictures_of_ears(&o);
  picture_of_numbers(&o);
  array_free(w.text);
  arena_free(&o.mem);
  return 0;
}

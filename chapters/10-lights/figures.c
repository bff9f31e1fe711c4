// figures.c — the pictures of chapter 10, and the numbers that its text quotes.

#include "../tripod.h"
#include "aim_learn.h"
#include "bvh.h"
#include "clock.h"
#include "light_emission.h"
#include "metric.h"
#include "num.h"
#include "render.h"
#include "share_learn.h"
#include "vertex.h"

#include <stdio.h>
#include <stdlib.h>

// Where the pictures go, and who computes them.
typedef struct output {
  const char *folder;
  arena mem;
  pool *threads;
} output;

static const vec3 RED = {0.8f, 0.05f, 0.02f}, GREY = {0.35f, 0.35f, 0.35f};

static void draw_dot(image *im, float x, float y, int size, vec3 color) {
  for (int i = 0; i < size * size; i++) {
    int px = (int)x + i % size - size / 2, py = (int)y + i / size - size / 2;
    if (px >= 0 && px < im->width && py >= 0 && py < im->height)
      *pixel(*im, px, py) = color;
  }
}

// 256 points of two dimensions, the first 64 in red: random ones, Sobol's, and
// those scrambled.
static void draw_points(output *o) {
  enum { SIDE = 157, POINTS = 256 };
  image parts[3];
  for (int k = 0; k < 3; k++) {
    parts[k] = paper(&o->mem, SIDE, SIDE);
    for (int i = 0; i <= 16; i++) {
      float x = (SIDE - 1) * (float)i / 16;
      vec3 c = vec3_all(i % 2 ? 0.9f : 0.75f);
      draw_thin_line(parts[k], (vec2){x, 0}, (vec2){x, SIDE}, c);
      draw_thin_line(parts[k], (vec2){0, x}, (vec2){SIDE, x}, c);
    }
    for (uint32_t i = POINTS; i-- > 0;) {
      sampler s = sampler_of(k == 0 ? SAMPLER_RANDOM : SAMPLER_SOBOL, 1, 2, i);
      vec2 p = {sobol_number(sobol_digits(i, 0)),
                sobol_number(sobol_digits(i, 1))};
      if (k != 1) p = sampler_2(&s);
      draw_dot(&parts[k], p.x * (SIDE - 1), p.y * (SIDE - 1), 3,
               i < 64 ? RED : GREY);
    }
  }
  image all = row_of(&o->mem, parts, 3);
  publish(o->folder, "points", all);
}

// The disc onto which the directions of a matt surface fall, and the first four
// of a pixel, the first two in red.
static image draw_directions(output *o, sampler_kind kind, uint64_t pixel) {
  enum { SIDE = 112, RADIUS = 50, EDGES = 90 };
  image im = paper(&o->mem, SIDE, SIDE);
  vec2 last = {SIDE / 2 + RADIUS, SIDE / 2};
  for (int i = 1; i <= EDGES; i++) {
    float turn = 6.2831853f * (float)i / EDGES;
    vec2 p = {SIDE / 2 + RADIUS * cosf(turn), SIDE / 2 + RADIUS * sinf(turn)};
    draw_thin_line(im, last, p, vec3_all(0.6f));
    last = p;
  }
  for (uint32_t i = 4; i-- > 0;) {
    sampler s = sampler_of(kind, 1, pixel, i);
    sampler_at(&s, 2);
    vec2 u = sampler_2(&s);
    float turn = 6.2831853f * u.x, r = RADIUS * sqrtf(u.y);
    vec2 p = {SIDE / 2 + r * cosf(turn), SIDE / 2 + r * sinf(turn)};
    vec2 middle = {SIDE / 2, SIDE / 2};
    draw_thin_line(im, middle, p, i < 2 ? RED : GREY);
    draw_dot(&im, p.x, p.y, 5, i < 2 ? RED : GREY);
  }
  return im;
}

// Those of four pixels: even ones, and turned ones.
static void draw_turns(output *o) {
  image rows[2];
  for (int k = 0; k < 2; k++) {
    image parts[4];
    for (uint64_t i = 0; i < 4; i++)
      parts[i] = draw_directions(o, k ? SAMPLER_TURNED : SAMPLER_SOBOL, 3 + i);
    rows[k] = row_of(&o->mem, parts, 4);
  }
  image all = paper(&o->mem, rows[0].width, 2 * rows[0].height);
  paste(all, rows[0], 0, 0);
  paste(all, rows[1], 0, rows[0].height);
  publish(o->folder, "turns", all);
}

// One of the integrals of the plot: a pixel with an edge through it, or the
// same times a lamp.
typedef struct integral {
  const char *name;
  sampler_kind kind;
  bool plain;  // not scrambled
  bool lamp;
  uint32_t dimension;  // of the lamp
  vec3 color;
} integral;

static vec2 numbers_at(const integral *of, sampler *s, uint32_t dimension) {
  sampler_at(s, dimension);
  if (!of->plain) return sampler_2(s);
  return (vec2){sobol_number(sobol_digits(s->index, dimension)),
                sobol_number(sobol_digits(s->index, dimension + 1))};
}

// The mean squared error of 2^bits samples over many pixels, each with an edge
// of its own from the left side to the right.
static double error_of(const integral *of, int bits) {
  enum { PIXELS = 1500 };
  double squares = 0;
  for (uint64_t p = 0; p < PIXELS; p++) {
    rng r = rng_of(1, p, (uint64_t)bits);
    float left = rng_next(&r), right = rng_next(&r);
    double got = 0, want = 0.5 * (double)(left + right) * (of->lamp ? 0.5 : 1);
    for (uint32_t i = 0; i < 1u << bits; i++) {
      sampler s = sampler_of(of->kind, 2, p, i);
      vec2 at = numbers_at(of, &s, 0);
      double x = at.y < left + (right - left) * at.x;
      vec2 u = numbers_at(of, &s, of->dimension);
      if (of->lamp) x *= 2 * (double)u.x * (double)u.y;
      got += x;
    }
    got /= (double)(1u << bits);
    squares += (got - want) * (got - want);
  }
  return squares / PIXELS;
}

// Both axes logarithmic: samples from 1 to 4096, a line for every factor of 4;
// error down, a line for every factor of 16.
static void draw_slopes(output *o) {
  enum { FIELD = 56, COLUMNS = 6, ROWS = 6, STEPS = 7 };
  const integral ALL[] = {
      {.name = "random", .kind = SAMPLER_RANDOM, .color = {0, 0, 0}},
      {.name = "edge, not scrambled", .plain = true, .color = {0.9f, 0.5f, 0}},
      {.name = "edge", .color = RED},
      {.name = "edge and lamp",
       .lamp = true,
       .dimension = 4,
       .color = {0.02f, 0.15f, 0.7f}},
      {.name = "edge and lamp of a later block",
       .lamp = true,
       .dimension = 12,
       .color = {0.02f, 0.4f, 0.08f}}};
  image im = paper(&o->mem, FIELD * COLUMNS + 1, FIELD * ROWS * 3 / 4 + 1);
  for (int i = 0; i <= COLUMNS; i++) {
    float x = (float)(i * FIELD), y = (float)(i * FIELD * 3 / 4);
    draw_thin_line(im, (vec2){x, 0}, (vec2){x, 999}, vec3_all(0.8f));
    draw_thin_line(im, (vec2){0, y}, (vec2){999, y}, vec3_all(0.8f));
  }
  for (size_t k = 0; k < sizeof ALL / sizeof *ALL; k++) {
    vec2 last = {0, 0};
    double e[STEPS];
    printf("%-31s", ALL[k].name);
    for (int i = 0; i < STEPS; i++) {
      e[i] = error_of(&ALL[k], 2 * i);
      printf(" %.1e", e[i]);
      float down = -log2f((float)e[i]) / 4 * FIELD * 3 / 4;
      vec2 at = {(float)(i * FIELD), down};
      if (i > 0) draw_thin_line(im, last, at, ALL[k].color);
      draw_dot(&im, at.x, at.y, 5, ALL[k].color);
      last = at;
    }
    printf("  slope %.2f\n", log2(e[STEPS - 1] / e[2]) / (2 * (STEPS - 3)));
  }
  publish(o->folder, "slopes", im);
}

// A scene with its tree and its lights.
typedef struct stage {
  scene scene;
  bvh tree;
  light_set lights;
  path_world world;
} stage;

static void stage_ready(output *o, stage *s) {
  const mesh *m = &s->scene.mesh;
  bvh_build(&s->tree, m->positions, m->position_index,
            (uint32_t)m->triangle_count, BVH_SAH, &o->mem, o->threads);
  s->world = (path_world){
      .scene = &s->scene, .tracer = bvh_tracer(&s->tree), .lights = true};
  s->world.dfg = matter_table(&s->scene, PBR_GGX, &o->mem, o->threads);
  light_set_build(&s->lights, &s->scene, true, true, &o->mem, o->threads);
}

static stage *stage_load(output *o, const char *path, const char *sky) {
  stage *s = ARENA_NEW(&o->mem, stage, 1);
  open_scene(&s->scene, path, sky, &o->mem, o->threads);
  stage_ready(o, s);
  return s;
}

// Room for a scene that is made here.
static stage *stage_new(output *o, size_t triangles, size_t materials) {
  stage *s = ARENA_NEW(&o->mem, stage, 1);
  s->scene.mesh.positions = ARENA_NEW(&o->mem, vec3, 3 * triangles);
  s->scene.mesh.position_index = ARENA_NEW(&o->mem, uint32_t, 3 * triangles);
  s->scene.material_of = ARENA_NEW(&o->mem, uint32_t, triangles);
  s->scene.materials = ARENA_NEW(&o->mem, material, materials);
  s->scene.env = (env){.kind = ENV_NONE, .scale = 1};
  return s;
}

static uint32_t add_material(stage *s, vec3 kd, vec3 ke) {
  s->scene.materials[s->scene.material_count] =
      (material){.kd = kd, .ke = ke, .d = 1};
  return (uint32_t)s->scene.material_count++;
}

static void add_triangle(stage *s, vec3 a, vec3 b, vec3 c, uint32_t of) {
  mesh *m = &s->scene.mesh;
  const vec3 p[3] = {a, b, c};
  for (size_t i = 0; i < 3; i++) {
    m->position_index[3 * m->triangle_count + i] = (uint32_t)m->position_count;
    m->positions[m->position_count++] = p[i];
  }
  s->scene.material_of[m->triangle_count++] = of;
}

// The parallelogram p, p + u, p + u + v, p + v; front along u x v.
static void add_quad(stage *s, vec3 p, vec3 u, vec3 v, uint32_t of) {
  vec3 a = vec3_add(p, u), b = vec3_add(p, v), c = vec3_add(a, v);
  add_triangle(s, p, a, c, of);
  add_triangle(s, p, c, b, of);
}

// A box that shines or stands on the floor, seen from outside.
static void add_box(stage *s, vec3 lo, vec3 d, uint32_t of) {
  vec3 x = {d.x, 0, 0}, y = {0, d.y, 0}, z = {0, 0, d.z};
  add_quad(s, lo, y, x, of);
  add_quad(s, vec3_add(lo, z), x, y, of);
  add_quad(s, lo, z, y, of);
  add_quad(s, vec3_add(lo, x), y, z, of);
  add_quad(s, lo, x, z, of);
  add_quad(s, vec3_add(lo, y), z, x, of);
}

// How direct light is found; ways that are worse than facet's, too.
typedef enum strategy { BY_BOTH, BY_LIGHT, BY_SCATTERING } strategy;

typedef struct method {
  strategy by;
  bool any_light;  // each as likely as any other
  bool by_area;    // points of a triangle, from nearby too
  bool one_key;    // the same numbers in every pixel
  uint32_t spp;
} method;

// An emitter and a point on it without regard to what is lit.
static bool careless_sample(const stage *s, const method *how, const vertex *v,
                            vec3 u, light_sample *out) {
  const light_tree *t = &s->lights.near;
  uint32_t i = (uint32_t)(u.x * (float)t->count);
  const light_emitter *e = &t->emitters[i];
  light_point q;
  vec3 p = v->at.p;
  if (how->by_area) {
    float k = sqrtf(u.y);
    vec3 at = vec3_mad(e->shape.a, k * u.z, e->shape.ab);
    q.at = vec3_mad(at, k * (1 - u.z), e->shape.ac);
    vec3 d = vec3_sub(q.at, p);
    q.wi = vec3_unit(d);
    float cosine = -vec3_dot(q.wi, e->shape.n);
    if (!(cosine > 0)) return false;
    q.pdf = vec3_dot(d, d) / (cosine * e->shape.area);
  } else if (!light_triangle_sample(&e->shape, p, u.y, u.z, &q))
    return false;
  *out = (light_sample){.wi = q.wi, .to = q.at, .has_end = true};
  out->radiance = light_emission(&s->scene, e->source, 0, 0);
  out->pdf = q.pdf / (float)t->count;
  return true;
}

static float balance(const method *how, float mine, float other) {
  return how->by == BY_BOTH ? mine / (mine + other) : 1;
}

static vec3 from_light(const stage *s, const method *how, const vertex *v,
                       const bsdf *b, vec3 u) {
  light_sample l;
  bool found = how->any_light
                   ? careless_sample(s, how, v, u, &l)
                   : light_sample_at(&s->lights, v->at.p, v->n, u, &l);
  if (!found) return vec3_all(0);
  vec3 wi = vertex_local(v, l.wi), wo = vertex_local(v, v->wo);
  if (!(wi.z > 0)) return vec3_all(0);
  light_ray to = {.is_point = l.has_end, .to = l.to, .wi = l.wi};
  ray r = light_ray_shadow(&to, &v->at, true);
  if (s->world.tracer.any(s->world.tracer.tree, &r)) return vec3_all(0);
  float weight = balance(how, l.pdf, bsdf_pdf(b, wo, wi));
  vec3 lit = vec3_mul(bsdf_eval(b, wo, wi), l.radiance);
  return vec3_scale(lit, weight * wi.z / l.pdf);
}

static vec3 from_scattering(const stage *s, const method *how, const vertex *v,
                            const bsdf *b, const float u[3]) {
  bsdf_sample d;
  if (!bsdf_sample_wi(b, vertex_local(v, v->wo), u[0], u[1], u[2], &d))
    return vec3_all(0);
  int inside = 0;
  ray r = vertex_leave(v, b, &d, vec3_neg(v->wo), &inside);
  hit h;
  if (!s->world.tracer.closest(s->world.tracer.tree, &r, &h))
    return vec3_all(0);
  surface at = surface_at(&s->scene, &h, r.d);
  if (!at.front) return vec3_all(0);
  float other = light_pdf_triangle(&s->lights, v->at.p, v->n, h.triangle, at.p);
  return vec3_scale(vec3_mul(d.weight, matter_emission(&at)),
                    balance(how, d.pdf, other));
}

static vec3 direct(const stage *s, const method *how, ray r, sampler *numbers) {
  hit h;
  if (!s->world.tracer.closest(s->world.tracer.tree, &r, &h))
    return vec3_all(0);
  float u[8];
  sampler_8(numbers, 2, u);
  vertex v = vertex_at(&s->scene, &h, r.d);
  matter m = vertex_matter(&v, s->world.dfg, u[6]);
  vec3 sum = v.at.front ? matter_emission(&v.at) : vec3_all(0);
  if (how->by != BY_SCATTERING) {
    vec3 lit = from_light(s, how, &v, &m.bsdf, (vec3){u[4], u[2], u[3]});
    sum = vec3_add(sum, vec3_mul(m.weight, lit));
  }
  if (how->by == BY_LIGHT) return sum;
  vec3 found =
      from_scattering(s, how, &v, &m.bsdf, (float[]){u[5], u[0], u[1]});
  return vec3_add(sum, vec3_mul(m.weight, found));
}

// Work of the pool: one row of a picture.
typedef struct film_job {
  const stage *stage;
  const camera_view *view;
  method how;
  image out;
} film_job;

static void take_row(void *context, size_t row, int worker) {
  (void)worker;
  film_job *job = context;
  const method *how = &job->how;
  for (int x = 0; x < job->out.width; x++) {
    uint64_t key = how->one_key ? 0 : row * (size_t)job->out.width + (size_t)x;
    vec3 sum = {0, 0, 0};
    for (uint32_t k = 0; k < how->spp; k++) {
      sampler n = sampler_of(SAMPLER_SOBOL, 3, key, k);
      vec2 at = sampler_2(&n);
      ray r = camera_ray(job->view, (float)x + at.x, (float)row + at.y);
      sum = vec3_add(sum, direct(job->stage, how, r, &n));
    }
    *pixel(job->out, x, (int)row) = vec3_scale(sum, 1 / (float)how->spp);
  }
}

static image take(output *o, const stage *s, const camera_view *v, int width,
                  int height, method how) {
  film_job job = {s, v, how, image_new(&o->mem, width, height)};
  pool_run(o->threads, (size_t)height, take_row, &job);
  return job.out;
}

static image expose(image im, float gain) {
  for (int i = 0; i < im.width * im.height; i++)
    im.pixels[i] = vec3_scale(im.pixels[i], gain);
  return im;
}

static void print_error(const char *what, const image *im, const image *truth,
                        output *o) {
  printf("%-34s relMSE %.4f\n", what,
         metric_compare(im, truth, &o->mem).relmse);
}

// Four metal plates from smooth to rough under four lamps of one power, from
// small to large.  Source: Veach 1997, figure 9.2.
static stage *plates(output *o) {
  static const vec2 LOW[] = {
      {-2.71f, 0.26f}, {-3.29f, 1.37f}, {-3.73f, 2.70f}, {-4.0f, 4.07f}};
  static const vec2 HIGH[] = {
      {-2.08f, -0.53f}, {-2.84f, 0.48f}, {-3.43f, 1.75f}, {-3.82f, 3.08f}};
  static const float ROUGH[] = {0.08f, 0.17f, 0.28f, 0.42f};
  static const float SIZE[] = {0.05f, 0.14f, 0.4f, 1.1f};
  stage *s = stage_new(o, 64, 16);
  uint32_t wall = add_material(s, vec3_all(0.3f), vec3_all(0));
  add_quad(s, (vec3){-10, -4.2f, -2}, (vec3){0, 0, 12}, (vec3){20, 0, 0}, wall);
  add_quad(s, (vec3){-10, -4.2f, -2}, (vec3){20, 0, 0}, (vec3){0, 14, 0}, wall);
  for (int i = 0; i < 4; i++) {
    uint32_t of = add_material(s, vec3_all(0.7f), vec3_all(0));
    material *m = &s->scene.materials[of];
    m->kind = MATERIAL_METAL_ROUGH;
    m->metallic = 1;
    m->roughness = ROUGH[i];
    vec3 p = {-4, LOW[i].x, LOW[i].y}, u = {8, 0, 0};
    add_quad(s, p, u, (vec3){0, HIGH[i].x - LOW[i].x, HIGH[i].y - LOW[i].y},
             of);
    float r = SIZE[i], glow = 1.2f / (r * r);
    vec3 hue = {i == 0 || i == 2 ? 1 : 0.5f, i > 0 ? 0.9f : 0.5f,
                i < 3 ? 0.6f : 1};
    of = add_material(s, vec3_all(0), vec3_scale(hue, glow));
    vec3 q = {-3.75f + 2.5f * (float)i - r / 2, -r / 2, -r / 2};
    add_quad(s, q, (vec3){r, 0, 0}, (vec3){0, 0.7f * r, 0.7f * r}, of);
  }
  stage_ready(o, s);
  return s;
}

static void draw_weights(output *o) {
  enum { W = 157, H = 116, SPP = 9 };
  stage *s = plates(o);
  vec3 eye = {0, 2, 15}, target = {0, -2.2f, 2.5f};
  camera_view v = view_of(eye, target, 28, W, H);
  image truth = take(o, s, &v, W, H, (method){.spp = 144}), parts[3];
  static const char *const NAMES[] = {"both", "lights alone",
                                      "scattering alone"};
  static const strategy ORDER[] = {BY_LIGHT, BY_SCATTERING, BY_BOTH};
  for (int i = 0; i < 3; i++) {
    parts[i] = take(o, s, &v, W, H, (method){.by = ORDER[i], .spp = SPP});
    print_error(NAMES[ORDER[i]], &parts[i], &truth, o);
    parts[i] = expose(parts[i], 4);
  }
  image all = row_of(&o->mem, parts, 3);
  publish(o->folder, "weights", all);
}

// A strip of light that washes a wall from close by, and a box before it.
static void draw_mistakes(output *o) {
  enum { W = 117, H = 140 };
  stage *s = stage_new(o, 64, 8);
  uint32_t wall = add_material(s, vec3_all(0.7f), vec3_all(0));
  uint32_t lamp = add_material(s, vec3_all(0), (vec3){9, 8, 6});
  add_quad(s, (vec3){-2, 0, 0}, (vec3){0, 0, 4}, (vec3){4, 0, 0}, wall);
  add_quad(s, (vec3){-2, 0, 0}, (vec3){4, 0, 0}, (vec3){0, 4, 0}, wall);
  add_quad(s, (vec3){-0.7f, 1.95f, 0.12f}, (vec3){1.4f, 0, 0},
           (vec3){0, 0.12f, 0.1f}, lamp);
  add_box(s, (vec3){-0.4f, 0, 0.5f}, (vec3){0.8f, 0.9f, 0.5f}, wall);
  stage_ready(o, s);
  camera_view v = view_of((vec3){0, 1.6f, 6}, (vec3){0, 1.15f, 0}, 26, W, H);
  image truth = take(o, s, &v, W, H, (method){.by = BY_LIGHT, .spp = 144});
  const method ways[4] = {
      {.by = BY_LIGHT, .any_light = true, .by_area = true, .spp = 4},
      {.by = BY_LIGHT, .any_light = true, .spp = 4},
      {.by = BY_LIGHT, .one_key = true, .spp = 2},
      {.by = BY_LIGHT, .spp = 2}};
  static const char *const NAMES[] = {"by area", "by solid angle", "one key",
                                      "a key a pixel"};
  image parts[4];
  for (int i = 0; i < 4; i++) {
    parts[i] = take(o, s, &v, W, H, ways[i]);
    print_error(NAMES[i], &parts[i], &truth, o);
    parts[i] = expose(parts[i], 5);
  }
  image all = row_of(&o->mem, parts, 4);
  publish(o->folder, "mistakes", all);
}

// A town at night: boxes, and 500 lanterns of all colours.
static stage *town(output *o) {
  enum { HOUSES = 60, LANTERNS = 500 };
  stage *s = stage_new(o, 2 + 12 * (HOUSES + LANTERNS), 16);
  uint32_t ground = add_material(s, vec3_all(0.5f), vec3_all(0));
  add_quad(s, (vec3){-12, 0, -12}, (vec3){0, 0, 24}, (vec3){24, 0, 0}, ground);
  rng r = rng_of(5, 0, 0);
  for (int i = 0; i < HOUSES; i++) {
    vec3 at = {20 * rng_next(&r) - 10, 0, 20 * rng_next(&r) - 12};
    float wide = 0.5f + rng_next(&r), high = 0.4f + 2 * rng_next(&r);
    add_box(s, at, (vec3){wide, high, wide}, ground);
  }
  uint32_t hue[8];
  for (int i = 0; i < 8; i++) {
    vec3 c = {rng_next(&r), 0.5f * rng_next(&r), rng_next(&r)};
    c.y += 0.4f * c.x;
    hue[i] = add_material(s, vec3_all(0), vec3_scale(c, i == 0 ? 400 : 70));
  }
  for (int i = 0; i < LANTERNS; i++) {
    vec3 at = {22 * rng_next(&r) - 11, 0.15f + 0.5f * rng_next(&r),
               22 * rng_next(&r) - 12};
    float side = 0.02f + 0.03f * rng_next(&r);
    add_box(s, at, (vec3){side, side, side}, hue[i % 64 == 0 ? 0 : 1 + i % 7]);
  }
  stage_ready(o, s);
  return s;
}

static void draw_many(output *o) {
  enum { W = 238, H = 160, SPP = 8 };
  stage *s = town(o);
  camera_view v = view_of((vec3){0, 6, 13}, (vec3){0, 0.2f, -1}, 34, W, H);
  image truth = take(o, s, &v, W, H, (method){.by = BY_LIGHT, .spp = 64});
  image parts[2];
  parts[0] = take(o, s, &v, W, H,
                  (method){.by = BY_LIGHT, .any_light = true, .spp = SPP});
  parts[1] = take(o, s, &v, W, H, (method){.by = BY_LIGHT, .spp = SPP});
  printf("%u lights in the tree\n", s->lights.near.count);
  print_error("each as likely", &parts[0], &truth, o);
  print_error("by the tree", &parts[1], &truth, o);
  image all = row_of(&o->mem, parts, 2);
  publish(o->folder, "many", all);
}

// A sky, the density of its table in the same place, and directions drawn.
static void draw_sky(output *o) {
  enum { W = 158, H = 79 };
  static env sky;
  error err;
  if (!env_load(&sky, "scenes/sky.hdr", &o->mem, NULL, &err)) give_up(&err, 4);
  light_env l;
  light_env_build(&l, &sky, &o->mem, o->threads);
  image parts[3];
  for (int k = 0; k < 3; k++) {
    parts[k] = image_new(&o->mem, W, H);
    for (int i = 0; i < W * H; i++) {
      vec2 uv = {((float)(i % W) + 0.5f) / W, ((float)(i / W) + 0.5f) / H};
      vec3 d = env_direction(uv), c = env_radiance(&sky, d);
      float pdf = light_env_pdf(&l, d);
      if (k == 1) c = vec3_all(fmaxf(0.07f * (num_log2(pdf + 1e-6f) + 8), 0));
      parts[k].pixels[i] = vec3_scale(c, k == 2 ? 0.3f : 0.8f);
    }
  }
  int near_sun = 0;
  for (uint32_t i = 0; i < 512; i++) {
    sampler s = sampler_of(SAMPLER_SOBOL, 1, 1, i);
    vec2 u = sampler_2(&s);
    env_sample to = light_env_sample(&l, u);
    if (!(to.pdf > 0)) continue;
    near_sun += vec3_peak(to.radiance) > 1000;
    vec2 uv = env_uv(to.wi);
    draw_dot(&parts[2], uv.x * W, uv.y * H, 2, (vec3){1, 0.7f, 0.1f});
  }
  printf("%d of 512 directions to the sun\n", near_sun);
  image all = row_of(&o->mem, parts, 3);
  publish(o->folder, "sky", all);
}

static image render(output *o, const stage *s, const integrator *by, int spp,
                    uint64_t seed) {
  render_settings set = {
      .width = 480, .height = 270, .spp = spp, .seed = seed, .by = by};
  set.x0 = 180, set.y0 = 130, set.x1 = 418, set.y1 = 270;
  camera_view v;
  error err;
  const camera *c = scene_camera(&s->scene, NULL);
  if (!camera_view_of(&v, c, set.width, set.height, &err)) give_up(&err, 4);
  render_result r;
  render_run(&r, &s->world, &v, &set, &o->mem, o->threads);
  return r.color;
}

// The garden in the afternoon, 16 samples a pixel: naive, and looking for
// lights.
static void draw_shadow(output *o) {
  stage *s = stage_load(o, "scenes/garden.scene", "scenes/sky.hdr");
  path_tracer by = {.world = &s->world,
                    .lights = &s->lights,
                    .sampler = SAMPLER_SOBOL,
                    .seed = 7};
  integrator looks = path_integrator(&by);
  image truth = render(o, s, &looks, 36, 0);
  by.seed = 0;
  image parts[2] = {render(o, s, NULL, 16, 0), render(o, s, &looks, 16, 0)};
  for (int i = 0; i < 2; i++)
    printf("%-34s mean error %.3f\n",
           i == 0 ? "naive, 16 samples" : "looking for lights, 16 samples",
           metric_compare(&parts[i], &truth, &o->mem).mae);
  for (int i = 0; i < 2; i++)
    parts[i] = expose(parts[i], num_exp2(s->scene.exposure));
  image all = row_of(&o->mem, parts, 2);
  publish(o->folder, "shadow", all);
}

// A room lit through a hole in its left wall by a lamp that is larger.
static stage *dim_room(output *o) {
  stage *s = stage_new(o, 64, 8);
  uint32_t wall = add_material(s, (vec3){0.7f, 0.68f, 0.64f}, vec3_all(0));
  uint32_t red = add_material(s, (vec3){0.65f, 0.2f, 0.15f}, vec3_all(0));
  uint32_t lamp = add_material(s, vec3_all(0), (vec3){60, 55, 48});
  const vec3 x = {4, 0, 0}, y = {0, 2, 0}, z = {0, 0, 4};
  add_quad(s, (vec3){-2, 0, -2}, z, x, wall);
  add_quad(s, (vec3){-2, 2, -2}, x, z, wall);
  add_quad(s, (vec3){-2, 0, -2}, x, y, wall);
  add_quad(s, (vec3){2, 0, 2}, vec3_neg(x), y, wall);
  add_quad(s, (vec3){2, 0, -2}, z, y, red);
  static const float left[4][4] = {{-2, -1.1f, 0, 2},
                                   {-0.4f, 2, 0, 2},
                                   {-1.1f, -0.4f, 0, 1},
                                   {-1.1f, -0.4f, 1.6f, 2}};
  for (int i = 0; i < 4; i++) {
    const float *q = left[i];
    add_quad(s, (vec3){-2, q[2], q[1]}, (vec3){0, 0, q[0] - q[1]},
             (vec3){0, q[3] - q[2], 0}, wall);
  }
  add_quad(s, (vec3){-3, 0.3f, 1}, (vec3){0, 0, -4}, (vec3){0, 2.5f, 0}, lamp);
  add_box(s, (vec3){-0.9f, 0, -1.2f}, (vec3){0.6f, 0.9f, 0.6f}, wall);
  add_box(s, (vec3){0.4f, 0, -0.5f}, (vec3){0.5f, 0.5f, 0.5f}, red);
  stage_ready(o, s);
  return s;
}

// Boxes on a floor in a studio: a bright window of the map behind them, a faint
// one at the right, and hardly anything else.
static stage *studio(output *o) {
  stage *s = stage_new(o, 64, 8);
  uint32_t wall = add_material(s, (vec3){0.7f, 0.68f, 0.64f}, vec3_all(0));
  uint32_t red = add_material(s, (vec3){0.65f, 0.2f, 0.15f}, vec3_all(0));
  add_quad(s, (vec3){-4, 0, -4}, (vec3){0, 0, 8}, (vec3){8, 0, 0}, wall);
  add_box(s, (vec3){-1.6f, 0, -1.4f}, (vec3){1.5f, 1.5f, 0.4f}, wall);
  add_box(s, (vec3){0.2f, 0, -0.9f}, (vec3){0.5f, 0.8f, 0.5f}, red);
  env *e = &s->scene.env;
  *e = (env){.kind = ENV_MAP, .scale = 1, .map = image_new(&o->mem, 64, 32)};
  for (int i = 0; i < 64 * 32; i++) {
    int x = i % 64, y = i / 64;
    bool back = x >= 26 && x < 33 && y >= 8 && y < 12;
    bool right = x >= 46 && x < 48 && y >= 9 && y < 13;
    e->map.pixels[i] = back    ? (vec3){60, 58, 54}
                       : right ? (vec3){6, 6.5f, 8}
                               : vec3_all(0.02f);
  }
  stage_ready(o, s);
  return s;
}

enum { ROOM_WIDTH = 238, ROOM_HEIGHT = 160 };

static camera_view room_view(void) {
  return view_of((vec3){1.5f, 1.2f, 1.8f}, (vec3){-0.9f, 0.7f, -1}, 60,
                 ROOM_WIDTH, ROOM_HEIGHT);
}

static camera_view studio_view(void) {
  return view_of((vec3){0.6f, 1.2f, 1.7f}, (vec3){-0.35f, 0.4f, -1}, 50,
                 ROOM_WIDTH, ROOM_HEIGHT);
}

static image render_room(output *o, const stage *s, const camera_view *v,
                         path_tracer *by, int spp) {
  integrator looks = path_integrator(by);
  render_settings set = {.width = ROOM_WIDTH,
                         .height = ROOM_HEIGHT,
                         .spp = spp,
                         .seed = by->seed,
                         .by = &looks};
  render_result r;
  render_run(&r, &s->world, v, &set, &o->mem, o->threads);
  return r.color;
}

// Two pictures side by side, and how far each is from the truth.
static void publish_pair(output *o, const char *file, image parts[2],
                         const char *const names[2], const image *truth,
                         float gain) {
  for (int i = 0; i < 2; i++) {
    print_error(names[i], &parts[i], truth, o);
    parts[i] = expose(parts[i], gain);
  }
  publish(o->folder, file, row_of(&o->mem, parts, 2));
}

// Eight samples that ask the tree or the table, and eight that remember.
static void draw_memory(output *o, stage *s, camera_view v, const char *file,
                        float gain) {
  path_tracer by = {.world = &s->world, .lights = &s->lights, .seed = 1};
  path_film lesson = {&v, ROOM_WIDTH, ROOM_HEIGHT};
  image parts[2] = {render_room(o, s, &v, &by, 8)};
  if (!path_learn(&s->lights, &by, &lesson, &o->mem, o->threads))
    printf("nothing was learned\n");
  parts[1] = render_room(o, s, &v, &by, 8);
  by.seed = 0;
  image truth = render_room(o, s, &v, &by, 128);
  const char *const names[] = {"without memory", "remembering"};
  publish_pair(o, file, parts, names, &truth, gain);
}

// A colour for each part of the lamp of a dim room: from red to blue across it,
// greener upwards.
static vec3 color_of_part(const light_parts *parts, uint32_t i) {
  const light_triangle *t = &parts->of[i].shape;
  vec3 at = vec3_mad(t->a, 1.0f / 3, vec3_add(t->ab, t->ac));
  return (vec3){(1 - at.z) / 4, (at.y - 0.3f) / 2.5f, (at.z + 3) / 4};
}

// That of the part that a point of the lamp lies in, or nearly so.
static vec3 color_of_lamp(const light_parts *parts, vec3 p) {
  uint32_t best = 0;
  float least = HUGE_VALF;
  for (uint32_t i = 0; i < parts->count; i++) {
    const light_triangle *t = &parts->of[i].shape;
    vec3 middle = vec3_mad(t->a, 1.0f / 3, vec3_add(t->ab, t->ac));
    float far = vec3_length(vec3_sub(middle, p));
    if (far < least) least = far, best = i;
  }
  return color_of_part(parts, best);
}

// Whom a place asks: the mean colour of the parts by their probabilities, and
// the probability that any is asked.
static vec3 whom(const light_set *l, vec3 p, vec3 n, float *any) {
  vec3 sum = vec3_all(0);
  uint32_t key = light_memory_key(l->memory, p, n);
  *any = 0;
  for (uint32_t i = 0; i < l->parts.count; i++) {
    float share = light_memory_share(l->memory, key, i);
    sum = vec3_mad(sum, share, color_of_part(&l->parts, i));
    *any += share;
  }
  return vec3_scale(sum, 1 / *any);
}

// What a memory of the lamp has learned in a dim room.
static void draw_cells(output *o) {
  stage *s = dim_room(o);
  camera_view v = room_view();
  path_tracer by = {.world = &s->world, .lights = &s->lights, .seed = 1};
  path_film lesson = {&v, ROOM_WIDTH, ROOM_HEIGHT};
  if (!path_learn(&s->lights, &by, &lesson, &o->mem, o->threads)) return;
  image parts[2];
  for (int i = 0; i < 2; i++)
    parts[i] = image_new(&o->mem, ROOM_WIDTH, ROOM_HEIGHT);
  for (int i = 0; i < ROOM_WIDTH * ROOM_HEIGHT; i++) {
    float x = (float)(i % ROOM_WIDTH), y = (float)(i / ROOM_WIDTH), any = 1;
    ray r = camera_ray(&v, x + 0.5f, y + 0.5f);
    hit h;
    if (!s->world.tracer.closest(s->world.tracer.tree, &r, &h)) continue;
    vertex at = vertex_at(&s->scene, &h, r.d);
    bool lamp = at.at.p.x < -2.5f;
    vec3 c = lamp ? color_of_lamp(&s->lights.parts, at.at.p)
                  : whom(&s->lights, at.at.p, at.ns, &any);
    parts[0].pixels[i] = vec3_mad(vec3_all(-0.35f), 1.7f, c);
    parts[1].pixels[i] = vec3_all(any * any);
  }
  publish(o->folder, "cells", row_of(&o->mem, parts, 2));
}

// The same time of paths that walk alone and of such that share.
static void draw_neighbours(output *o) {
  stage *s = dim_room(o);
  path_tracer by = {.world = &s->world, .lights = &s->lights, .seed = 1};
  camera_view v = room_view();
  path_film all_of = {&v, ROOM_WIDTH, ROOM_HEIGHT};
  path_learn(&s->lights, &by, &all_of, &o->mem, o->threads);
  double start = clock_seconds();
  image parts[2] = {render_room(o, s, &v, &by, 8)};
  double alone = clock_seconds() - start;
  start = clock_seconds();
  if (share_learn(&by, &all_of, o->threads)) by.film = &all_of;
  parts[1] = render_room(o, s, &v, &by, 6);
  printf("alone %.2f s, shared %.2f s\n", alone, clock_seconds() - start);
  by.seed = 0;
  image truth = render_room(o, s, &v, &by, 128);
  const char *const names[] = {"alone", "shared"};
  publish_pair(o, "neighbours", parts, names, &truth, 0.4f);
}

// The balls of the Cornell box and what is below them.
static image render_balls(output *o, const stage *s, const path_tracer *by,
                          int spp) {
  camera_view v;
  error err;
  enum { SIDE = 400 };
  if (!camera_view_of(&v, scene_camera(&s->scene, NULL), SIDE, SIDE, &err))
    give_up(&err, 4);
  integrator looks = path_integrator(by);
  render_settings set = {.width = SIDE,
                         .height = SIDE,
                         .spp = spp,
                         .seed = by->seed,
                         .by = &looks};
  set.x0 = 90, set.y0 = 210, set.x1 = 328, set.y1 = 384;
  render_result r;
  render_run(&r, &s->world, &v, &set, &o->mem, o->threads);
  return r.color;
}

// The same time without aimed rays and with them, the photons included.
static void draw_glass(output *o) {
  stage *s = stage_load(o, "scenes/cornell-balls.scene", NULL);
  path_tracer by = {.world = &s->world, .lights = &s->lights, .seed = 2};
  camera_view v;
  error err;
  if (!camera_view_of(&v, scene_camera(&s->scene, NULL), 400, 400, &err))
    give_up(&err, 4);
  double start = clock_seconds();
  image parts[2] = {render_balls(o, s, &by, 16)};
  double plain = clock_seconds() - start;
  path_film lesson = {&v, 400, 400};
  start = clock_seconds();
  by.aim = aim_learn(&by, &lesson, &o->mem, o->threads);
  double learned = clock_seconds() - start;
  parts[1] = render_balls(o, s, &by, 8);
  printf("scattered %.2f s, aimed %.2f s of which learning %.2f\n", plain,
         clock_seconds() - start, learned);
  by.seed = 0;
  image truth = render_balls(o, s, &by, 64);
  const char *const names[] = {"scattered", "aimed"};
  publish_pair(o, "glass", parts, names, &truth, 3);
}

// The least seconds of several runs for each of n calls, in nanoseconds.
typedef float (*timed)(const void *context, uint32_t i);

static void print_time(const char *what, timed call, const void *context,
                       uint32_t n) {
  double best = HUGE_VAL;
  volatile float sink = 0;
  for (int run = 0; run < 9; run++) {
    double start = clock_seconds();
    for (uint32_t i = 0; i < n; i++)
      sink = sink + call(context, i);
    best = fmin(best, clock_seconds() - start);
  }
  printf("%-40s %6.1f ns\n", what, 1e9 * best / n);
}

static float eight_numbers(const void *dimension, uint32_t i) {
  sampler s = sampler_of(SAMPLER_SOBOL, 1, i / 64, i % 1024);
  float u[8];
  sampler_8(&s, *(const uint32_t *)dimension, u);
  return u[0] + u[7];
}

static float one_by_one(const void *dimension, uint32_t i) {
  sampler s = sampler_of(SAMPLER_SOBOL, 1, i / 64, i % 1024);
  sampler_at(&s, *(const uint32_t *)dimension);
  float sum = 0;
  for (int k = 0; k < 8; k++)
    sum += sampler_1(&s);
  return sum;
}

static float random_ones(const void *context, uint32_t i) {
  (void)context;
  rng r = rng_of(1, i / 64, i % 1024);
  float sum = 0;
  for (int k = 0; k < 8; k++)
    sum += rng_next(&r);
  return sum;
}

static float light_of(const void *lights, uint32_t i) {
  vec3 u = {(float)(i % 61) / 61, (float)(i % 59) / 59, (float)(i % 53) / 53};
  vec3 p = {5 * u.y - 2.5f, -2, 5 * u.z};
  light_sample s;
  return light_sample_at(lights, p, (vec3){0, 1, 0}, u, &s) ? s.pdf : 0;
}

static void print_times(output *o) {
  const uint32_t first = 0, later = 18, n = 20000;
  print_time("eight numbers, the first dimensions", eight_numbers, &first, n);
  print_time("eight numbers, later dimensions", eight_numbers, &later, n);
  print_time("the first one by one", one_by_one, &first, n);
  print_time("later ones one by one", one_by_one, &later, n);
  print_time("eight of rng.h", random_ones, NULL, n);
  print_time("a sample of 8 lamps", light_of, &plates(o)->lights, n);
  print_time("a sample of 6000 lamps", light_of, &town(o)->lights, n);
}

int main(int argc, char **argv) {
  if (argc != 2) return 2;
  output o = {.folder = argv[1]};
  o.threads = pool_new(&o.mem, pool_default_threads());
  draw_points(&o);
  draw_turns(&o);
  draw_slopes(&o);
  draw_sky(&o);
  draw_weights(&o);
  draw_mistakes(&o);
  draw_many(&o);
  draw_shadow(&o);
  draw_memory(&o, dim_room(&o), room_view(), "memory", 0.4f);
  draw_cells(&o);
  draw_memory(&o, studio(&o), studio_view(), "memory-sky", 0.5f);
  draw_glass(&o);
  draw_neighbours(&o);
  print_times(&o);
  pool_free(o.threads);
  arena_free(&o.mem);
  return 0;
}

// figures.c — the pictures of chapter 9, and the numbers that its text quotes.

#include "../../tests/solids.h"
#include "../tripod.h"
#include "bsdf.h"
#include "metric.h"
#include "num.h"
#include "render.h"

#include <stdio.h>
#include <stdlib.h>

// Where the pictures go, and who computes them.
typedef struct output {
  const char *folder;
  arena mem;
  pool *threads;
} output;

// A scene with its tree.
typedef struct stage {
  scene scene;
  bvh tree;
} stage;

static stage *stage_load(output *o, const char *path) {
  stage *s = ARENA_NEW(&o->mem, stage, 1);
  open_scene(&s->scene, path, NULL, &o->mem, o->threads);
  const mesh *m = &s->scene.mesh;
  bvh_build(&s->tree, m->positions, m->position_index,
            (uint32_t)m->triangle_count, BVH_SAH, &o->mem, o->threads);
  return s;
}

static path_world stage_world(output *o, const stage *s) {
  path_world w = {
      .scene = &s->scene, .tracer = bvh_tracer(&s->tree), .lights = true};
  w.dfg = matter_table(&s->scene, PBR_GGX, &o->mem, o->threads);
  return w;
}

static camera_view stage_view(const stage *s, int width, int height) {
  return view_by(scene_camera(&s->scene, NULL), width, height);
}

// How a stage is photographed; the crop is all where x1 is 0.
typedef struct shot {
  int width, height, spp, max_depth;
  bool no_lights;
  uint64_t seed;
  int x0, y0, x1, y1;
} shot;

static image take(output *o, const stage *s, shot how) {
  path_world w = stage_world(o, s);
  w.lights = !how.no_lights;
  w.max_depth = how.max_depth;
  camera_view v = stage_view(s, how.width, how.height);
  render_settings settings = {.width = how.width,
                              .height = how.height,
                              .spp = how.spp,
                              .seed = how.seed,
                              .x0 = how.x0,
                              .y0 = how.y0,
                              .x1 = how.x1,
                              .y1 = how.y1};
  render_result r;
  render_run(&r, &w, &v, &settings, &o->mem, o->threads);
  return r.color;
}

// The exposure of the scene, in place.
static image expose(const stage *s, image im) {
  float gain = num_exp2(s->scene.exposure);
  for (int i = 0; i < im.width * im.height; i++)
    im.pixels[i] = vec3_scale(im.pixels[i], gain);
  return im;
}

// Emission and one bounce; two bounces; all of them.
static void draw_bounces(output *o) {
  const stage *s = stage_load(o, "chapters/09-paths/room.scene");
  image parts[3];
  for (int i = 0; i < 3; i++)
    parts[i] = take(o, s,
                    (shot){.width = 144,
                           .height = 144,
                           .spp = 64,
                           .max_depth = i < 2 ? i + 2 : 0});
  image all = row_of(&o->mem, parts, 3);
  publish(o->folder, "bounces", all);
}

// The mistakes of the section "What goes wrong".
typedef enum mistake {
  NO_MISTAKE,
  NO_COSINE,         // weight f / pdf
  UNPAID_ROULETTE,   // survivors are not scaled up
  EQUAL_RANDOMNESS,  // one stream for all pixels
  MISTAKES
} mistake;

// A path tracer for Lambert surfaces alone, uniform over the hemisphere, of at
// most six segments, with one mistake.
static vec3 tiny_radiance(const path_world *w, ray r, rng *random,
                          mistake wrong) {
  vec3 sum = {0, 0, 0}, throughput = {1, 1, 1};
  hit h;
  for (int k = 0; k < 6 && w->tracer.closest(w->tracer.tree, &r, &h); k++) {
    surface s = surface_at(w->scene, &h, r.d);
    sum = vec3_add(sum, vec3_mul(throughput, s.material->ke));
    float q = k == 0 ? 1 : 0.5f;
    if (rng_next(random) >= q) break;
    if (wrong != UNPAID_ROULETTE) throughput = vec3_scale(throughput, 1 / q);
    vec3 n = s.front ? s.ng : vec3_neg(s.ng), t, b;
    bsdf_basis(n, &t, &b);
    float z = rng_next(random), sine = sqrtf(1 - z * z);
    vec2 c = num_circle(rng_next(random));
    vec3 wi = vec3_mad(vec3_scale(t, sine * c.x), sine * c.y, b);
    wi = vec3_mad(wi, z, n);
    float over_pdf = 2 * (wrong == NO_COSINE ? 1 : z);
    throughput = vec3_mul(throughput, vec3_scale(s.material->kd, over_pdf));
    r = surface_ray(&s, wi);
  }
  return sum;
}

static void draw_mistakes(output *o) {
  enum { SIDE = 110, SPP = 28 };
  const stage *s = stage_load(o, "chapters/09-paths/room.scene");
  path_world w = stage_world(o, s);
  camera_view v = stage_view(s, SIDE, SIDE);
  image parts[MISTAKES];
  for (int m = 0; m < MISTAKES; m++) {
    parts[m] = image_new(&o->mem, SIDE, SIDE);
    for (int i = 0; i < SIDE * SIDE; i++) {
      vec3 sum = {0, 0, 0};
      uint64_t key = m == EQUAL_RANDOMNESS ? 0 : (uint64_t)i;
      for (uint64_t k = 0; k < SPP; k++) {
        rng random = rng_of(0, key, k);
        float x = (float)(i % SIDE) + rng_next(&random);
        float y = (float)(i / SIDE) + rng_next(&random);
        ray r = camera_ray(&v, x, y);
        sum = vec3_add(sum, tiny_radiance(&w, r, &random, (mistake)m));
      }
      parts[m].pixels[i] = vec3_scale(sum, 1.0f / SPP);
    }
    double green = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
      green += (double)parts[m].pixels[i].y / (SIDE * SIDE);
    printf("mistake %d: mean green %.3f\n", m, green);
  }
  image all = row_of(&o->mem, parts, MISTAKES);
  publish(o->folder, "mistakes", all);
}

// Balls of six materials, each before light of one brightness from everywhere:
// what loses none is not seen.
static void draw_furnace(output *o) {
  const vec3 white = {1, 1, 1}, copper = {0.9f, 0.6f, 0.4f};
  material balls[6] = {
      {.kind = MATERIAL_BLINN_PHONG, .kd = white},
      {.kind = MATERIAL_MIRROR, .ks = white},
      {.kind = MATERIAL_GLASS, .ni = 1.5f},
      {.kind = MATERIAL_BLINN_PHONG, .kd = {0.2f, 0.3f, 0.6f}},
      {.kind = MATERIAL_BLINN_PHONG, .kd = vec3_all(0.2f), .ks = copper},
      {.kind = MATERIAL_METAL_ROUGH, .kd = copper, .roughness = 0}};
  balls[4].ns = 15;
  stage s = {.scene = {0}};
  solid ball = solid_icosphere(&o->mem, 4);
  s.scene = solid_scene(&ball, true);
  s.tree = solid_tree(&ball, &o->mem);
  camera c = {NULL, {0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 24};
  s.scene.cameras = &c;
  s.scene.camera_count = 1;
  s.scene.env = (env){.kind = ENV_CONSTANT, .constant = white, .scale = 0.5f};
  s.scene.material_count = 1;
  s.scene.material_of =
      ARENA_NEW(&o->mem, uint32_t, s.scene.mesh.triangle_count);
  image parts[6];
  for (int i = 0; i < 6; i++) {
    balls[i].d = 1;
    s.scene.materials = &balls[i];
    parts[i] = take(o, &s, (shot){.width = 76, .height = 76, .spp = 40});
  }
  image all = row_of(&o->mem, parts, 6);
  publish(o->folder, "furnace", all);
}

// A white sheet with grey lines: columns x rows of equal fields.
static image graph_paper(output *o, int width, int height, int columns,
                         int rows) {
  image im = paper(&o->mem, width, height);
  const vec3 grey = vec3_all(0.7f);
  float w = (float)width - 1, h = (float)height - 1;
  for (int i = 0; i <= columns; i++) {
    float x = w * (float)i / (float)columns;
    draw_thin_line(im, (vec2){x, 0}, (vec2){x, h}, grey);
  }
  for (int i = 0; i <= rows; i++) {
    float y = h * (float)i / (float)rows;
    draw_thin_line(im, (vec2){0, y}, (vec2){w, y}, grey);
  }
  return im;
}

// The reflectance of glass of index 1.5 by a cosine, as the widespread code
// computes it: Schlick with the cosine on this side, also when that is inside.
static float schlick_inside(float cos_i, float eta) {
  float sin_t2 = (1 - cos_i * cos_i) / (eta * eta);
  return sin_t2 > 1 ? 1 : fresnel_schlick(vec3_all(0.04f), cos_i).x;
}

// The largest error of Schlick's reflectance over a million cosines.
static void print_worst(float eta) {
  float worst = 0, at = 0;
  for (int i = 0; i <= 1000000; i++) {
    float c = (float)i * 1e-6f, cos_t;
    float e =
        fabsf(schlick_inside(c, eta) - fresnel_dielectric(c, eta, &cos_t));
    if (e > worst) worst = e, at = c;
  }
  printf("Schlick %s glass: largest error %.3f at %.1f degrees\n",
         eta < 1 ? "out of" : "into", (double)worst,
         180 * (double)num_acos_pi(at));
}

// Reflectance against the angle from 0 to 90 degrees: coming in on the left,
// going out on the right; exact in black, Schlick's in red.
static void draw_fresnel(output *o) {
  enum { SIDE = 210 };
  const vec3 black = {0, 0, 0}, red = {0.8f, 0.05f, 0.02f};
  image parts[2];
  for (int out = 0; out < 2; out++) {
    float eta = out ? 1 / 1.5f : 1.5f;
    parts[out] = graph_paper(o, SIDE, SIDE, 9, 10);
    vec2 exact0 = {0, 0}, schlick0 = {0, 0};
    for (int i = 0; i <= 4 * SIDE; i++) {
      float turns = 0.25f * (float)i / (4 * SIDE), cos_t;
      float c = fmaxf(num_circle(turns).x, 0);
      float r = fresnel_dielectric(c, eta, &cos_t), s = schlick_inside(c, eta);
      vec2 exact = {(float)i / 4, (SIDE - 1) * (1 - r)};
      vec2 schlick = {(float)i / 4, (SIDE - 1) * (1 - s)};
      if (i > 0) draw_thin_line(parts[out], schlick0, schlick, red);
      if (i > 0) draw_thin_line(parts[out], exact0, exact, black);
      exact0 = exact, schlick0 = schlick;
    }
    print_worst(eta);
  }
  image all = row_of(&o->mem, parts, 2);
  publish(o->folder, "fresnel", all);
}

// The error of the room at 1, 4, ... 256 samples against that of many: both
// axes logarithmic, a line for every factor of 2, and the line of slope -1/2
// through the first point.
static void draw_convergence(output *o) {
  enum { SIDE = 32, STEPS = 5, FIELD = 26 };
  const stage *s = stage_load(o, "chapters/09-paths/room.scene");
  image truth =
      take(o, s, (shot){.width = SIDE, .height = SIDE, .spp = 2000, .seed = 1});
  image plot = graph_paper(o, 9 * FIELD, 6 * FIELD, 9, 6);
  double first = 0, last = 0;
  vec2 from = {0, 0};
  for (int i = 0; i < STEPS; i++) {
    int spp = 1 << (2 * i);
    image im = take(o, s, (shot){.width = SIDE, .height = SIDE, .spp = spp});
    double e = metric_compare(&im, &truth, &o->mem).rmse;
    printf("%4d spp: rmse %.4f\n", spp, e);
    last = (double)num_log2((float)e);
    if (i == 0) first = last;
    float x = (0.5f + 2 * (float)i) * FIELD;
    float y = (0.5f + (float)(first - last)) * FIELD;
    if (i == 0) from = (vec2){x, y};
    for (int k = -3; k <= 3; k++)
      draw_thin_line(plot, (vec2){x - 3, y + (float)k},
                     (vec2){x + 3, y + (float)k}, (vec3){0.8f, 0.05f, 0.02f});
  }
  draw_thin_line(plot, from, (vec2){from.x + 8 * FIELD, from.y + 4 * FIELD},
                 vec3_all(0));
  printf("slope %.3f\n", (last - first) / (2 * (STEPS - 1)));
  publish(o->folder, "convergence", plot);
}

// The garden with 10 samples and 256, and without its lamp and with it.
static void draw_garden(output *o) {
  shot how = {.width = 160, .height = 90, .spp = 256};
  const stage *s = stage_load(o, "scenes/garden.scene");
  image best = expose(s, take(o, s, how));
  how.spp = 10;
  image few = expose(s, take(o, s, how));
  image noise = row_of(&o->mem, (image[]){few, best}, 2);
  publish(o->folder, "garden-noise", noise);
  how.spp = 48;
  how.no_lights = true;
  image dark = expose(s, take(o, s, how));
  image lamp = row_of(&o->mem, (image[]){dark, best}, 2);
  publish(o->folder, "garden-lamp", lamp);
}

// Its glass ball and its mirror ball closer: facets, and smooth.
static void draw_facets(output *o) {
  shot how = {.width = 442, .height = 250, .spp = 32};
  how.x0 = 50, how.y0 = 64, how.x1 = 246, how.y1 = 194;
  const stage *flat = stage_load(o, "scenes/garden-facets.scene");
  const stage *s = stage_load(o, "scenes/garden.scene");
  image parts[2] = {expose(flat, take(o, flat, how)),
                    expose(s, take(o, s, how))};
  image both = row_of(&o->mem, parts, 2);
  publish(o->folder, "garden-facets", both);
}

int main(int argc, char **argv) {
  if (argc != 2) return 2;
  output o = {.folder = argv[1]};
  o.threads = pool_new(&o.mem, pool_default_threads());
  draw_bounces(&o);
  draw_mistakes(&o);
  draw_furnace(&o);
  draw_fresnel(&o);
  draw_convergence(&o);
  draw_garden(&o);
  draw_facets(&o);
  pool_free(o.threads);
  arena_free(&o.mem);
  return 0;
}

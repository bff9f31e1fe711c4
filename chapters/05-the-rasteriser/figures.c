// figures.c — the pictures of chapter 5, and the tables that its text quotes.

#include "../../tests/solids.h"
#include "../easel.h"
#include "clock.h"
#include "num.h"
#include "raster.h"

#include <stdio.h>
#include <stdlib.h>

// Where the pictures go, and what draws them.
typedef struct output {
  const char *folder;
  arena mem;
  gl *g;
  double opened;  // seconds it took to open g
} output;

// Room for a scene of a few solids.
enum { STAGE_VERTICES = 8000, STAGE_TRIANGLES = 8000, STAGE_MATERIALS = 8 };

// A scene that is built by hand.
typedef struct stage {
  scene scene;
  material materials[STAGE_MATERIALS];
  light lights[2];
} stage;

static stage *stage_new(output *o) {
  stage *s = ARENA_NEW(&o->mem, stage, 1);
  mesh *m = &s->scene.mesh;
  m->positions = ARENA_NEW(&o->mem, vec3, STAGE_VERTICES);
  m->normals = ARENA_NEW(&o->mem, vec3, STAGE_VERTICES);
  m->position_index = ARENA_NEW(&o->mem, uint32_t, 3 * STAGE_TRIANGLES);
  m->normal_index = ARENA_NEW(&o->mem, uint32_t, 3 * STAGE_TRIANGLES);
  s->scene.material_of = ARENA_NEW(&o->mem, uint32_t, STAGE_TRIANGLES);
  s->scene.materials = s->materials;
  s->scene.material_count = STAGE_MATERIALS;
  s->scene.lights = s->lights;
  s->scene.env = (env){.kind = ENV_NONE, .scale = 1};
  return s;
}

static void stage_add(stage *s, const solid *from, bool smooth, uint32_t of) {
  mesh *m = &s->scene.mesh;
  uint32_t first = (uint32_t)m->position_count;
  for (uint32_t i = 0; i < from->vertices; i++) {
    m->positions[m->position_count] = from->p[i];
    m->normals[m->position_count++] = from->n[i];
  }
  for (uint32_t t = 0; t < from->triangles; t++) {
    for (uint32_t i = 0; i < 3; i++) {
      size_t corner = 3 * m->triangle_count + i;
      m->position_index[corner] = first + from->index[3 * t + i];
      m->normal_index[corner] = smooth ? m->position_index[corner] : MESH_NONE;
    }
    s->scene.material_of[m->triangle_count++] = of;
  }
  m->normal_count = m->position_count;
  mesh_bounds(m, &s->scene.lo, &s->scene.hi);
}

static void stage_ball(output *o, stage *s, vec3 at, int level, bool smooth,
                       uint32_t of) {
  solid ball = solid_icosphere(&o->mem, level);
  solid_place(&ball, 1, at);
  stage_add(s, &ball, smooth, of);
}

// A horizontal square of half side `half` at height y.
static void stage_floor(stage *s, float y, float half, uint32_t of) {
  vec3 p[4] = {
      {-half, y, half}, {half, y, half}, {half, y, -half}, {-half, y, -half}};
  uint32_t index[6] = {0, 1, 2, 0, 2, 3};
  solid floor = {.p = p, .n = p, .index = index, .vertices = 4, .triangles = 2};
  stage_add(s, &floor, false, of);
}

static camera_view view_of(vec3 eye, vec3 target, float fov, int width,
                           int height) {
  camera c = {.eye = eye, .target = target, .up = {0, 1, 0}, .fov_deg = fov};
  camera_view v;
  error err;
  if (!camera_view_of(&v, &c, width, height, &err)) give_up(&err, 2);
  return v;
}

static image draw(output *o, const scene *s, const camera_view *v,
                  const raster_settings *set) {
  raster *r;
  error err;
  if (!raster_new(&r, o->g, s, set, &o->mem, &err) || !raster_draw(r, v, &err))
    give_up(&err, 5);
  image im = raster_read(r, &o->mem);
  raster_free(r);
  return im;
}

static material shiny(vec3 kd, float ks, float ns) {
  return (material){.kind = MATERIAL_BLINN_PHONG,
                    .kd = kd,
                    .ks = vec3_all(ks),
                    .ns = ns,
                    .d = 1};
}

// Five balls of 320 triangles: facets, interpolated normals, and highlights
// that get sharper.
static stage *balls_stage(output *o) {
  stage *s = stage_new(o);
  const vec3 blue = {0.10f, 0.25f, 0.60f};
  const float ks[5] = {0, 0, 0.3f, 0.3f, 0.3f};
  const float ns[5] = {0, 0, 8, 60, 1000};
  for (int i = 0; i < 5; i++) {
    s->materials[i] = shiny(blue, ks[i], ns[i]);
    vec3 at = {2.15f * (float)(i - 2), 0, 0};
    stage_ball(o, s, at, 2, i > 0, (uint32_t)i);
  }
  s->lights[0] = (light){LIGHT_DIR, {0.5f, -0.6f, -0.62f}, vec3_all(2.4f)};
  s->lights[1] = (light){LIGHT_POINT, {-9, 1, 5}, {30, 22, 12}};
  s->scene.light_count = 2;
  return s;
}

static void paint_models(output *o) {
  stage *s = balls_stage(o);
  raster_settings set = {
      .width = 480, .height = 112, .msaa = 4, .lights = true};
  camera_view v = view_of((vec3){0, 0, 30}, (vec3){0, 0, 0}, 4.8f, 480, 112);
  publish(o->folder, "models", draw(o, &s->scene, &v, &set));
}

// The garden, drawn once more for the times: the seconds of each stage.
static void time_garden(output *o, const scene *s, const camera_view *v,
                        raster_settings set, const char *label) {
  raster *r;
  error err;
  if (!raster_new(&r, o->g, s, &set, &o->mem, &err)) give_up(&err, 5);
  raster_times first = {0}, t = {0};
  double best = 1e9;
  for (int i = 0; i < 4; i++) {
    if (!raster_draw(r, v, &err)) give_up(&err, 5);
    t = raster_last_times(r);
    if (i == 0) first = t;
    best = i > 0 && t.draw < best ? t.draw : best;
  }
  printf("%-18s %7.1f %7.1f %7.1f %7.1f %7.1f\n", label, 1e3 * first.upload,
         1e3 * first.compile, 1e3 * first.shadow, 1e3 * first.draw, 1e3 * best);
  raster_free(r);
}

static scene garden_of(output *o) {
  scene s;
  error err;
  report r = {.mem = &o->mem};
  scene_options options = {0};
  if (!scene_load(&s, "scenes/garden.scene", &options, &o->mem, NULL, &r, &err))
    give_up(&err, 3);
  return s;
}

static void brighten(image im, float stops) {
  for (int i = 0; i < im.width * im.height; i++)
    im.pixels[i] = vec3_scale(im.pixels[i], num_exp2(stops));
}

static void paint_garden(output *o) {
  scene s = garden_of(o);
  error err;
  camera_view v;
  const camera *c = scene_camera(&s, NULL);
  if (!camera_view_of(&v, c, 480, 270, &err)) give_up(&err, 2);
  raster_settings set = {.width = 480,
                         .height = 270,
                         .msaa = 4,
                         .lights = true,
                         .shadows = true,
                         .sky = true};
  image im = draw(o, &s, &v, &set);
  brighten(im, s.exposure);
  publish(o->folder, "garden", im);

  // The lower half of the same, without shadows and with.
  set.x0 = 240, set.y0 = 150, set.x1 = 480, set.y1 = 270;
  image both = paper(&o->mem, 484, 120);
  for (int k = 0; k < 2; k++) {
    set.shadows = k == 1;
    im = draw(o, &s, &v, &set);
    brighten(im, s.exposure);
    paste(both, im, 244 * k, 0);
  }
  both.width = 484;
  publish(o->folder, "shadows", both);
}

// A small reference: one ray a pixel, Blinn-Phong as the formula says it.
static vec3 by_formula(const stage *s, const bvh *tree, ray r) {
  hit h;
  if (!bvh_closest(tree, &r, &h)) return vec3_all(0);
  const mesh *m = &s->scene.mesh;
  const float b[3] = {1 - h.b1 - h.b2, h.b1, h.b2};
  vec3 n = vec3_all(0), p = n, corner[3];
  for (size_t i = 0; i < 3; i++) {
    size_t at = 3 * (size_t)h.triangle + i;
    corner[i] = m->positions[m->position_index[at]];
    p = vec3_mad(p, b[i], corner[i]);
    if (m->normal_index[at] != MESH_NONE)
      n = vec3_mad(n, b[i], m->normals[m->normal_index[at]]);
  }
  if (vec3_dot(n, n) == 0)
    n = vec3_cross(vec3_sub(corner[1], corner[0]),
                   vec3_sub(corner[2], corner[0]));
  n = vec3_unit(n);
  const material *k = &s->materials[s->scene.material_of[h.triangle]];
  vec3 sum = vec3_all(0), wo = vec3_unit(vec3_neg(r.d));
  if (vec3_dot(n, wo) <= 0) return sum;
  for (size_t i = 0; i < s->scene.light_count; i++) {
    const light *l = &s->lights[i];
    bool point = l->kind == LIGHT_POINT;
    vec3 d = point ? vec3_sub(l->at, p) : vec3_neg(l->at);
    vec3 wi = vec3_unit(d), half = vec3_unit(vec3_add(wo, wi));
    float e = fmaxf(vec3_dot(n, wi), 0) / (point ? vec3_dot(d, d) : 1);
    float norm = (k->ns + 2) * (k->ns + 4) /
                 (8 * PI * (num_exp2(-0.5f * k->ns) + k->ns));
    float lobe = norm * num_pow(fmaxf(vec3_dot(n, half), 0), k->ns);
    vec3 f = vec3_mad(vec3_scale(k->kd, 1 / PI), lobe, k->ks);
    sum = vec3_add(sum, vec3_scale(vec3_mul(f, l->power), e));
  }
  return sum;
}

static stage *difference_stage(output *o) {
  stage *s = stage_new(o);
  s->materials[0] = shiny(vec3_all(0.5f), 0, 0);
  s->materials[1] = shiny((vec3){0.6f, 0.2f, 0.1f}, 0.2f, 20);
  s->materials[2] = shiny((vec3){0.2f, 0.5f, 0.2f}, 0.3f, 200);
  stage_floor(s, -1, 7, 0);
  stage_ball(o, s, (vec3){-1.1f, 0, 0}, 2, true, 1);
  stage_ball(o, s, (vec3){1.1f, 0, 0}, 1, false, 2);
  s->lights[0] = (light){LIGHT_POINT, {3, 5, 4}, vec3_all(40)};
  s->lights[1] = (light){LIGHT_DIR, {0.8f, -0.6f, 0}, {0.3f, 0.4f, 0.6f}};
  s->scene.light_count = 2;
  return s;
}

static void paint_difference(output *o) {
  stage *s = difference_stage(o);
  bvh tree;
  const mesh *m = &s->scene.mesh;
  bvh_build(&tree, m->positions, m->position_index, (uint32_t)m->triangle_count,
            BVH_SAH, &o->mem, NULL);
  const int wide = 158, high = 120;
  camera_view v =
      view_of((vec3){0, 1.2f, 7}, (vec3){0, -0.1f, 0}, 28, wide, high);
  raster_settings set = {
      .width = wide, .height = high, .msaa = 1, .lights = true};
  image drawn = draw(o, &s->scene, &v, &set);
  image traced = image_new(&o->mem, wide, high);
  image apart = image_new(&o->mem, wide, high);
  int beyond = 0;
  float worst = 0;
  for (int i = 0; i < wide * high; i++) {
    ray r = camera_ray(&v, (float)(i % wide) + 0.5f, (float)(i / wide) + 0.5f);
    traced.pixels[i] = by_formula(s, &tree, r);
    vec3 d = vec3_abs(vec3_sub(drawn.pixels[i], traced.pixels[i]));
    apart.pixels[i] = vec3_scale(d, 1000);
    beyond += vec3_peak(d) > 1.0f / 255;
    if (vec3_peak(d) <= 1.0f / 255) worst = fmaxf(worst, vec3_peak(d));
  }
  image all = paper(&o->mem, 3 * wide + 6, high);
  paste(all, drawn, 0, 0);
  paste(all, traced, wide + 3, 0);
  paste(all, apart, 2 * wide + 6, 0);
  publish(o->folder, "difference", all);
  printf("pixels more than 1/255 apart: %d of %d; of the others the farthest, "
         "in 1/255: %.4f\n",
         beyond, wide * high, 255 * (double)worst);
}

// Each pixel as a square of `times` pixels.
static image magnified(output *o, image from, int times) {
  image im = image_new(&o->mem, from.width * times, from.height * times);
  for (int i = 0; i < im.width * im.height; i++)
    im.pixels[i] =
        from.pixels[i / im.width / times * from.width + i % im.width / times];
  return im;
}

static void paint_edges(output *o) {
  stage *s = difference_stage(o);
  camera_view v =
      view_of((vec3){0, 1.2f, 7}, (vec3){0, -0.1f, 0}, 28, 160, 120);
  raster_settings set = {.width = 160, .height = 120, .lights = true};
  set.x0 = 66, set.y0 = 40, set.x1 = 106, set.y1 = 70;
  image both = paper(&o->mem, 486, 180);
  for (int k = 0; k < 2; k++) {
    set.msaa = k == 0 ? 1 : 4;
    paste(both, magnified(o, draw(o, &s->scene, &v, &set), 6), 246 * k, 0);
  }
  publish(o->folder, "edges", both);
}

// A ball on a floor under one lamp, with a small map so that its texels show.
static void paint_acne(output *o) {
  stage *s = stage_new(o);
  s->materials[0] = shiny(vec3_all(0.6f), 0, 0);
  s->materials[1] = shiny((vec3){0.6f, 0.35f, 0.2f}, 0, 0);
  stage_floor(s, -1, 6, 0);
  stage_ball(o, s, (vec3){0, 0, 0}, 3, true, 1);
  s->lights[0] = (light){LIGHT_POINT, {-3, 3.2f, 2.5f}, vec3_all(60)};
  s->scene.light_count = 1;
  const char *const offsets[4] = {"0.0", "7.0", "2.0", "2.0"};
  image all = paper(&o->mem, 4 * 120 + 9, 120);
  camera_view v =
      view_of((vec3){1, 2.2f, 7}, (vec3){0.3f, -0.4f, 0}, 30, 120, 120);
  for (int k = 0; k < 4; k++) {
    raster_settings set = {.width = 120,
                           .height = 120,
                           .msaa = 4,
                           .lights = true,
                           .shadows = true,
                           .shadow_size = k < 3 ? 128 : 0};
    set.ambient.defines =
        arena_format(&o->mem, "#define SHADOW_OFFSET %s\n", offsets[k]);
    paste(all, draw(o, &s->scene, &v, &set), 123 * k, 0);
  }
  publish(o->folder, "acne", all);
}

// Six views from the lamp of the garden, as depths: what its layers hold.
static void paint_layers(output *o) {
  scene s = garden_of(o);
  const vec3 ahead[6] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                         {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
  image all = paper(&o->mem, 3 * 158 + 6, 2 * 158 + 3);
  raster_settings set = {
      .width = 158, .height = 158, .msaa = 1, .shading = RASTER_DEPTH};
  for (int k = 0; k < 6; k++) {
    camera c = {.eye = s.lights[0].at, .fov_deg = 90, .up = {0, 1, 0}};
    if (ahead[k].y != 0) c.up = (vec3){0, 0, 1};
    c.target = vec3_add(c.eye, ahead[k]);
    camera_view v;
    error err;
    if (!camera_view_of(&v, &c, 158, 158, &err)) give_up(&err, 2);
    image im = draw(o, &s, &v, &set);
    // Darker is nearer; the square root of the linear depth shows more.
    for (int i = 0; i < 158 * 158; i++)
      im.pixels[i] = vec3_all(im.pixels[i].x);
    paste(all, im, k / 2 * 161, k % 2 * 161);
  }
  publish(o->folder, "layers", all);
}

static void cost_table(output *o) {
  scene s = garden_of(o);
  camera_view v;
  error err;
  const camera *c = scene_camera(&s, NULL);
  if (!camera_view_of(&v, c, 960, 540, &err)) give_up(&err, 2);
  raster_settings set = {.width = 960, .height = 540, .msaa = 1, .sky = true};
  printf("garden, %zu triangles, 960x540; opening %s took %.1f ms\n",
         s.mesh.triangle_count, gl_backend_name(o->g), 1e3 * o->opened);
  printf("%-18s %7s %7s %7s %7s %7s  ms\n", "", "upload", "compile", "shadow",
         "first", "next");
  time_garden(o, &s, &v, set, "no lights");
  set.lights = true;
  time_garden(o, &s, &v, set, "two lights");
  set.shadows = true;
  time_garden(o, &s, &v, set, "and shadows");
  set.msaa = 4;
  time_garden(o, &s, &v, set, "and four samples");
}

int main(int argc, char **argv) {
  output o = {argc > 1 ? argv[1] : ".", {0}, NULL, 0};
  error err;
  double start = clock_seconds();
  if (!gl_open(&o.g, GL_BACKEND_AUTO, &o.mem, &err)) give_up(&err, 5);
  o.opened = clock_seconds() - start;
  cost_table(&o);
  paint_models(&o);
  paint_garden(&o);
  paint_difference(&o);
  paint_edges(&o);
  paint_acne(&o);
  paint_layers(&o);
  gl_close(o.g);
  arena_free(&o.mem);
  return 0;
}

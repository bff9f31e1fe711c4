// figures.c — the pictures of chapter 11, and the tables that its text quotes.

#include "../../tests/solids.h"
#include "../easel.h"
#include "bsdf_rough.h"
#include "clock.h"
#include "ibl_source.h"
#include "num.h"
#include "raster.h"
#include "raster_env.h"
#include "raster_lean.h"

#include <stdio.h>
#include <stdlib.h>

// Steps of roughness from 0 to 1 where lengths are known.
enum { LENGTHS = 101 };

// Where the pictures go, the tables, and what draws.
typedef struct gallery {
  const char *folder;
  arena mem;
  pool *threads;
  dfg table[2];  // by pbr_model
  lean lobes;
  float length[LENGTHS];  // of the mean of a lobe seen head-on, by roughness
  gl *g;
  raster_rough rough[2];
  raster_lean lean;
} gallery;

// Write a picture, every pixel times gain.
static void hang(gallery *o, const char *name, image im, float gain) {
  image out = image_new(&o->mem, im.width, im.height);
  for (int i = 0; i < im.width * im.height; i++)
    out.pixels[i] = vec3_scale(im.pixels[i], gain);
  publish(o->folder, name, out);
}

// The roughnesses of pictures and tables.
enum { STEPS = 6 };
static const float ROUGH[STEPS] = {0.1f, 0.2f, 0.35f, 0.5f, 0.75f, 1};

// An environment, its sums by one set of formulas or both, and what the truth
// reads: the same light, suns apart.
typedef struct daylight {
  env env, rest;
  ibl ibl[2], calm;  // calm: of rest, where there are suns
  ibl_source source;
} daylight;

static daylight *daylight_new(gallery *o, env e, int models) {
  daylight *l = ARENA_NEW(&o->mem, daylight, 1);
  l->env = e;
  ibl_source_make(&l->source, &l->env, &o->mem, o->threads);
  l->rest = (env){.kind = ENV_MAP, .map = l->source.map, .scale = 1};
  ibl_need need = {.diffuse = true, .all = true};
  for (int model = 0; model < models; model++) {
    need.model = (pbr_model)model;
    ibl_make(&l->ibl[model], &l->env, &need, &o->mem, o->threads);
  }
  need.model = PBR_GGX;
  if (l->source.sun_count > 0)
    ibl_make(&l->calm, &l->rest, &need, &o->mem, o->threads);
  return l;
}

// A map by height, and a sun of that radiance in one texel.
static env map_of(gallery *o, vec3 (*of)(float y), float sun) {
  const int w = 1024, h = 512;
  env e = {.kind = ENV_MAP, .map = image_new(&o->mem, w, h), .scale = 1};
  for (int i = 0; i < w * h; i++) {
    vec2 uv = {((float)(i % w) + 0.5f) / (float)w,
               ((float)(i / w) + 0.5f) / (float)h};
    e.map.pixels[i] = of(env_direction(uv).y);
  }
  vec3 *at = &e.map.pixels[150 * w + 920];
  *at = vec3_add(*at, vec3_all(sun));
  return e;
}

static vec3 white(float y) {
  (void)y;
  return vec3_all(1);
}

// Black below, white above.
static vec3 gradient(float y) {
  return vec3_all(0.5f + 0.5f * y);
}

static vec3 blue(float y) {
  return y < 0 ? (vec3){0.2f, 0.2f, 0.2f}
               : vec3_lerp((vec3){0.7f, 0.75f, 0.8f}, (vec3){0.2f, 0.3f, 0.6f},
                           sqrtf(y));
}

// White below, black above.
static vec3 lit_floor(float y) {
  return vec3_all(y < 0 ? 1 : 0);
}

// ---- Light by sums: what paths converge to ----

// What is looked at: a surface, its normal and the viewer; a Fibonacci number,
// and the one before it, for a lattice of so many directions for each lobe.
typedef struct view_of {
  bsdf_rough b;
  vec3 n, wo;
  int points, step;
} view_of;

// The local frame of n, with wo in the plane of t and n.
typedef struct frame {
  vec3 t, b, n, wo;
} frame;

static frame frame_of(vec3 n, vec3 wo) {
  float nv = vec3_dot(n, wo);
  vec3 t = vec3_sub(wo, vec3_scale(n, nv));
  if (vec3_length(t) < 1e-4f)
    t = vec3_cross(n, fabsf(n.x) < 0.5f ? (vec3){1, 0, 0} : (vec3){0, 1, 0});
  t = vec3_unit(t);
  return (frame){t, vec3_cross(n, t), n, {sqrtf(1 - nv * nv), 0, nv}};
}

static vec3 frame_out(const frame *f, vec3 d) {
  return vec3_mad(vec3_mad(vec3_scale(f->t, d.x), d.y, f->b), d.z, f->n);
}

static float lattice_turn(const view_of *v, int i) {
  return (float)(i * v->step % v->points) / (float)v->points;
}

// Light by the visible normals.
static vec3 truth_coat(const view_of *v, const frame *f, const env *e) {
  const rough_terms *s = &v->b.terms;
  vec3 sum = {0, 0, 0};
  for (int i = 0; i < v->points; i++) {
    float x = 1 - ((float)i + 0.5f) / (float)v->points;
    float u2 = lattice_turn(v, i);
    vec3 h = ggx_visible_normal(f->wo, s->alpha, 1 - x * x, u2);
    vec3 wi = vec3_sub(vec3_scale(h, 2 * vec3_dot(f->wo, h)), f->wo);
    if (!(wi.z > 0)) continue;
    half_angles a = half_angles_of((vec3){0, 0, 1}, f->wo, wi);
    float g = rough_v(s, a) * a.nl / ggx_g1_over_4nv(a.nv, s->alpha);
    vec3 reflected = vec3_scale(fresnel_schlick(s->f0, a.oh), 2 * x * g);
    vec3 seen = env_radiance(e, frame_out(f, wi));
    sum = vec3_add(sum, vec3_mul(reflected, seen));
  }
  return vec3_scale(sum, 1 / (float)v->points);
}

// f without the coat.
static vec3 ground_at(const bsdf_rough *b, half_angles a) {
  dfg_pair l = dfg_lookup(b->table, a.nl, b->roughness);
  dfg_pair v = dfg_lookup(b->table, a.nv, b->roughness);
  return rough_diffuse(&b->terms, a, DIELECTRIC_F0 * l.c1 + l.c2,
                       DIELECTRIC_F0 * v.c1 + v.c2);
}

static vec3 truth_ground(const view_of *v, const frame *f, const env *e) {
  vec3 sum = {0, 0, 0};
  if (!(vec3_peak(v->b.terms.kd) > 0)) return sum;
  for (int i = 0; i < v->points; i++) {
    float c2 = ((float)i + 0.5f) / (float)v->points, s = sqrtf(1 - c2);
    vec2 around = num_circle(lattice_turn(v, i));
    vec3 wi = {s * around.x, s * around.y, sqrtf(c2)};
    half_angles a = half_angles_of((vec3){0, 0, 1}, f->wo, wi);
    sum = vec3_add(
        sum, vec3_mul(ground_at(&v->b, a), env_radiance(e, frame_out(f, wi))));
  }
  return vec3_scale(sum, PI / (float)v->points);
}

// A direction in the frame.
static vec3 frame_in(const frame *f, vec3 d) {
  return (vec3){vec3_dot(d, f->t), vec3_dot(d, f->b), vec3_dot(d, f->n)};
}

// The light of the suns that the coat sends to the viewer.
static vec3 sun_coat(const view_of *v, const daylight *l) {
  frame f = frame_of(v->n, v->wo);
  vec3 sum = {0, 0, 0};
  for (int i = 0; i < l->source.sun_count; i++) {
    vec3 wi = frame_in(&f, l->source.suns[i].direction);
    if (!(wi.z > 0)) continue;
    half_angles a = half_angles_of((vec3){0, 0, 1}, f.wo, wi);
    vec3 seen = vec3_scale(rough_specular(&v->b.terms, a), wi.z);
    sum = vec3_add(sum, vec3_mul(seen, l->source.suns[i].power));
  }
  return sum;
}

// That which the ground does.
static vec3 sun_ground(const view_of *v, const daylight *l) {
  frame f = frame_of(v->n, v->wo);
  vec3 sum = {0, 0, 0};
  for (int i = 0; i < l->source.sun_count; i++) {
    vec3 wi = frame_in(&f, l->source.suns[i].direction);
    if (!(wi.z > 0)) continue;
    half_angles a = half_angles_of((vec3){0, 0, 1}, f.wo, wi);
    vec3 seen = vec3_scale(ground_at(&v->b, a), wi.z);
    sum = vec3_add(sum, vec3_mul(seen, l->source.suns[i].power));
  }
  return sum;
}

static vec3 true_ground(const view_of *v, const daylight *l) {
  frame f = frame_of(v->n, v->wo);
  return vec3_add(truth_ground(v, &f, &l->rest), sun_ground(v, l));
}

// The light that an unobstructed surface sends to the viewer.
static vec3 truth(const view_of *v, const daylight *l) {
  frame f = frame_of(v->n, v->wo);
  vec3 coat = vec3_add(truth_coat(v, &f, &l->rest), sun_coat(v, l));
  return vec3_add(coat, true_ground(v, l));
}

// ---- What the rasteriser does, in C ----

// Ways to do without the integral.
typedef enum method {
  REPORT,      // the report's split sum
  SPLIT,       // that of ggx: mirror direction
  POLYNOMIAL,  // a direction between it and the normal, by roughness alone
  LEAN,        // the mean direction
  LENGTH,      // and the roughness whose mean is as long
  GROUND,      // LEAN, with the true light on the ground
  LAMP,        // LEAN without the suns, and these as lamps
  METHODS
} method;

static pbr_model model_of(method how) {
  return how == REPORT ? PBR_REPORT : PBR_GGX;
}

static void measure_lengths(gallery *o) {
  for (int i = 0; i < LENGTHS; i++) {
    float r = (float)i / (LENGTHS - 1);
    lean_pair p = lean_integral(1, r);
    dfg_pair e = dfg_lookup(&o->table[PBR_GGX], 1, r);
    o->length[i] = (p.r1 + p.n1 + p.r2 + p.n2) / (e.c1 + e.c2);
  }
}

// The roughness of a lobe whose mean has that length, at most 1.
static float roughness_of(const gallery *o, float length) {
  int i = 0;
  while (i < LENGTHS - 2 && o->length[i + 1] > length)
    i++;
  float a = o->length[i], b = o->length[i + 1];
  float t = fminf(fmaxf((a - length) / (a - b), 0), 1);
  return ((float)i + t) / (LENGTHS - 1);
}

// Where light is looked up, and for which roughness.
typedef struct reading {
  vec3 towards;
  float roughness;
} reading;

static reading reading_of(const gallery *o, const view_of *v, method how) {
  float nv = vec3_dot(v->n, v->wo), r = v->b.roughness;
  vec3 f = v->b.terms.f0;
  float f0 = (f.x + f.y + f.z) / 3;
  vec3 mirrored = vec3_sub(vec3_scale(v->n, 2 * nv), v->wo);
  if (how == REPORT || how == SPLIT) return (reading){mirrored, r};
  // Source: Lagarde and de Rousiers 2014, section 4.9.3.
  float share = (1 - r) * (sqrtf(1 - r) + r);
  if (how == POLYNOMIAL)
    return (reading){vec3_unit(vec3_lerp(v->n, mirrored, share)), r};
  reading at = {lean_towards(&o->lobes, v->n, v->wo, f0, r), r};
  if (how != LENGTH) return at;
  lean_pair p = lean_lookup(&o->lobes, nv, r);
  dfg_pair e = dfg_lookup(v->b.table, nv, r);
  vec3 mean =
      vec3_mad(vec3_scale(mirrored, f0 * p.r1 + p.r2), f0 * p.n1 + p.n2, v->n);
  at.roughness = roughness_of(o, vec3_length(mean) / (f0 * e.c1 + e.c2));
  return at;
}

// The ground by the split sum.
static vec3 split_ground(const view_of *v, const ibl *sums, method how) {
  const rough_terms *s = &v->b.terms;
  float nv = vec3_dot(v->n, v->wo), r = v->b.roughness, m = 1 - nv;
  dfg_pair p = dfg_lookup(v->b.table, nv, r);
  vec3 rest = vec3_all(1 - DIELECTRIC_F0 * p.c1 - p.c2);
  vec3 top = vec3_max(vec3_all(1 - r), s->f0);
  if (how == REPORT)
    rest = vec3_sub(vec3_all(1), vec3_lerp(s->f0, top, m * m * m * m * m));
  return vec3_scale(vec3_mul(vec3_mul(s->kd, rest), ibl_irradiance(sums, v->n)),
                    1 / PI);
}

static vec3 approximate(const gallery *o, const view_of *v, const daylight *l,
                        method how) {
  bool lamps = how == LAMP && l->source.sun_count > 0;
  const ibl *sums = lamps ? &l->calm : &l->ibl[model_of(how)];
  dfg_pair p = dfg_lookup(v->b.table, vec3_dot(v->n, v->wo), v->b.roughness);
  reading at = reading_of(o, v, how);
  vec3 coat = vec3_add(vec3_scale(v->b.terms.f0, p.c1), vec3_all(p.c2));
  coat = vec3_mul(coat, ibl_radiance(sums, at.towards, at.roughness));
  vec3 ground = how == GROUND ? true_ground(v, l) : split_ground(v, sums, how);
  vec3 sum = vec3_add(ground, coat);
  if (!lamps) return sum;
  return vec3_add(sum, vec3_add(sun_coat(v, l), sun_ground(v, l)));
}

// ---- The table of errors ----

enum { NORMALS = 987 };

// One row of the table: a set of formulas, metallic, a roughness.
typedef struct row {
  const gallery *o;
  const daylight *l;
  float metallic, roughness;
  double off[NORMALS][METHODS], all[NORMALS][2];
} row;

static double square(vec3 a) {
  return (double)vec3_dot(a, a);
}

// Normals that are seen along z, all cosines alike often.
static void row_normal(void *context, size_t i, int worker) {
  (void)worker;
  row *w = context;
  float z = ((float)i + 0.5f) / NORMALS, s = sqrtf(1 - z * z);
  vec2 c = num_circle((float)(i * 610 % 987) / 987);
  const vec3 color = {0.8f, 0.6f, 0.3f};
  for (int model = 0; model < 2; model++) {
    view_of v = {
        bsdf_rough_of(&w->o->table[model], color, w->metallic, w->roughness),
        {s * c.x, s * c.y, z},
        {0, 0, 1},
        144,
        89};
    vec3 t = truth(&v, w->l);
    w->all[i][model] = square(t);
    for (int how = 0; how < METHODS; how++)
      if (model_of((method)how) == (pbr_model)model) {
        vec3 got = approximate(w->o, &v, w->l, (method)how);
        w->off[i][how] = square(vec3_sub(got, t));
      }
  }
}

// Root mean square errors over the root mean square of the truth.
typedef struct errors {
  double of[METHODS][STEPS];
} errors;

static errors errors_under(gallery *o, const daylight *l, float metallic) {
  errors e;
  row *w = ARENA_NEW(&o->mem, row, 1);
  for (int k = 0; k < STEPS; k++) {
    double off[METHODS] = {0}, all[2] = {0};
    *w = (row){.o = o, .l = l, .metallic = metallic, .roughness = ROUGH[k]};
    pool_run(o->threads, NORMALS, row_normal, w);
    for (int i = 0; i < NORMALS; i++) {
      for (int how = 0; how < METHODS; how++)
        off[how] += w->off[i][how];
      for (int model = 0; model < 2; model++)
        all[model] += w->all[i][model];
    }
    for (int how = 0; how < METHODS; how++)
      e.of[how][k] = sqrt(off[how] / all[model_of((method)how)]);
  }
  return e;
}

static void print_errors(const char *name, const errors *e) {
  static const char *const names[METHODS] = {
      "report", "split", "polynomial", "lean", "length", "ground", "lamp"};
  for (int how = 0; how < METHODS; how++) {
    printf("%-14s %-10s", name, names[how]);
    for (int k = 0; k < STEPS; k++)
      printf(" %.3f", e->of[how][k]);
    printf("\n");
  }
}

// ---- Curves ----

static void dot(image im, float x, float y, int size, vec3 color) {
  for (int j = -size; j <= size; j++)
    for (int i = -size; i <= size; i++) {
      int px = (int)(x + 0.5f) + i, py = (int)(y + 0.5f) + j;
      if (i * i + j * j > size * size + 1) continue;
      if (px < 0 || py < 0 || px >= im.width || py >= im.height) continue;
      im.pixels[py * im.width + px] = color;
    }
}

static void line(image im, vec2 a, vec2 b, int size, vec3 color) {
  float length = fmaxf(fabsf(b.x - a.x), fabsf(b.y - a.y));
  for (int i = 0; i <= (int)(2 * length) + 1; i++) {
    float t = (float)i / (2 * length + 1);
    dot(im, a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), size, color);
  }
}

static const vec3 COLORS[METHODS] = {[REPORT] = {0.65f, 0.65f, 0.65f},
                                     [SPLIT] = {0.75f, 0.08f, 0.05f},
                                     [LEAN] = {0.02f, 0.3f, 0.08f}};

// Errors from 0.001 to 1, three decades; roughness 0 to 1 to the right.
static image plot(gallery *o, const errors *e) {
  image im = paper(&o->mem, 238, 178);
  const float x0 = 6, y0 = 5, w = 226, h = 168;
  for (int i = 0; i <= 3; i++) {
    float y = y0 + h * (float)i / 3;
    line(im, (vec2){x0, y}, (vec2){x0 + w, y}, 0, vec3_all(0.7f));
  }
  for (int i = 0; i <= 4; i++) {
    float x = x0 + w * (float)i / 4;
    line(im, (vec2){x, y0}, (vec2){x, y0 + h}, 0, vec3_all(0.7f));
  }
  const method drawn[3] = {REPORT, SPLIT, LEAN};
  for (int i = 0; i < 3; i++) {
    method how = drawn[i];
    vec2 last = {0, 0};
    for (int k = 0; k < STEPS; k++) {
      float decades = -num_log2((float)fmax(e->of[how][k], 1e-3)) * 0.30103f;
      vec2 at = {x0 + w * ROUGH[k], y0 + h * fmaxf(decades, 0) / 3};
      if (k > 0) line(im, last, at, 1, COLORS[how]);
      dot(im, at.x, at.y, 3, COLORS[how]);
      last = at;
    }
  }
  return im;
}

static void draw_errors(gallery *o) {
  image all = paper(&o->mem, 480, 360);
  printf("rms error at roughness   ");
  for (int k = 0; k < STEPS; k++)
    printf(" %.2f", (double)ROUGH[k]);
  printf("\n");
  static const char *const names[6] = {"gradient, 0",  "gradient, 1",
                                       "sky + sun, 0", "sky + sun, 1",
                                       "built-in, 0",  "built-in, 1"};
  daylight *l[3] = {daylight_new(o, map_of(o, gradient, 0), 2),
                    daylight_new(o, map_of(o, blue, 1.6e5f), 2),
                    daylight_new(o, (env){.kind = ENV_SKY, .scale = 1}, 2)};
  for (int i = 0; i < 6; i++) {
    errors e = errors_under(o, l[i / 2], (float)(i % 2));
    print_errors(names[i], &e);
    if (i < 4) paste(all, plot(o, &e), i % 2 * 242, i / 2 * 182);
  }
  hang(o, "errors", all, 1);
}

// ---- Lobes ----

// f nl of a metal in the plane of incidence, light at that angle to the
// normal, away from the viewer.
static float lobe_in_plane(const bsdf_rough *b, float nv, float angle) {
  vec2 c = num_circle(fabsf(angle) / (2 * PI));
  vec3 wo = {-sqrtf(1 - nv * nv), 0, nv};
  vec3 wi = {angle < 0 ? -c.y : c.y, 0, c.x};
  return wi.z > 0 ? bsdf_rough_eval(b, wo, wi).x * wi.z : 0;
}

// A curve of the length `of` over all angles, from the middle of the bottom.
typedef struct polar {
  image im;
  float x, y, scale;
} polar;

static vec2 polar_at(const polar *p, float angle, float length) {
  vec2 c = num_circle(fabsf(angle) / (2 * PI));
  float side = angle < 0 ? -c.y : c.y;
  return (vec2){p->x + p->scale * length * side,
                p->y - p->scale * length * c.x};
}

static void polar_ray(const polar *p, float angle, float length, vec3 color) {
  line(p->im, (vec2){p->x, p->y}, polar_at(p, angle, length), 0, color);
}

// The lobe of roughness r seen at 60 degrees, black; that seen head-on, about
// the mirror direction, red, and about the mean, green, of the same albedo.
static image lobe_sheet(gallery *o, float r, float scale) {
  polar p = {paper(&o->mem, 238, 150), 90, 140, 0};
  const float nv = 0.5f, up = PI / 3;
  bsdf_rough b = bsdf_rough_of(&o->table[PBR_GGX], vec3_all(1), 1, r);
  dfg_pair e = dfg_lookup(b.table, nv, r), head = dfg_lookup(b.table, 1, r);
  float share = (e.c1 + e.c2) / (head.c1 + head.c2);
  vec3 n = {0, 0, 1}, wo = {-sqrtf(1 - nv * nv), 0, nv};
  vec3 d = lean_towards(&o->lobes, n, wo, 1, r);
  float mean = PI * num_acos_pi(d.z), about[3] = {up, mean, 0};
  p.scale = scale;
  line(p.im, (vec2){4, p.y}, (vec2){234, p.y}, 0, vec3_all(0.5f));
  p.scale = 100;
  polar_ray(&p, 0, 1.3f, vec3_all(0.7f));
  polar_ray(&p, -up, 0.8f, vec3_all(0.7f));
  polar_ray(&p, up, 1.5f, COLORS[SPLIT]);
  polar_ray(&p, mean, 1.5f, COLORS[LEAN]);
  p.scale = scale;
  const vec3 colors[3] = {COLORS[SPLIT], COLORS[LEAN], {0, 0, 0}};
  for (int k = 0; k < 3; k++) {
    vec2 last = {p.x, p.y};
    for (int i = -180; i <= 180; i++) {
      float angle = (float)i * PI / 180, off = angle - about[k];
      float f = k == 2 ? lobe_in_plane(&b, nv, angle)
                       : share * lobe_in_plane(&b, 1, off);
      if (k < 2 && fabsf(off) > PI / 2) f = 0;
      vec2 at = polar_at(&p, angle, f);
      line(p.im, last, at, 1, colors[k]);
      last = at;
    }
  }
  return p.im;
}

static void draw_lobes(gallery *o) {
  image all = paper(&o->mem, 480, 150);
  paste(all, lobe_sheet(o, 0.5f, 60), 0, 0);
  paste(all, lobe_sheet(o, 0.75f, 170), 242, 0);
  hang(o, "lobes", all, 1);
}

// ---- Balls by both engines ----

enum { BALL = 72 };

// A scene of one ball, and a view of it.
typedef struct stage {
  scene scene;
  material material;
  camera_view view;
} stage;

static stage *stage_new(gallery *o, const env *e, vec3 color) {
  stage *s = ARENA_NEW(&o->mem, stage, 1);
  solid ball = solid_icosphere(&o->mem, 5);
  mesh *m = &s->scene.mesh;
  m->positions = ball.p, m->normals = ball.n;
  m->position_index = m->normal_index = ball.index;
  m->position_count = m->normal_count = ball.vertices;
  m->triangle_count = ball.triangles;
  mesh_bounds(m, &s->scene.lo, &s->scene.hi);
  s->scene.material_of = ARENA_NEW(&o->mem, uint32_t, ball.triangles);
  s->material =
      (material){.kind = MATERIAL_METAL_ROUGH, .kd = color, .d = 1, .ni = 1.5f};
  s->scene.materials = &s->material;
  s->scene.material_count = 1;
  s->scene.env = *e;
  camera c = {.eye = {0, 1.5f, 12}, .up = {0, 1, 0}, .fov_deg = 10.2f};
  error err;
  if (!camera_view_of(&s->view, &c, BALL, BALL, &err)) give_up(&err, 2);
  return s;
}

// What is drawn: a ball by one method, or what is true of it.
typedef struct shot {
  const daylight *l;
  stage *s;
  float metallic, roughness;
} shot;

// The ball by the raster engine; its normals where asked.
static image raster_ball(gallery *o, const shot *k, method how,
                         image *normals) {
  raster *r;
  error err;
  pbr_model model = how == REPORT ? PBR_REPORT : PBR_GGX;
  raster_env e = raster_env_new(o->g, &k->l->ibl[model], &o->mem);
  raster_settings set = {
      .width = BALL,
      .height = BALL,
      .msaa = 1,
      .sky = true,
      .model = how == REPORT ? RASTER_REPORT : RASTER_GGX,
      .ambient = raster_env_piece(&e),
      .metal_rough = how == LEAN ? raster_lean_piece(&o->lean)
                                 : raster_rough_piece(&o->rough[model])};
  k->s->material.metallic = k->metallic;
  k->s->material.roughness = k->roughness;
  if (!raster_new(&r, o->g, &k->s->scene, &set, &o->mem, &err) ||
      !raster_draw(r, &k->s->view, &err))
    give_up(&err, 5);
  image im = raster_read(r, &o->mem);
  if (normals != NULL &&
      !raster_read_aov(normals, r, RASTER_NORMAL, &o->mem, &err))
    give_up(&err, 5);
  raster_free(r);
  raster_env_free(o->g, &e);
  return im;
}

// The truth about the same pixels, of which the raster engine says which
// normal they have, as its threads compute it.
typedef struct truth_job {
  const gallery *o;
  const shot *k;
  pbr_model model;
  image normals, out;
} truth_job;

static void truth_row(void *context, size_t y, int worker) {
  (void)worker;
  const truth_job *j = context;
  const stage *s = j->k->s;
  for (size_t x = 0; x < BALL; x++) {
    vec3 n = j->normals.pixels[y * BALL + x];
    ray r = camera_ray(&s->view, (float)x + 0.5f, (float)y + 0.5f);
    vec3 d = vec3_unit(r.d);
    vec3 *to = &j->out.pixels[y * BALL + x];
    *to = env_radiance(&j->k->l->env, d);
    if (!(vec3_length(n) > 0.9f)) continue;
    view_of v = {bsdf_rough_of(&j->o->table[j->model], s->material.kd,
                               j->k->metallic, j->k->roughness),
                 vec3_unit(n), vec3_neg(d), 377, 233};
    if (!(vec3_dot(v.n, v.wo) > 1e-3f)) continue;
    *to = truth(&v, j->k->l);
  }
}

static image true_ball(gallery *o, const shot *k, pbr_model model,
                       image normals) {
  truth_job j = {o, k, model, normals, image_new(&o->mem, BALL, BALL)};
  pool_run(o->threads, BALL, truth_row, &j);
  return j.out;
}

static image difference(gallery *o, image a, image b, float gain) {
  image im = image_new(&o->mem, a.width, a.height);
  for (int i = 0; i < a.width * a.height; i++) {
    vec3 d = vec3_sub(a.pixels[i], b.pixels[i]);
    im.pixels[i] = vec3_scale(vec3_abs(d), gain);
  }
  return im;
}

// Truth, lobes that lean, split sum, and four times the differences of both,
// downwards; roughness to the right.
static void draw_twins(gallery *o, const char *name, vec3 color,
                       float metallic) {
  image all = image_new(&o->mem, STEPS * BALL, 5 * BALL);
  shot k = {.metallic = metallic};
  k.l = daylight_new(o, (env){.kind = ENV_SKY, .scale = 1}, 1);
  k.s = stage_new(o, &k.l->env, color);
  for (int i = 0; i < STEPS; i++) {
    image normals, part[5];
    k.roughness = ROUGH[i];
    part[1] = raster_ball(o, &k, LEAN, &normals);
    part[2] = raster_ball(o, &k, SPLIT, NULL);
    part[0] = true_ball(o, &k, PBR_GGX, normals);
    part[3] = difference(o, part[1], part[0], 4);
    part[4] = difference(o, part[2], part[0], 4);
    for (int y = 0; y < 5; y++)
      paste(all, part[y], i * BALL, y * BALL);
  }
  hang(o, name, all, 0.8f);
}

// White balls in a white furnace: raster and truth of ggx, plastic and metal;
// the same plastic by the report.
static void draw_furnace(gallery *o) {
  const float rough[STEPS] = {0.01f, 0.2f, 0.4f, 0.6f, 0.8f, 1};
  const method how[5] = {LEAN, LEAN, LEAN, REPORT, REPORT};
  image all = image_new(&o->mem, STEPS * BALL, 5 * BALL);
  shot k = {.l = daylight_new(o, map_of(o, white, 0), 2)};
  k.s = stage_new(o, &k.l->env, vec3_all(1));
  for (int i = 0; i < 5 * STEPS; i++) {
    image normals;
    int y = i / STEPS;
    k.roughness = rough[i % STEPS];
    k.metallic = y == 1 || y == 2;
    image ball = raster_ball(o, &k, how[y], &normals);
    if (y == 2 || y == 4)
      ball = true_ball(o, &k, y == 4 ? PBR_REPORT : PBR_GGX, normals);
    paste(all, ball, i % STEPS * BALL, y * BALL);
  }
  hang(o, "furnace", all, 0.5f);
}

// Metal over a white floor under a black sky: the truth, split sum, lean.
static void draw_below(gallery *o) {
  image all = image_new(&o->mem, STEPS * BALL, 3 * BALL);
  shot k = {.metallic = 1, .l = daylight_new(o, map_of(o, lit_floor, 0), 1)};
  k.s = stage_new(o, &k.l->env, (vec3){0.95f, 0.8f, 0.6f});
  for (int i = 0; i < STEPS; i++) {
    image normals;
    k.roughness = ROUGH[i];
    paste(all, raster_ball(o, &k, SPLIT, &normals), i * BALL, BALL);
    paste(all, raster_ball(o, &k, LEAN, NULL), i * BALL, 2 * BALL);
    paste(all, true_ball(o, &k, PBR_GGX, normals), i * BALL, 0);
  }
  hang(o, "below", all, 0.8f);
}

// ---- The cost ----

// Seconds of the tables, the least of three.
static void print_seconds(void) {
  double least[2] = {1e9, 1e9};
  for (int i = 0; i < 3; i++) {
    arena once = {0};
    dfg table;
    lean lobes;
    double start = clock_seconds();
    dfg_build(&table, PBR_GGX, &once, NULL);
    double middle = clock_seconds();
    lean_build(&lobes, &once, NULL);
    least[0] = fmin(least[0], middle - start);
    least[1] = fmin(least[1], clock_seconds() - middle);
    arena_free(&once);
  }
  printf("tables, one thread: dfg %.0f ms, lean %.0f ms\n", 1e3 * least[0],
         1e3 * least[1]);
}

int main(int argc, char **argv) {
  gallery o = {.folder = argc > 1 ? argv[1] : "."};
  error err;
  o.threads = pool_new(&o.mem, pool_default_threads());
  dfg_build(&o.table[PBR_GGX], PBR_GGX, &o.mem, o.threads);
  dfg_build(&o.table[PBR_REPORT], PBR_REPORT, &o.mem, o.threads);
  lean_build(&o.lobes, &o.mem, o.threads);
  measure_lengths(&o);
  if (!gl_open(&o.g, GL_BACKEND_AUTO, &o.mem, &err)) give_up(&err, 5);
  for (int model = 0; model < 2; model++)
    o.rough[model] = raster_rough_new(o.g, &o.table[model], &o.mem);
  o.lean = raster_lean_new(o.g, &o.lobes, &o.rough[PBR_GGX]);
  draw_lobes(&o);
  draw_errors(&o);
  draw_twins(&o, "twins-metal", (vec3){0.95f, 0.78f, 0.5f}, 1);
  draw_twins(&o, "twins-plastic", (vec3){0.7f, 0.15f, 0.1f}, 0);
  draw_furnace(&o);
  draw_below(&o);
  print_seconds();
  gl_close(o.g);
  pool_free(o.threads);
  arena_free(&o.mem);
  return 0;
}

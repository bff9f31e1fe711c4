// test_twin.c — metallic-roughness under environments: the rasteriser's
// picture against what paths converge to.

#include "gl_worlds.h"

#include "num.h"
#include "raster_env.h"
#include "raster_lean.h"

enum { SIDE = 48 };

// One smooth ball that fills the picture, and both engines to look at it.
typedef struct stage {
  world *w;
  arena mem;
  gl *g;
  dfg table;
  lean lobes;
  ibl light;
  raster_rough rough;
  raster_lean lean;
  raster_env env;
  camera_view view;
} stage;

static stage *stage_new(pbr_model model, env e) {
  stage *s = calloc(1, sizeof *s);
  s->w = world_new();
  s->w->materials[0] = world_material(MATERIAL_METAL_ROUGH,
                                      (vec3){0.9f, 0.6f, 0.3f}, vec3_all(0));
  world_ball(s->w, (vec3){0, 0, 0}, 1, 5, true, 0);
  world_ready(s->w, 0);
  s->w->scene.env = e;
  s->w->path.max_depth = 2;
  s->g = gl_or_skip(GL_BACKEND_AUTO, &s->mem);
  dfg_build(&s->table, model, &s->mem, NULL);
  lean_build(&s->lobes, &s->mem, NULL);
  s->w->path.dfg = &s->table;
  ibl_need need = {.model = model, .diffuse = true, .all = true};
  ibl_make(&s->light, &s->w->scene.env, &need, &s->mem, NULL);
  s->rough = raster_rough_new(s->g, &s->table, &s->mem);
  s->lean = raster_lean_new(s->g, &s->lobes, &s->rough);
  s->env = raster_env_new(s->g, &s->light, &s->mem);
  s->view = world_view((vec3){0, 0, 12}, (vec3){0, 0, 0}, 9.7f, SIDE, SIDE);
  return s;
}

static void stage_free(stage *s) {
  raster_env_free(s->g, &s->env);
  raster_lean_free(s->g, &s->lean);
  raster_rough_free(s->g, &s->rough);
  world_free(s->w);
  gl_close(s->g);
  arena_free(&s->mem);
  free(s);
}

// The ball as the rasteriser draws it; its normals, 0 where there is none.
static image stage_drawn(stage *s, bool leaning, image *normals) {
  raster *r;
  error err = {{0}};
  raster_settings set = {
      .width = SIDE,
      .height = SIDE,
      .msaa = 1,
      .model = s->table.model == PBR_REPORT ? RASTER_REPORT : RASTER_GGX,
      .ambient = raster_env_piece(&s->env),
      .metal_rough = leaning ? raster_lean_piece(&s->lean)
                             : raster_rough_piece(&s->rough)};
  assert_true(raster_new(&r, s->g, &s->w->scene, &set, &s->mem, &err));
  assert_true(raster_draw(r, &s->view, &err));
  image out = raster_read(r, &s->mem);
  assert_true(raster_read_aov(normals, r, RASTER_NORMAL, &s->mem, &err));
  raster_free(r);
  return out;
}

static ray pixel_ray(const stage *s, int x, int y) {
  return camera_ray(&s->view, (float)x + 0.5f, (float)y + 0.5f);
}

// Calls look for pixels whose surface is well in view, one of `every` in both
// directions, with the cosine to the viewer.
typedef void pixel_visitor(stage *s, int x, int y, float nv, void *context);

static void visit(stage *s, const image *normals, int every,
                  pixel_visitor *look, void *context) {
  for (int y = every / 2; y < SIDE; y += every)
    for (int x = every / 2; x < SIDE; x += every) {
      vec3 n = normals->pixels[y * SIDE + x];
      if (!(vec3_length(n) > 0.9f)) continue;
      float nv = -vec3_dot(vec3_unit(pixel_ray(s, x, y).d), vec3_unit(n));
      if (nv > 0.15f) look(s, x, y, nv, context);
    }
}

// What the report's formulas return of a white sky, by a sum over lights, and
// what its split sum says, of the first channel.
static double report_albedo(const bsdf_rough *b, float nv) {
  const int n = 60;
  vec3 wo = {sqrtf(1 - nv * nv), 0, nv};
  double through = 0;
  for (int i = 0; i < n * n; i++) {
    float c2 = ((float)(i / n) + 0.5f) / (float)n, s = sqrtf(1 - c2);
    vec2 around = num_circle(((float)(i % n) + 0.5f) / (float)n);
    vec3 wi = {s * around.x, s * around.y, sqrtf(c2)};
    half_angles a = half_angles_of((vec3){0, 0, 1}, wo, wi);
    through += (double)(1 - fresnel_schlick(b->terms.f0, a.oh).x) / n / n;
  }
  dfg_pair e = dfg_integral(PBR_REPORT, nv, b->roughness);
  return (double)b->terms.kd.x * through +
         (double)(b->terms.f0.x * e.c1 + e.c2);
}

static double report_split(const bsdf_rough *b, float nv) {
  float f0 = b->terms.f0.x, m = 1 - nv, top = fmaxf(1 - b->roughness, f0);
  dfg_pair e = dfg_integral(PBR_REPORT, nv, b->roughness);
  float ks = f0 + (top - f0) * m * m * m * m * m;
  return (double)(b->terms.kd.x * (1 - ks) + f0 * e.c1 + e.c2);
}

// A picture; departures from what the difference to paths should be: the worst
// beyond 0.003, in standard errors of the paths' mean, and their sum; and the
// most that the difference should be.
typedef struct furnace {
  image drawn;
  bsdf_rough b;
  double worst, sum, most;
  int count;
} furnace;

static void look_into_furnace(stage *s, int x, int y, float nv, void *context) {
  furnace *f = context;
  estimate path = world_radiance(s->w, pixel_ray(s, x, y), shortened(4000),
                                 (uint64_t)(y * SIDE + x));
  double difference = 0;
  if (f->b.terms.model == PBR_REPORT)
    difference = report_split(&f->b, nv) - report_albedo(&f->b, nv);
  double got = (double)f->drawn.pixels[y * SIDE + x].x - path.mean;
  f->worst = fmax(f->worst, (fabs(got - difference) - 0.003) / path.error);
  f->sum += got - difference;
  f->count++;
  f->most = fmax(f->most, fabs(difference));
}

// The white furnace row: raster minus path is 0 where the formulas are the
// same, and where the report's differ it is their difference, within 0.5 % in
// the mean and within the paths' noise everywhere.
static void furnace_row(pbr_model model) {
  arena mem = {0};
  env e = {.kind = ENV_MAP, .map = image_new(&mem, 512, 256), .scale = 1};
  for (int i = 0; i < 512 * 256; i++)
    e.map.pixels[i] = vec3_all(1);
  stage *s = stage_new(model, e);
  material *m = &s->w->materials[0];
  m->kd = vec3_all(1);
  for (int i = 0; i < 12; i++) {
    m->metallic = (float)(i % 2), m->roughness = (float)(i / 2) / 5;
    furnace f = {
        .b = bsdf_rough_of(&s->table, m->kd, m->metallic, m->roughness)};
    image normals;
    f.drawn = stage_drawn(s, model == PBR_GGX, &normals);
    visit(s, &normals, 8, look_into_furnace, &f);
    double mean = f.sum / f.count;
    print_message("# metallic %g, roughness %.1f: difference up to %.2f, mean "
                  "departure %.4f\n",
                  (double)m->metallic, (double)m->roughness, f.most, mean);
    if (getenv("FACET_QUICK") != NULL) continue;
    assert_true(f.worst < 4.5 && fabs(mean) < 0.005);
  }
  stage_free(s);
  arena_free(&mem);
}

static void furnace_of_ggx(void **state) {
  (void)state;
  furnace_row(PBR_GGX);
}

static void furnace_of_the_report(void **state) {
  (void)state;
  furnace_row(PBR_REPORT);
}

// The report's furnace as known: white porcelain returns 1.80 at a cosine of
// 0.03 and roughness 0.01, and 1.21 at 0.25.
static void report_returns_too_much(void **state) {
  (void)state;
  dfg table = {.model = PBR_REPORT};
  arena mem = {0};
  dfg_build(&table, PBR_REPORT, &mem, NULL);
  bsdf_rough b = bsdf_rough_of(&table, vec3_all(1), 0, 0.01f);
  assert_true(fabs(report_albedo(&b, 0.03f) - 1.80) < 0.01);
  assert_true(fabs(report_albedo(&b, 0.25f) - 1.21) < 0.01);
  arena_free(&mem);
}

// Squared distances of two pictures to paths, and squared light.
typedef struct twins {
  image split, leaning;
  double off[2], all;
} twins;

static void compare_twins(stage *s, int x, int y, float nv, void *context) {
  (void)nv;
  twins *t = context;
  double truth = world_radiance(s->w, pixel_ray(s, x, y), shortened(4000),
                                (uint64_t)(y * SIDE + x))
                     .mean;
  double a = (double)t->split.pixels[y * SIDE + x].x - truth;
  double b = (double)t->leaning.pixels[y * SIDE + x].x - truth;
  t->off[0] += a * a;
  t->off[1] += b * b;
  t->all += truth * truth;
}

// Under a sky with a soft sun, metals by lobes that lean are nearer to paths
// than those of the split sum, the rougher the more, and porcelain is as near.
static void leaning_pictures_are_nearer(void **state) {
  (void)state;
  stage *s = stage_new(PBR_GGX, (env){.kind = ENV_SKY, .scale = 1});
  material *m = &s->w->materials[0];
  const float rough[] = {0.2f, 0.35f, 0.5f, 0.75f, 1};
  const double nearer[] = {1, 0.9, 0.9, 0.6, 0.35};
  for (int i = 0; i < 10; i++) {
    m->metallic = (float)(i % 2), m->roughness = rough[i / 2];
    image normals;
    twins t = {.all = 0};
    t.split = stage_drawn(s, false, &normals);
    t.leaning = stage_drawn(s, true, &normals);
    visit(s, &normals, 4, compare_twins, &t);
    double split = sqrt(t.off[0] / t.all), leaning = sqrt(t.off[1] / t.all);
    print_message("# metallic %g, roughness %.2f: %.4f, leaning %.4f\n",
                  (double)m->metallic, (double)m->roughness, split, leaning);
    if (getenv("FACET_QUICK") != NULL) continue;
    assert_true(leaning < 0.1);
    assert_true(leaning < split * (i % 2 == 0 ? 1.05 : nearer[i / 2]));
  }
  stage_free(s);
}

// The shader's sum, in C.
static vec3 in_c(const stage *s, vec3 n, vec3 wo, const bsdf_rough *b) {
  dfg_pair e = dfg_lookup(&s->table, vec3_dot(n, wo), b->roughness);
  vec3 f0 = b->terms.f0;
  vec3 d =
      lean_towards(&s->lobes, n, wo, (f0.x + f0.y + f0.z) / 3, b->roughness);
  vec3 coat = vec3_add(vec3_scale(f0, e.c1), vec3_all(e.c2));
  float rest = 1 - DIELECTRIC_F0 * e.c1 - e.c2;
  vec3 ground = vec3_scale(b->terms.kd, rest / PI);
  return vec3_add(vec3_mul(ground, ibl_irradiance(&s->light, n)),
                  vec3_mul(coat, ibl_radiance(&s->light, d, b->roughness)));
}

// GLSL and C agree about a ball to 1e-3: the table of leaning lobes, and what
// is done with it.
static void shader_is_the_twin(void **state) {
  (void)state;
  stage *s = stage_new(PBR_GGX, (env){.kind = ENV_SKY, .scale = 1});
  material *m = &s->w->materials[0];
  float worst = 0;
  for (int i = 0; i < 6; i++) {
    m->metallic = (float)i / 5, m->roughness = 0.05f + 0.19f * (float)i;
    bsdf_rough b = bsdf_rough_of(&s->table, m->kd, m->metallic, m->roughness);
    image normals, im = stage_drawn(s, true, &normals);
    for (int p = 0; p < SIDE * SIDE; p++) {
      vec3 n = normals.pixels[p];
      if (!(vec3_length(n) > 0.9f)) continue;
      vec3 wo = vec3_neg(vec3_unit(pixel_ray(s, p % SIDE, p / SIDE).d));
      if (!(vec3_dot(n, wo) > 0.05f)) continue;
      vec3 want = in_c(s, vec3_unit(n), wo, &b);
      vec3 off = vec3_abs(vec3_sub(im.pixels[p], want));
      worst = fmaxf(worst, vec3_peak(off));
    }
  }
  print_message("# worst difference %.1e\n", (double)worst);
  assert_true(worst < 1e-3f);
  stage_free(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(furnace_of_ggx),
      cmocka_unit_test(furnace_of_the_report),
      cmocka_unit_test(report_returns_too_much),
      cmocka_unit_test(leaning_pictures_are_nearer),
      cmocka_unit_test(shader_is_the_twin),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

// test_path.c — scenes whose light is known.

#include "matter.h"
#include "num.h"
#include "worlds.h"

#include <string.h>

static const vec3 WHITE = {1, 1, 1}, BLACK = {0, 0, 0};

// A floor of 100 x 100 at y = 0, front up.
static void add_floor(world *w, uint32_t of) {
  world_quad(w, (vec3){-50, 0, 50}, (vec3){100, 0, 0}, (vec3){0, 0, -100}, of);
}

static void white_sky(world *w) {
  w->scene.env = (env){.kind = ENV_CONSTANT, .constant = {1, 1, 1}, .scale = 1};
}

// A ray to the origin from direction (s, c, 0).
static ray down_at(float c) {
  float s = sqrtf(1 - c * c);
  return ray_from((vec3){5 * s, 5 * c, 0}, (vec3){-s, -c, 0});
}

enum { CUBE = -1 };

// A ball of some level or a cube with the normals of a ball, before rays from
// everywhere: the mean, and the farthest that a sample is from both the light
// behind it, 1, and the albedo.
static double furnace(material m, int level, bool smooth, double *mean) {
  double albedo = m.kind == MATERIAL_BLINN_PHONG ? (double)m.kd.x : 1;
  world *w = world_new();
  w->materials[0] = m;
  white_sky(w);
  if (level == CUBE) {
    world_box(w, vec3_all(-1), vec3_all(1), false, 0);
    mesh *cube = &w->scene.mesh;
    for (size_t i = 0; i < cube->position_count; i++)
      cube->normals[i] = vec3_unit(cube->positions[i]);
    memcpy(cube->normal_index, cube->position_index, 36 * sizeof(uint32_t));
  } else {
    world_ball(w, vec3_all(0), 1, level, smooth, 0);
  }
  world_ready(w, 0);
  double worst = 0, sum = 0;
  path_stats stats = {0};
  long n = shortened(40000);
  for (long i = 0; i < n; i++) {
    rng r = rng_of(11, (uint64_t)i, 0);
    vec2 a = num_circle(rng_next(&r)), b = num_circle(0.5f * rng_next(&r));
    vec3 o = {3 * a.x * b.y, 3 * b.x, 3 * a.y * b.y};
    vec3 q = {rng_next(&r) - 0.5f, rng_next(&r) - 0.5f, rng_next(&r) - 0.5f};
    ray at = ray_from(o, vec3_unit(vec3_sub(vec3_scale(q, 1.8f), o)));
    double x = (double)path_naive_radiance(&w->path, at, &r, &stats).x;
    worst = fmax(worst, fmin(fabs(x - 1), fabs(x - albedo)));
    sum += x;
  }
  assert_int_equal(stats.cut, 0);
  world_free(w);
  *mean = sum / (double)n;
  return worst;
}

// Under L = 1 mirrors and glass of any shape, facets or smooth, show L = 1,
// every single sample of them.
static void furnace_of_deltas(void **state) {
  (void)state;
  material mirror = world_material(MATERIAL_MIRROR, BLACK, WHITE);
  material glass = world_material(MATERIAL_GLASS, WHITE, WHITE);
  for (int level = CUBE; level < 5; level += 2)
    for (int smooth = level == CUBE; smooth < 2; smooth++) {
      double mean;
      assert_true(furnace(mirror, level, smooth, &mean) < 1e-4);
      assert_true(furnace(glass, level, smooth, &mean) < 1e-4);
    }
}

// Also a white diffuse body loses nothing, though its interpolated normals
// send light below its facets.
static void furnace_of_white(void **state) {
  (void)state;
  material white = world_material(MATERIAL_BLINN_PHONG, WHITE, BLACK);
  for (int level = CUBE; level < 3; level++)
    for (int smooth = level == CUBE; smooth < 2; smooth++) {
      double mean;
      furnace(white, level, smooth, &mean);
      print_message("# level %d smooth %d: %.6f\n", level, smooth, mean);
      assert_true(fabs(mean - 1) < 1e-3);
    }
}

// A convex body lights itself not: each sample of a grey one is its albedo,
// also where interpolated normals send light below the facet.
static void convex_bodies(void **state) {
  (void)state;
  material grey = world_material(MATERIAL_BLINN_PHONG, vec3_all(0.5f), BLACK);
  for (int level = 0; level < 4; level++)
    for (int smooth = 0; smooth < 2; smooth++) {
      double mean;
      assert_true(furnace(grey, level, smooth, &mean) < 1e-6);
      assert_true(mean > 0.5 && mean < 0.99);
    }
}

// The integral of f cos over all wi for a viewer at cosine cos_o.
static double albedo_of(const bsdf *b, float cos_o) {
  vec3 wo = {sqrtf(1 - cos_o * cos_o), 0, cos_o};
  double sum = 0;
  const int n = 250;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      float z = ((float)i + 0.5f) / (float)n, s = sqrtf(1 - z * z);
      vec2 c = num_circle(((float)j + 0.5f) / (float)n);
      vec3 wi = {s * c.x, s * c.y, z};
      sum += (double)(bsdf_eval(b, wo, wi).x * z) * 2 * (double)PI / (n * n);
    }
  return sum;
}

static void check_albedo(material m, float cos_o, const dfg *table,
                         double want) {
  world *w = world_new();
  w->materials[0] = m;
  white_sky(w);
  add_floor(w, 0);
  world_ready(w, 0);
  if (table != NULL) w->path.dfg = table;
  estimate e = world_radiance(w, down_at(cos_o), shortened(200000), 5);
  print_message("# kind %d cos %.1f: %.5f +- %.5f, expected %.5f\n", m.kind,
                (double)cos_o, e.mean, e.error, want);
  assert_true(fabs(e.mean - want) < 2e-3 * want + 4 * e.error);
  assert_true(shortened(100) < 100 || fabs(e.mean - want) < 5e-3 * want);
  world_free(w);
}

// A plane under L = 1 shows the albedo of its material: every kind.
static void furnace_of_materials(void **state) {
  (void)state;
  vec3 kd = vec3_all(0.4f), ks = vec3_all(0.5f);
  for (float c = 0.2f; c < 1; c += 0.3f) {
    material m = world_material(MATERIAL_BLINN_PHONG, kd, BLACK);
    check_albedo(m, c, NULL, 0.4);
    m.ks = ks;
    m.ns = 20;
    bsdf b = {.kind = BSDF_BLINN_PHONG, .kd = kd, .ks = ks, .ns = 20};
    check_albedo(m, c, NULL, albedo_of(&b, c));
    m.kd = m.ks = vec3_all(0.8f);  // more than 1: scaled to 0.5 each
    b.kd = b.ks = vec3_all(0.5f);
    check_albedo(m, c, NULL, albedo_of(&b, c));
  }
}

// And of metallic-roughness, by both sets of formulas: rough and smooth, and
// with 0.6 of clear glass in front of the white sky.
static void furnace_of_metal_rough(void **state) {
  (void)state;
  arena mem = {0};
  for (int model = PBR_GGX; model <= PBR_REPORT; model++)
    for (float c = 0.2f; c < 1; c += 0.3f) {
      dfg table;
      dfg_build(&table, (pbr_model)model, &mem, NULL);
      material m = world_material(MATERIAL_METAL_ROUGH, vec3_all(0.7f), BLACK);
      m.roughness = 0.5f;
      m.metallic = 0.3f;
      bsdf b = {.kind = BSDF_ROUGH};
      b.rough = bsdf_rough_of(&table, m.kd, 0.3f, 0.5f);
      check_albedo(m, c, &table, albedo_of(&b, c));
      m.tf = vec3_all(0.6f);
      double tinted = sqrt(0.7);
      float ct, r = fresnel_dielectric(c, 1.5f, &ct);
      double through = (double)r + (1 - (double)r) * tinted;
      check_albedo(m, c, &table, 0.6 * through + 0.4 * albedo_of(&b, c));
      m.tf = vec3_all(0);
      m.roughness = 0;
      m.metallic = 1;
      check_albedo(m, c, &table, 0.7 + 0.3 * pow(1 - (double)c, 5));
      m.metallic = 0;
      b.rough = bsdf_rough_of(&table, m.kd, 0, 0);
      double coat = 0.04 + 0.96 * pow(1 - (double)c, 5);
      check_albedo(m, c, &table, coat + albedo_of(&b, c));
    }
  arena_free(&mem);
}

// A white dielectric loses nothing, whatever its roughness: PBR_GGX, on the
// smooth ball whose normals send light below its facets.
static void furnace_of_porcelain(void **state) {
  (void)state;
  for (float r = 0; r < 1.1f; r += 0.25f) {
    material m = world_material(MATERIAL_METAL_ROUGH, WHITE, BLACK);
    m.roughness = r;
    double mean;
    furnace(m, 3, true, &mean);
    print_message("# roughness %.2f: %.5f\n", (double)r, mean);
    assert_true(fabs(mean - 1) < (shortened(100) < 100 ? 0.02 : 2e-3));
  }
}

// A closed room whose walls emit Le = 1 and reflect rho.
static world *glowing_room(float rho) {
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, vec3_all(rho), BLACK);
  w->materials[0].ke = WHITE;
  world_box(w, (vec3){-1, -2, -1}, (vec3){3, 1, 2}, true, 0);
  world_ready(w, 0);
  return w;
}

// In it the radiance is Le / (1 - rho) everywhere: at rho = 0.9 ten bounces
// would lose 31 % and a careless roulette more.
static void glowing_room_fills(void **state) {
  (void)state;
  world *w = glowing_room(0.9f);
  ray r = ray_from((vec3){0.3f, 0.1f, 0.2f}, (vec3){0.48f, 0.6f, 0.64f});
  estimate e = world_radiance(w, r, shortened(800000), 3);
  print_message("# %.5f +- %.5f, expected 10\n", e.mean, e.error);
  assert_true(fabs(e.mean - 10) < fmax(1e-2, 4 * e.error));
  assert_true(fabs(e.mean - 10) < 4 * e.error);
  world_free(w);
}

// max_depth n shows the first n terms of 1 + rho + rho^2 + ...
static void depth_counts_segments(void **state) {
  (void)state;
  world *w = glowing_room(0.9f);
  ray r = ray_from((vec3){0.3f, 0.1f, 0.2f}, (vec3){0.48f, 0.6f, 0.64f});
  double want = 0, term = 1;
  for (int depth = 1; depth < 10; depth++, term *= 0.9) {
    want += term;
    w->path.max_depth = depth;
    estimate e = world_radiance(w, r, 100, 1);
    assert_true(fabs(e.mean - want) < 2e-6 * want);
  }
  world_free(w);
}

// Under a uniform sky with a black ball of radius R, centre at height h and
// distance d, the floor receives E = pi L (1 - R^2 h / d^3).
static void black_ball(void **state) {
  (void)state;
  for (float x = 0; x < 3.5f; x += 1) {
    world *w = world_new();
    w->materials[0] = world_material(MATERIAL_BLINN_PHONG, WHITE, BLACK);
    w->materials[1] = world_material(MATERIAL_BLINN_PHONG, BLACK, BLACK);
    white_sky(w);
    add_floor(w, 0);
    world_ball(w, (vec3){0, 1.5f, 0}, 1, 5, false, 1);
    world_ready(w, 0);
    float d2 = x * x + 1.5f * 1.5f;
    double want = 1 - 1.5 / pow((double)d2, 1.5);
    ray r = ray_from((vec3){x, 0.3f, -3}, (vec3){0, -0.3f, 3});
    estimate e = world_radiance(w, r, shortened(200000), 9);
    double z = (e.mean - want) / e.error;
    print_message("# x = %.0f: %.5f, expected %.5f, z = %.2f\n", (double)x,
                  e.mean, want, z);
    assert_true(fabs(z) < 4);
    world_free(w);
  }
}

// A lamp of 2 x 1 at height 1.2 above the floor gives E = pi L F with the
// form factor of a rectangle; its back is dark.
static void rectangle_lamp(void **state) {
  (void)state;
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, vec3_all(0.5f), BLACK);
  w->materials[1] = world_material(MATERIAL_BLINN_PHONG, BLACK, BLACK);
  w->materials[1].ke = vec3_all(7);
  add_floor(w, 0);
  world_quad(w, (vec3){-1, 1.2f, -0.5f}, (vec3){2, 0, 0}, (vec3){0, 0, 1}, 1);
  world_ready(w, 0);
  double want = 0.5 * 7 * 4 * corner_factor(1, 0.5, 1.2);
  ray r = ray_from((vec3){0, 0.5f, -2}, (vec3){0, -0.5f, 2});
  estimate e = world_radiance(w, r, shortened(400000), 2);
  double z = (e.mean - want) / e.error;
  print_message("# %.5f, expected %.5f, z = %.2f\n", e.mean, want, z);
  assert_true(fabs(z) < 4);
  ray above = ray_from((vec3){0, 5, 0}, (vec3){0, -1, 0});
  assert_true(world_radiance(w, above, 1, 0).mean == 0);
  ray below = ray_from((vec3){0, 0.5f, 0}, (vec3){0, 1, 0});
  assert_true(world_radiance(w, below, 1, 0).mean == 7);
  world_free(w);
}

// One sample of direct light is the formula: f I cos / d^2 for a point light,
// f E cos for a directional one.
static void direct_light(void **state) {
  (void)state;
  vec3 kd = vec3_all(0.6f), ks = vec3_all(0.3f);
  for (int specular = 0; specular < 2; specular++)
    for (float x = 0; x < 3; x += 0.5f) {
      world *w = world_new();
      w->materials[0] = world_material(MATERIAL_BLINN_PHONG, kd, BLACK);
      bsdf b = {.kind = BSDF_LAMBERT, .kd = kd};
      if (specular) {
        w->materials[0].ks = ks;
        w->materials[0].ns = 50;
        b = (bsdf){.kind = BSDF_BLINN_PHONG, .kd = kd, .ks = ks, .ns = 50};
      }
      add_floor(w, 0);
      vec3 at = {x, 2, 0.5f}, travel = {-0.48f, -0.6f, 0.64f};
      w->lights[0] = (light){LIGHT_POINT, at, vec3_all(11)};
      w->lights[1] = (light){LIGHT_DIR, travel, vec3_all(2)};
      world_ready(w, 2);
      w->path.max_depth = 2;
      // z is up in the frame of the BSDF, y in the world.
      vec3 to = vec3_unit(at), wo = {-0.6f, 0, 0.8f};
      double r2 = (double)vec3_dot(at, at);
      double f = (double)bsdf_eval(&b, wo, (vec3){to.x, -to.z, to.y}).x;
      double want = f * 11 * (double)to.y / r2;
      vec3 sun = {0.48f, 0.64f, 0.6f};
      want += (double)bsdf_eval(&b, wo, sun).x * 2 * 0.6;
      ray r = ray_from((vec3){-3, 4, 0}, (vec3){0.6f, -0.8f, 0});
      double got = world_radiance(w, r, 1, 0).mean;
      assert_true(fabs(got - want) < 1e-5 * want);
      w->path.lights = false;
      assert_true(world_radiance(w, r, 1, 0).mean == 0);
      world_free(w);
    }
}

// A sheet of opacity d shows d of itself and 1 - d of what is behind, and
// lets 1 - d of a light through, two sheets (1 - d)^2, a wall nothing; no
// number of sheets uses up the depth.
static void sheets(void **state) {
  (void)state;
  for (int walls = 0; walls < 2; walls++)
    for (int count = 0; count < 3; count++) {
      world *w = world_new();
      material sheet = world_material(MATERIAL_BLINN_PHONG, BLACK, BLACK);
      sheet.d = 0.3f;
      sheet.passes = true;
      w->materials[0] =
          world_material(MATERIAL_BLINN_PHONG, vec3_all(0.5f), BLACK);
      w->materials[1] = sheet;
      w->materials[2] = world_material(MATERIAL_BLINN_PHONG, BLACK, BLACK);
      add_floor(w, 0);
      for (int i = 0; i < count; i++)
        world_quad(w, (vec3){-1, 1 + (float)i, i ? -1 : 1}, (vec3){2, 0, 0},
                   (vec3){0, 0, i ? 2 : -2}, 1);
      if (walls)
        world_quad(w, (vec3){-1, 3, -1}, (vec3){2, 0, 0}, (vec3){0, 0, 2}, 2);
      w->lights[0] = (light){LIGHT_POINT, {0, 4, 0}, vec3_all(16)};
      w->lights[1] = (light){LIGHT_DIR, {0, -1, 0}, vec3_all(1)};
      world_ready(w, 2);
      w->path.max_depth = 2;
      ray r = ray_from((vec3){-3, 0.5f, 0}, (vec3){3, -0.5f, 0});
      double want = walls ? 0 : 2 * 0.5 / 3.14159265 * pow(0.7, count);
      double got = world_radiance(w, r, 1, 0).mean;
      assert_true(fabs(got - want) < 2e-6);
      // From above, through all the sheets, to a floor lit through them.
      ray above = ray_from((vec3){0, 2.9f, 0}, (vec3){0, -1, 0});
      estimate e = world_radiance(w, above, 20000, 1);
      want *= pow(0.7, count);
      assert_true(fabs(e.mean - want) < 5 * e.error + 1e-6);
      world_free(w);
    }
}

// Two mirrors that face each other: the path ends, and was not cut.
static void facing_mirrors(void **state) {
  (void)state;
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_MIRROR, BLACK, WHITE);
  world_box(w, vec3_all(-1), vec3_all(1), true, 0);
  world_ready(w, 0);
  path_stats stats = {0};
  for (uint64_t i = 0; i < 20; i++) {
    rng random = rng_of(0, 0, i);
    ray r = ray_from((vec3){0.1f, 0.2f, 0.3f}, (vec3){0, 1, 0});
    vec3 l = path_naive_radiance(&w->path, r, &random, &stats);
    assert_true(l.x == 0);
  }
  assert_int_equal(stats.cut, 0);
  assert_true(stats.rays > 20 * 4096 && stats.rays < 20 * 14000);
  world_free(w);
}

// A slab of glass, one thick, displaces a ray by what Snell's law says and
// gives it its direction back: a small lamp where it must arrive is seen with
// the light that two surfaces let through.
static void slab_displaces(void **state) {
  (void)state;
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_GLASS, WHITE, WHITE);
  w->materials[1] = world_material(MATERIAL_BLINN_PHONG, BLACK, BLACK);
  w->materials[1].ke = WHITE;
  world_box(w, (vec3){-9, 0, -9}, (vec3){9, 1, 9}, false, 0);
  float sine = 0.70710678f / 1.5f;
  float x = sine / sqrtf(1 - sine * sine) + 1;
  world_quad(w, (vec3){x - 0.01f, -1, 0.01f}, (vec3){0.02f, 0, 0},
             (vec3){0, 0, -0.02f}, 1);
  world_ready(w, 0);
  ray r = ray_from((vec3){-1, 2, 0}, vec3_unit((vec3){1, -1, 0}));
  estimate e = world_radiance(w, r, 20000, 4);
  float cos_t, once = 1 - fresnel_dielectric(0.70710678f, 1.5f, &cos_t);
  assert_true(fabs(e.mean - (double)(once * once)) < 4 * e.error);
  world_free(w);
}

// The tree and the list of all triangles give the same light, to the bit.
static void tree_is_list(void **state) {
  (void)state;
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_BLINN_PHONG, vec3_all(0.7f), BLACK);
  w->materials[1] = world_material(MATERIAL_GLASS, WHITE, WHITE);
  w->scene.env = (env){.kind = ENV_SKY, .scale = 1};
  add_floor(w, 0);
  world_ball(w, (vec3){0, 1, 0}, 1, 1, true, 1);
  w->lights[0] = (light){LIGHT_POINT, {1, 3, 1}, vec3_all(9)};
  world_ready(w, 1);
  path_world list = w->path;
  list.tracer = brute_tracer(&w->tree);
  path_stats stats = {0};
  for (uint64_t i = 0; i < 2000; i++) {
    rng a = rng_of(0, i, 0), b = a;
    ray r = ray_from((vec3){0, 2, 4}, (vec3){(float)(i % 50) / 50 - 0.5f,
                                             (float)(i / 50) / -40, -1});
    vec3 x = path_naive_radiance(&w->path, r, &a, &stats);
    vec3 y = path_naive_radiance(&list, r, &b, &stats);
    assert_true(memcmp(&x, &y, sizeof x) == 0);
  }
  world_free(w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(furnace_of_deltas),
      cmocka_unit_test(furnace_of_white),
      cmocka_unit_test(convex_bodies),
      cmocka_unit_test(furnace_of_materials),
      cmocka_unit_test(furnace_of_metal_rough),
      cmocka_unit_test(furnace_of_porcelain),
      cmocka_unit_test(glowing_room_fills),
      cmocka_unit_test(depth_counts_segments),
      cmocka_unit_test(black_ball),
      cmocka_unit_test(rectangle_lamp),
      cmocka_unit_test(direct_light),
      cmocka_unit_test(sheets),
      cmocka_unit_test(facing_mirrors),
      cmocka_unit_test(slab_displaces),
      cmocka_unit_test(tree_is_list),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

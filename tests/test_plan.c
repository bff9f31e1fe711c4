// Laws of the plan: nothing that can be seen is ever outside of a view, what
// is cut into blocks is all there, and a line says what it means.

#include "worlds.h"

#include "picture_head.h"
#include "plan_use.h"
#include "plan_word.h"

#include <string.h>

// A cloud of triangles, in runs of odd lengths and two materials.
static world *cloud(int triangles, uint64_t seed) {
  world *w = world_new();
  rng r = rng_of(seed, 1, 2);
  w->scene.material_count = 2;
  mesh *m = &w->scene.mesh;
  m->runs = ARENA_NEW(&w->mem, mesh_run, (size_t)triangles);
  for (int t = 0, left = 0; t < triangles; t++) {
    if (left-- == 0) {
      m->runs[m->run_count++].first = (uint32_t)t;
      left = (int)(rng_next(&r) * 40);
    }
    vec3 at = {20 * rng_next(&r) - 10, 20 * rng_next(&r) - 10,
               20 * rng_next(&r) - 10};
    for (size_t k = 0; k < 3; k++) {
      vec3 p = {at.x + rng_next(&r), at.y + rng_next(&r), at.z + rng_next(&r)};
      m->position_index[3 * (size_t)t + k] = world_vertex(w, p);
    }
    w->scene.material_of[t] = rng_next(&r) < 0.1f;
    m->triangle_count++;
  }
  return w;
}

// Every triangle is in one block, of its own material and within its box; no
// block is too large or goes over the end of a run; those of one material
// follow each other.
static void blocks_hold_every_triangle(void **state) {
  (void)state;
  world *w = cloud(5000, 1);
  const scene *s = &w->scene;
  raster_blocks all = raster_blocks_of(s, &w->mem);
  bool *seen = ARENA_NEW(&w->mem, bool, 5000);
  size_t n = 0;
  for (size_t i = 0; i < all.count; i++) {
    const raster_block *b = &all.items[i];
    assert_true(b->count > 0 && b->count <= RASTER_BLOCK_MOST);
    if (i > 0) assert_true(all.items[i - 1].material <= b->material);
    for (uint32_t t = b->first; t < b->first + b->count; t++, n++) {
      assert_false(seen[t]);
      seen[t] = true;
      assert_int_equal(s->material_of[t], b->material);
      for (size_t k = 0; k < 3; k++) {
        vec3 p = s->mesh.positions[s->mesh.position_index[3 * t + k]];
        vec3 low = vec3_min(p, b->lo), high = vec3_max(p, b->hi);
        assert_memory_equal(&low, &b->lo, sizeof low);
        assert_memory_equal(&high, &b->hi, sizeof high);
      }
    }
    for (size_t k = 0; k < s->mesh.run_count; k++) {
      uint32_t start = s->mesh.runs[k].first;
      assert_false(start > b->first && start < b->first + b->count);
    }
  }
  assert_int_equal(n, 5000);
  world_free(w);
}

// A camera somewhere, and a window of its film.
static camera_view some_view(rng *r, int window[4]) {
  camera_view v;
  error err;
  for (;;) {
    camera c = {.eye = {20 * rng_next(r) - 10, 20 * rng_next(r) - 10,
                        20 * rng_next(r) - 10},
                .target = {20 * rng_next(r) - 10, 20 * rng_next(r) - 10,
                           20 * rng_next(r) - 10},
                .up = {0, 1, 0},
                .fov_deg = 5 + 120 * rng_next(r)};
    if (camera_view_of(&v, &c, 64, 48, &err)) break;
  }
  window[0] = (int)(30 * rng_next(r)), window[1] = (int)(20 * rng_next(r));
  window[2] = window[0] + 1 + (int)(30 * rng_next(r));
  window[3] = window[1] + 1 + (int)(25 * rng_next(r));
  return v;
}

// No ray through the window meets a triangle of a block that is outside: of
// the nearest hits, all lie in blocks that are not.  Some blocks are outside.
static void nothing_seen_is_outside(void **state) {
  (void)state;
  world *w = cloud(3000, 2);
  world_ready(w, 0);
  raster_blocks all = raster_blocks_of(&w->scene, &w->mem);
  bool *out = ARENA_NEW(&w->mem, bool, 3000);
  size_t hits = 0, outside = 0;
  for (uint64_t k = 0; k < 60; k++) {
    rng r = rng_of(k, 3, 4);
    int window[4];
    camera_view v = some_view(&r, window);
    raster_frustum f = raster_frustum_of(&v, window);
    for (size_t i = 0; i < all.count; i++) {
      bool is = raster_block_outside(&all.items[i], &f);
      outside += is;
      for (uint32_t t = 0; t < all.items[i].count; t++)
        out[all.items[i].first + t] = is;
    }
    for (int y = window[1]; y < window[3]; y++)
      for (int x = window[0]; x < window[2]; x++) {
        ray q =
            camera_ray(&v, (float)x + rng_next(&r), (float)y + rng_next(&r));
        hit h;
        if (!w->path.tracer.closest(w->path.tracer.tree, &q, &h)) continue;
        assert_false(out[h.triangle]);
        hits++;
      }
  }
  assert_true(hits > 1000 && outside > 10 * all.count);
  world_free(w);
}

// The sides of a camera and those of the matrix that OpenGL gets are the same
// half spaces, but for the rounding of the matrix.
static void both_frusta_agree(void **state) {
  (void)state;
  for (uint64_t k = 0; k < 200; k++) {
    rng r = rng_of(k, 5, 6);
    int w[4];
    camera_view v = some_view(&r, w);
    raster_frustum a = raster_frustum_of(&v, w);
    // Rows of clip x, y and w for positions less the origin.
    vec3 origin = {1, -2, 3}, eye = vec3_sub(v.eye, origin);
    float m[16] = {0};
    for (int i = 0; i < 2; i++) {
      int lo = i == 0 ? w[0] : w[1], hi = i == 0 ? w[2] : w[3];
      vec3 axis = i == 0 ? v.right : v.down;
      float s2 = vec3_dot(axis, axis), scale = 2 / (float)(hi - lo);
      float c = -vec3_dot(v.corner, axis) / s2;
      float along = scale * (c - (float)lo) - 1;
      vec3 row = vec3_scale(axis, scale / s2);
      row = vec3_mad(row, along, v.forward);
      if (i == 1) row = vec3_neg(row);
      m[i] = row.x, m[4 + i] = row.y, m[8 + i] = row.z;
      m[12 + i] = -vec3_dot(row, eye);
    }
    m[3] = v.forward.x, m[7] = v.forward.y, m[11] = v.forward.z;
    m[15] = -vec3_dot(v.forward, eye);
    raster_frustum b = raster_frustum_of_matrix(m, origin);
    for (int i = 0; i < 50; i++) {
      double p[3] = {30 * (double)rng_next(&r) - 15,
                     30 * (double)rng_next(&r) - 15,
                     30 * (double)rng_next(&r) - 15};
      bool in[2] = {true, true}, near = false;
      for (int side = 0; side < 5; side++)
        for (int of = 0; of < 2; of++) {
          const raster_plane *q = of == 0 ? &a.side[side] : &b.side[side];
          double sum = q->d, size = fabs(q->d);
          for (int j = 0; j < 3; j++)
            sum += q->n[j] * p[j], size += fabs(q->n[j] * p[j]);
          near |= fabs(sum) < 1e-4 * size;
          in[of] &= sum >= 0;
        }
      if (!near) assert_int_equal(in[0], in[1]);
    }
  }
}

// Of a line: nothing needed and something done is never kept; less than a bound
// is; the verdict is of what was done once that is known.
static void lines_say_what_they_mean(void **state) {
  (void)state;
  plan_line l = {.told = true, .need = 3, .all = 5};
  assert_int_equal(plan_verdict_of(&l), PLAN_REDUCED);
  assert_true(plan_kept(&l));
  l.counted = true, l.did = 2;
  assert_false(plan_kept(&l));
  l.at_most = true;
  assert_true(plan_kept(&l));
  l.did = 4;
  assert_false(plan_kept(&l));
  l.need = l.did = 5;
  assert_int_equal(plan_verdict_of(&l), PLAN_DONE);
  l.need = 0, l.did = 1;
  assert_false(plan_kept(&l));
  l.did = 0;
  assert_true(plan_kept(&l));
  assert_int_equal(plan_verdict_of(&l), PLAN_SKIPPED);
  l = (plan_line){.told = true, .need = PLAN_ANY, .all = PLAN_ANY};
  assert_int_equal(plan_verdict_of(&l), PLAN_DONE);
  for (int i = 0; i < PLAN_STAGES; i++)
    assert_true(strlen(plan_name((plan_stage)i)) > 0 &&
                strlen(plan_unit((plan_stage)i)) > 0);
}

// What a request leads to for a scene of one triangle before the camera.
static plan plan_of(world *w, plan_request r) {
  camera c = {.eye = {0, 0, 5}, .target = {0, 0, 0}, .up = {0, 1, 0}};
  c.fov_deg = 40;
  error err;
  r.scene = &w->scene;
  assert_true(camera_view_of(&r.view, &c, 64, 48, &err));
  r.width = r.window[2] = 64;
  r.height = r.window[3] = 48;
  r.lights = r.shadows = true;
  r.samples = 64 * 48;
  return plan_make(&r, &w->mem);
}

static world *one_triangle(material_kind kind) {
  world *w = world_new();
  mesh *m = &w->scene.mesh;
  vec3 p[3] = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  for (uint32_t i = 0; i < 3; i++)
    m->position_index[i] = world_vertex(w, p[i]);
  m->triangle_count = 1;
  vec3 grey = {0.5f, 0.5f, 0.5f};
  w->materials[0] = world_material(kind, grey, grey);
  w->scene.material_count = 1;
  w->scene.lo = (vec3){-1, -1, 0}, w->scene.hi = (vec3){1, 1, 0};
  w->lights[0] = (light){LIGHT_POINT, {0, 3, 3}, {9, 9, 9}};
  w->scene.light_count = 1;
  return w;
}

// Mirrors and glass answer no lamp; a black one is no light; no light at all
// is the dark; only where nothing shines but lamps the last segment is spared.
static void light_is_asked_for_where_it_helps(void **state) {
  (void)state;
  for (int kind = MATERIAL_BLINN_PHONG; kind <= MATERIAL_GLASS; kind++) {
    world *w = one_triangle((material_kind)kind);
    bool dull = kind == MATERIAL_BLINN_PHONG || kind == MATERIAL_METAL_ROUGH;
    plan p = plan_of(w, (plan_request){.path = true, .max_depth = 3});
    assert_int_equal(p.lamp_count, dull);
    assert_int_equal(plan_needs(&p, PLAN_PATHS), dull);
    assert_int_equal(plan_needs(&p, PLAN_ASK), dull);
    assert_true(p.lamps_only);
    plan r = plan_of(w, (plan_request){.msaa = 4});
    assert_int_equal(plan_needs(&r, PLAN_SHADOW_MAPS), dull);
    assert_int_equal(plan_needs(&r, PLAN_SKY), false);
    w->scene.env = (env){.kind = ENV_SKY, .scale = 1};
    p = plan_of(w, (plan_request){.path = true, .max_depth = 3});
    assert_int_equal(p.line[PLAN_ENV_TABLE].need, 1);
    p = plan_of(w, (plan_request){.path = true, .learns = true});
    assert_int_equal(p.line[PLAN_ENV_TABLE].need, 2);
    assert_true(plan_needs(&p, PLAN_PATHS) && !p.lamps_only);
    r = plan_of(w, (plan_request){.msaa = 4});
    assert_int_equal(plan_needs(&r, PLAN_IBL), dull);
    w->scene.env.kind = ENV_NONE;
    w->lights[0].power = (vec3){0, 0, 0};
    p = plan_of(w, (plan_request){.path = true});
    assert_false(plan_needs(&p, PLAN_PATHS));
    w->materials[0].ke = (vec3){1, 1, 1};
    p = plan_of(w, (plan_request){.path = true});
    assert_true(plan_needs(&p, PLAN_PATHS) && plan_needs(&p, PLAN_ASK));
    world_free(w);
  }
}

// With no_skip every line is wanted whole, whatever the scene; without it a
// picture of depth wants no light.
static void no_skip_wants_everything(void **state) {
  (void)state;
  world *w = one_triangle(MATERIAL_GLASS);
  for (int path = 0; path < 2; path++) {
    plan p = plan_of(w, (plan_request){.path = path, .no_skip = true});
    for (int i = 0; i < PLAN_STAGES; i++)
      if (i != PLAN_VISIBILITY && i != PLAN_RESOLVE && i != PLAN_NORMALS)
        assert_int_equal(p.line[i].need, p.line[i].all);
    p = plan_of(w, (plan_request){.path = path, .shading = RENDER_DEPTH});
    plan_stage lit[] = {PLAN_LAMPS, PLAN_SHADOW_MAPS, PLAN_SKY,     PLAN_IBL,
                        PLAN_TABLE, PLAN_PATHS,       PLAN_ASK,     PLAN_ALPHA,
                        PLAN_LEAN,  PLAN_ENV_TABLE,   PLAN_ENV_MAP, PLAN_AIM};
    for (size_t i = 0; i < sizeof lit / sizeof *lit; i++)
      assert_false(plan_needs(&p, lit[i]));
  }
  world_free(w);
}

// What a surface does not look at makes no difference to it.
static void surfaces_look_at_their_own_maps(void **state) {
  (void)state;
  enum { KD = 1, KS = 2, KE = 4, NS = 8, D = 16, PR = 32, PM = 64 };
  material m = {.d = 1};
  assert_int_equal(material_reads(&m, MATERIAL_GLASS), 384);
  assert_int_equal(material_reads(&m, MATERIAL_MIRROR), KS | 384);
  assert_int_equal(material_reads(&m, MATERIAL_BLINN_PHONG),
                   KD | KS | NS | 384);
  assert_int_equal(material_reads(&m, MATERIAL_METAL_ROUGH),
                   KD | PR | PM | 384);
  m.ke.y = 1, m.passes = true;
  assert_int_equal(material_reads(&m, MATERIAL_GLASS), KE | D | 384);
  texture_map *all[MATERIAL_MAPS];
  for (int k = 0; k < MATERIAL_MAPS; k++) {
    all[k] = material_map(&m, k);
    for (int i = 0; i < k; i++)
      assert_ptr_not_equal(all[i], all[k]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(blocks_hold_every_triangle),
      cmocka_unit_test(nothing_seen_is_outside),
      cmocka_unit_test(both_frusta_agree),
      cmocka_unit_test(lines_say_what_they_mean),
      cmocka_unit_test(light_is_asked_for_where_it_helps),
      cmocka_unit_test(no_skip_wants_everything),
      cmocka_unit_test(surfaces_look_at_their_own_maps),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

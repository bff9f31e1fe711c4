// figures.c — the pictures of chapter 13, and the numbers that its text quotes.

#include "../tripod.h"
#include "plan_use.h"
#include "raster.h"

#include <string.h>

// Where the pictures go, and what is shown.
typedef struct output {
  const char *folder;
  arena mem;
  pool *threads;
  scene scene;
  gl *g;
} output;

enum { WIDE = 460, HIGH = 300, SIDE = 226 };

static const vec3 RED = {0.7f, 0.03f, 0.02f};
static const vec3 GREEN = {0.05f, 0.4f, 0.1f}, GREY = {0.6f, 0.6f, 0.6f};

// --- which blocks of the garden are in view, from above ---------------------

// Where the plan of the garden lies on the paper.
static vec2 on_plan(vec3 p) {
  const float scale = 17;
  return (vec2){WIDE / 2 + scale * p.x, 178 + scale * p.z};
}

static void draw_box(image im, const raster_block *b, vec3 color) {
  vec2 lo = on_plan(b->lo), hi = on_plan(b->hi);
  draw_thin_line(im, lo, (vec2){hi.x, lo.y}, color);
  draw_thin_line(im, (vec2){hi.x, lo.y}, hi, color);
  draw_thin_line(im, hi, (vec2){lo.x, hi.y}, color);
  draw_thin_line(im, (vec2){lo.x, hi.y}, lo, color);
}

// The eye, and the two sides of its picture on the ground.
static void draw_view(image im, const camera_view *v, int w, int h) {
  for (int k = 0; k < 2; k++) {
    vec3 d = camera_ray(v, (float)(k * w), (float)h / 2).d;
    vec3 far = vec3_mad(v->eye, 60, d);
    draw_thin_line(im, on_plan(v->eye), on_plan(far), RED);
  }
}

static void blocks_figure(output *o) {
  image im = paper(&o->mem, WIDE, HIGH);
  camera_view v = view_of((vec3){-0.5f, 3, 6}, (vec3){2.5f, 1, 0}, 33, 16, 9);
  const int window[4] = {0, 0, 16, 9};
  raster_frustum f = raster_frustum_of(&v, window);
  raster_blocks all = raster_blocks_of(&o->scene, &o->mem);
  size_t in = 0, triangles = 0;
  for (int pass = 0; pass < 2; pass++)
    for (size_t i = 0; i < all.count; i++) {
      const raster_block *b = &all.items[i];
      bool out = raster_block_outside(b, &f);
      if (out == (pass == 0)) draw_box(im, b, out ? GREY : GREEN);
      if (pass == 0 && !out) in++, triangles += b->count;
    }
  draw_view(im, &v, 16, 9);
  printf("blocks: %zu, in view %zu, with %zu of %zu triangles\n", all.count, in,
         triangles, o->scene.mesh.triangle_count);
  publish(o->folder, "blocks", im);
}

// --- what a too eager cull eats ---------------------------------------------

// The triangles of a box lo..hi, appended to a mesh with room for them.
static void add_box(mesh *m, vec3 lo, vec3 hi) {
  static const int faces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                  {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
  uint32_t first = (uint32_t)m->position_count;
  for (int i = 0; i < 8; i++)
    m->positions[m->position_count++] =
        (vec3){i & 4 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 1 ? hi.z : lo.z};
  for (int f = 0; f < 6; f++)
    for (int t = 0; t < 2; t++)
      for (int k = 0; k < 3; k++) {
        uint32_t *index = m->position_index + 3 * m->triangle_count;
        index[k] = first + (uint32_t)faces[f][k == 0 ? 0 : t + k];
        if (k == 2) m->triangle_count++;
      }
}

// A floor, a plinth, and behind the camera a tall slab between it and the sun:
// a scene whose shadow comes from what is not in view.  Boxes are runs.
static void make_yard(output *o, scene *s, bool with_slab) {
  static light sun = {LIGHT_DIR, {0.25f, -1, -0.9f}, {4, 3.8f, 3.3f}};
  static material looks[2];
  looks[0] = (material){.name = "stone", .kd = {0.55f, 0.5f, 0.42f}, .d = 1};
  *s = (scene){.lights = &sun, .light_count = 1, .materials = looks};
  s->env = (env){ENV_CONSTANT, {0.25f, 0.3f, 0.4f}, {0}, 0, 1};
  s->material_count = 1;
  mesh *m = &s->mesh;
  m->positions = ARENA_NEW(&o->mem, vec3, 64);
  m->position_index = ARENA_NEW(&o->mem, uint32_t, 36 * 4);
  m->runs = ARENA_NEW(&o->mem, mesh_run, 4);
  add_box(m, (vec3){-9, -0.2f, -9}, (vec3){9, 0, 9});
  add_box(m, (vec3){-0.7f, 0, -0.7f}, (vec3){0.7f, 1.2f, 0.7f});
  if (with_slab) add_box(m, (vec3){-1.6f, 0, 6.4f}, (vec3){0.3f, 8, 6.8f});
  for (uint32_t i = 0; i < m->triangle_count / 12; i++)
    m->runs[m->run_count++] = (mesh_run){.first = 12 * i, .count = 12};
  s->material_of = ARENA_NEW(&o->mem, uint32_t, m->triangle_count);
  s->lo = (vec3){-9, -0.2f, -9};
  s->hi = (vec3){9, 8, 9};
}

static image drawn(output *o, const scene *s, const camera_view *v,
                   raster_spared spared) {
  raster_settings set = {.width = SIDE,
                         .height = SIDE,
                         .msaa = 4,
                         .lights = true,
                         .shadows = true,
                         .sky = true,
                         .spared = spared};
  error err;
  raster *r;
  if (!raster_new(&r, o->g, s, &set, &o->mem, &err) || !raster_draw(r, v, &err))
    give_up(&err, 5);
  image im = raster_read(r, &o->mem);
  raster_counts n = raster_last_counts(r);
  printf("yard: %zu triangles drawn, %zu into %zu shadow maps\n", n.drawn,
         n.casters, n.layers);
  raster_free(r);
  for (int i = 0; i < SIDE * SIDE; i++)
    im.pixels[i] = vec3_min(im.pixels[i], vec3_all(1));
  return im;
}

static void caster_figure(output *o) {
  scene whole, cut;
  make_yard(o, &whole, true);
  make_yard(o, &cut, false);
  camera_view v =
      view_of((vec3){2.5f, 2.6f, 5}, (vec3){-0.2f, 0.4f, 0}, 45, SIDE, SIDE);
  image parts[2] = {drawn(o, &whole, &v, (raster_spared){.outside = true}),
                    drawn(o, &cut, &v, (raster_spared){0})};
  image plain = drawn(o, &whole, &v, (raster_spared){0});
  size_t bytes = sizeof(vec3) * SIDE * SIDE;
  printf("yard: spared and not are %s\n",
         memcmp(plain.pixels, parts[0].pixels, bytes) == 0 ? "the same bytes"
                                                           : "different");
  publish(o->folder, "caster", row_of(&o->mem, parts, 2));
}

int main(int argc, char **argv) {
  output o = {.folder = argc > 1 ? argv[1] : "."};
  error err;
  o.threads = pool_new(&o.mem, pool_default_threads());
  if (!gl_open(&o.g, GL_BACKEND_AUTO, &o.mem, &err)) give_up(&err, 5);
  open_scene(&o.scene, "scenes/garden.scene", NULL, &o.mem, o.threads);
  blocks_figure(&o);
  caster_figure(&o);
  gl_close(o.g);
  pool_free(o.threads);
  arena_free(&o.mem);
  return 0;
}

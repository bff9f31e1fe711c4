// figures.c — the pictures of chapter 7, under the sky of scenes/sky.hdr, and
// the numbers that its text quotes.

#include "dfg.h"
#include "ibl.h"
#include "ibl_methods.h"
#include "picture.h"

#include <stdio.h>
#include <stdlib.h>

// Where the pictures go, and what all of them look at.
typedef struct gallery {
  const char *folder;
  arena mem;
  pool *threads;
  env sky;
  ibl made;
  dfg table;
} gallery;

static void stop(const char *why) {
  fprintf(stderr, "%s\n", why);
  exit(4);
}

// Write a picture of radiance times `exposure`, or say why not and end.
static void hang(gallery *g, const char *name, image im, float exposure) {
  error err;
  size_t n = (size_t)im.width * (size_t)im.height;
  for (size_t i = 0; i < n; i++)
    im.pixels[i] = vec3_scale(im.pixels[i], exposure);
  const char *path = arena_format(&g->mem, "%s/%s.png", g->folder, name);
  if (!picture_write(&im, path, PICTURE_PNG, 8, &err)) stop(err.text);
}

// A function of directions, for pictures of the whole sphere.
typedef vec3 (*looker)(const gallery *g, vec3 d, float roughness);

static vec3 look_at_radiance(const gallery *g, vec3 d, float roughness) {
  return ibl_radiance(&g->made, d, roughness);
}

static vec3 look_at_irradiance(const gallery *g, vec3 d, float roughness) {
  (void)roughness;
  return vec3_scale(ibl_irradiance(&g->made, d), 1 / PI);
}

// All directions, equirectangular, with the corner at (x0, y0).
static void paint_sphere(const gallery *g, image *im, int x0, int y0,
                         looker look, float roughness) {
  const int w = 238, h = 119;
  for (int y = 0; y < h; y++)
    for (int x = 0; x < w; x++) {
      vec2 uv = {((float)x + 0.5f) / (float)w, ((float)y + 0.5f) / (float)h};
      im->pixels[(y0 + y) * im->width + x0 + x] =
          look(g, env_direction(uv), roughness);
    }
}

// The sky, what matt surfaces see of it, and what glossy ones see.
static void draw_products(gallery *g) {
  image im = image_new(&g->mem, 480, 363);
  static const float roughness[6] = {0, -1, 0.1f, 0.2f, 0.35f, 0.75f};
  for (int i = 0; i < 6; i++)
    paint_sphere(g, &im, i % 2 * 242, i / 2 * 122,
                 roughness[i] < 0 ? look_at_irradiance : look_at_radiance,
                 roughness[i]);
  im.height = 360;
  hang(g, "products", im, 0.6f);
}

// The normal of a ball's pixel, seen from +z far away, and whether there is
// one.
static bool ball_normal(int x, int y, int size, vec3 *n) {
  float r = 0.48f * (float)size;
  float a = ((float)x + 0.5f - 0.5f * (float)size) / r;
  float b = (0.5f * (float)size - (float)y - 0.5f) / r;
  if (a * a + b * b > 1) return false;
  *n = (vec3){a, b, sqrtf(1 - a * a - b * b)};
  return true;
}

// Colour and metallic of a row of balls.
typedef struct ball {
  vec3 color;
  float metallic, roughness;
} ball;

// Light that a ball sends to +z: the shader's formula in C.
static vec3 shade_ball(const gallery *g, const ball *b, vec3 n) {
  vec3 wo = {0, 0, 1}, f0 = metal_rough_f0(b->color, b->metallic);
  vec3 r = vec3_sub(vec3_scale(n, 2 * n.z), wo);
  dfg_pair p = dfg_lookup(&g->table, n.z, b->roughness);
  float coat = DIELECTRIC_F0 * p.c1 + p.c2;
  vec3 kd = vec3_scale(b->color, (1 - b->metallic) * (1 - coat) / PI);
  vec3 specular = vec3_add(vec3_scale(f0, p.c1), vec3_all(p.c2));
  return vec3_add(
      vec3_mul(kd, ibl_irradiance(&g->made, n)),
      vec3_mul(specular, ibl_radiance(&g->made, vec3_unit(r), b->roughness)));
}

static void paint_ball(const gallery *g, image *im, int x0, int y0,
                       const ball *b) {
  const int size = 80, points = 3;
  for (int y = 0; y < size; y++)
    for (int x = 0; x < size; x++) {
      vec3 sum = {0, 0, 0}, n;
      for (int k = 0; k < points * points; k++) {
        bool hit = ball_normal(points * x + k % points, points * y + k / points,
                               points * size, &n);
        vec3 one = hit ? shade_ball(g, b, n) : vec3_all(0.35f);
        sum = vec3_add(sum, vec3_min(one, vec3_all(4)));
      }
      im->pixels[(y0 + y) * im->width + x0 + x] =
          vec3_scale(sum, 1.0f / (float)(points * points));
    }
}

static void draw_balls(gallery *g) {
  image im = image_new(&g->mem, 480, 240);
  static const float roughness[6] = {0, 0.1f, 0.2f, 0.35f, 0.5f, 0.75f};
  const ball kinds[3] = {{{0.75f, 0.1f, 0.06f}, 0, 0},
                         {{1, 0.78f, 0.34f}, 1, 0},
                         {{0.95f, 0.93f, 0.9f}, 1, 0}};
  for (int i = 0; i < 18; i++) {
    ball b = kinds[i / 6];
    b.roughness = roughness[i % 6];
    paint_ball(g, &im, i % 6 * 80, i / 6 * 80, &b);
  }
  hang(g, "balls", im, 0.6f);
}

// A patch of the sky about the sun by one method, as a thread fills its rows.
typedef struct patch {
  const ibl_methods *methods;
  ibl_method how;
  image im;
  int x0, y0, size;
  vec3 axis;
  float half;  // of its width, at distance 1
} patch;

static void patch_row(void *context, size_t row, int worker) {
  (void)worker;
  const patch *p = context;
  for (int x = 0; x < p->size; x++) {
    float scale = 2 * p->half / (float)p->size;
    vec3 local = {((float)x + 0.5f) * scale - p->half,
                  ((float)row + 0.5f) * scale - p->half, 1};
    vec3 d = ibl_about(p->axis, vec3_unit(local));
    p->im.pixels[(p->y0 + (int)row) * p->im.width + p->x0 + x] =
        ibl_method_at(p->methods, p->how, d);
  }
}

// The direction of the brightest texel.
static vec3 sun_of(const env *e) {
  const image *m = &e->map;
  size_t best = 0, w = (size_t)m->width;
  for (size_t i = 0; i < w * (size_t)m->height; i++)
    if (vec3_peak(m->pixels[i]) > vec3_peak(m->pixels[best])) best = i;
  return env_direction((vec2){((float)(best % w) + 0.5f) / (float)m->width,
                              ((float)(best / w) + 0.5f) / (float)m->height});
}

// The same from the prepared level.
static void paint_level(const gallery *g, const patch *p, float roughness) {
  for (int y = 0; y < p->size; y++)
    for (int x = 0; x < p->size; x++) {
      float scale = 2 * p->half / (float)p->size;
      vec3 local = {((float)x + 0.5f) * scale - p->half,
                    ((float)y + 0.5f) * scale - p->half, 1};
      p->im.pixels[(p->y0 + y) * p->im.width + p->x0 + x] = ibl_radiance(
          &g->made, ibl_about(p->axis, vec3_unit(local)), roughness);
    }
}

// Around the sun at roughness 0.5: lobe samples, the same with mips, spectrum.
static void draw_dots(gallery *g, ibl_methods *m) {
  image im = image_new(&g->mem, 480, 158);
  ibl_methods_aim(m, lobe_rough(PBR_GGX, 0.5f));
  patch p = {m, IBL_SAMPLED, im, 0, 0, 158, sun_of(&g->sky), 1};
  pool_run(g->threads, 158, patch_row, &p);
  p.how = IBL_MIPPED, p.x0 = 161;
  pool_run(g->threads, 158, patch_row, &p);
  p.x0 = 322;
  paint_level(g, &p, 0.5f);
  hang(g, "dots", im, 0.16f);
}

// Irradiance of a single sun on a ball: exact, and by order 2; what is
// negative is painted blue.
static void draw_order_2(gallery *g) {
  image map = image_new(&g->mem, 512, 256), im = image_new(&g->mem, 480, 240);
  map.pixels[80 * 512 + 310] = vec3_all(50000);
  env e = {.kind = ENV_MAP, .map = map, .scale = 1};
  ibl_methods m;
  ibl_methods_open(&m, &e, &g->mem, g->threads);
  ibl_methods_aim(&m, lobe_cosine());
  vec3 sun = env_direction((vec2){310.5f / 512, 80.5f / 256});
  float power = 50000 * ibl_source_solid_angle(&map, 80);
  float least = 0, peak = 0, truth = 0;
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < 480; x++) {
      vec3 n, *to = &im.pixels[y * 480 + x];
      *to = vec3_all(0.05f);
      if (!ball_normal(x % 240, y, 240, &n)) continue;
      n = (vec3){n.z, n.y, -n.x};
      float v = x < 240 ? power * lobe_weight(&m.by, n, sun)
                        : ibl_method_at(&m, IBL_ORDER_2, n).x;
      if (x < 240) truth = fmaxf(truth, v);
      if (x >= 240) least = fminf(least, v), peak = fmaxf(peak, v);
      *to = v < 0 ? (vec3){0, 0, -4 * v} : vec3_all(v);
    }
  printf("order 2 under one sun: least %.3f, most %.3f of the true most\n",
         (double)(least / truth), (double)(peak / truth));
  hang(g, "order-2", im, 0.8f / truth);
}

// A level read between its nodes linearly, as textures usually are.
static vec3 read_linear(const image *nodes, vec3 d) {
  vec2 uv = env_uv(d);
  int w = nodes->width, h = nodes->height;
  float x = uv.x * (float)w, y = uv.y * (float)(h - 1);
  int x0 = (int)x, y0 = (int)y < h - 2 ? (int)y : h - 2;
  const vec3 *a = nodes->pixels + y0 * w, *b = a + w;
  float fx = x - (float)x0, fy = y - (float)y0;
  vec3 top = vec3_lerp(a[x0 % w], a[(x0 + 1) % w], fx);
  return vec3_lerp(top, vec3_lerp(b[x0 % w], b[(x0 + 1) % w], fx), fy);
}

// The highlight at roughness 0.35 from the same nodes: linear, and spline.
static void draw_spline(gallery *g) {
  image im = image_new(&g->mem, 480, 238);
  const ibl_level *l = &g->made.level[2];
  image nodes = image_new(&g->mem, l->width, l->height);
  for (int y = 0; y < l->height; y++)
    for (int x = 0; x < l->width; x++)
      nodes.pixels[y * l->width + x] = ibl_level_at(
          l, (float)x / (float)l->width, (float)y / (float)(l->height - 1));
  vec3 axis = sun_of(&g->sky);
  for (int y = 0; y < 238; y++)
    for (int x = 0; x < 480; x++) {
      if (x == 238 || x == 239 || x == 240 || x == 241) continue;
      float a = (float)(x % 242) / 119 - 1, b = (float)y / 119 - 1;
      vec3 d = ibl_about(axis, vec3_unit((vec3){0.16f * a, 0.16f * b, 1}));
      vec3 v = x < 240 ? read_linear(&nodes, d)
                       : ibl_radiance(&g->made, d, l->roughness);
      // Contour lines make corners visible.
      float line = v.y * 1.2f;
      im.pixels[y * 480 + x] = (int)line % 2 == 0 ? v : vec3_scale(v, 0.7f);
    }
  hang(g, "spline", im, 0.06f);
}

// C1 and C2: sqrt(NoV) to the right, sqrt(roughness) downwards.
static void draw_table(gallery *g) {
  image im = image_new(&g->mem, 480, 200);
  for (int y = 0; y < 200; y++)
    for (int x = 0; x < 480; x++) {
      if (x % 242 >= 238) continue;
      float nv = (float)(x % 242) / 237, r = (float)y / 199;
      dfg_pair p = dfg_lookup(&g->table, nv * nv, r * r);
      im.pixels[y * 480 + x] = vec3_all(x < 240 ? p.c1 : p.c2);
    }
  hang(g, "table", im, 1);
}

int main(int argc, char **argv) {
  gallery g = {.folder = argc > 1 ? argv[1] : "."};
  error err;
  g.threads = pool_new(&g.mem, pool_default_threads());
  if (!env_load(&g.sky, "scenes/sky.hdr", &g.mem, NULL, &err)) stop(err.text);
  static const float roughness[] = {0.1f, 0.2f, 0.35f, 0.5f, 0.75f};
  ibl_need need = {.diffuse = true, .roughness = roughness, .count = 5};
  ibl_make(&g.made, &g.sky, &need, &g.mem, g.threads);
  dfg_build(&g.table, PBR_GGX, &g.mem, g.threads);
  ibl_methods m;
  ibl_methods_open(&m, &g.sky, &g.mem, g.threads);
  draw_balls(&g);
  draw_products(&g);
  draw_dots(&g, &m);
  draw_order_2(&g);
  draw_spline(&g);
  draw_table(&g);
  pool_free(g.threads);
  arena_free(&g.mem);
  return 0;
}

// ibl_methods.c

#include "ibl_methods.h"

#include "num.h"

const char *ibl_method_name(ibl_method how) {
  static const char *const names[IBL_METHODS] = {
      "brute force",        "uniform samples", "lobe samples",
      "lobe samples, mips", "tree of blocks",  "order 2"};
  return names[how];
}

// The map at half the size: plain means of four texels, as usual.
static image half_image(const image *im, arena *mem) {
  image out = image_new(mem, im->width / 2, im->height / 2);
  size_t w = (size_t)im->width;
  for (size_t y = 0; y < (size_t)out.height; y++)
    for (size_t x = 0; x < (size_t)out.width; x++) {
      const vec3 *p = im->pixels + 2 * y * w + 2 * x;
      vec3 sum = vec3_add(vec3_add(p[0], p[1]), vec3_add(p[w], p[w + 1]));
      out.pixels[y * (size_t)out.width + x] = vec3_scale(sum, 0.25f);
    }
  return out;
}

// The map at half the size: sums of four texels.
static image half_sum(const image *im, arena *mem) {
  image out = half_image(im, mem);
  for (size_t i = 0; i < (size_t)out.width * (size_t)out.height; i++)
    out.pixels[i] = vec3_scale(out.pixels[i], 4);
  return out;
}

// Radiance times solid angle, and directions weighed by it; then sums of four
// of those as long as halves are whole.
static void make_powers(ibl_methods *out, const image *map, arena *mem) {
  image all = image_new(mem, map->width, map->height);
  image from = image_new(mem, map->width, map->height);
  for (int y = 0; y < map->height; y++)
    for (int x = 0; x < map->width; x++) {
      size_t at = (size_t)y * (size_t)map->width + (size_t)x;
      vec2 uv = {((float)x + 0.5f) / (float)map->width,
                 ((float)y + 0.5f) / (float)map->height};
      vec3 p = vec3_scale(map->pixels[at], ibl_source_solid_angle(map, y));
      all.pixels[at] = p;
      from.pixels[at] = vec3_scale(env_direction(uv), p.x + p.y + p.z);
    }
  out->power[0] = all, out->middle[0] = from;
  out->powers = 1;
  while (out->powers < IBL_MOST_MIPS && all.height % 2 == 0 && all.height > 4) {
    out->power[out->powers] = all = half_sum(&all, mem);
    out->middle[out->powers++] = from = half_sum(&from, mem);
  }
}

void ibl_methods_open(ibl_methods *out, const env *e, arena *mem,
                      pool *threads) {
  ibl_source s;
  ibl_source_make(&s, e, mem, threads);
  for (int i = 0; i < s.sun_count; i++) {
    const ibl_sun *sun = &s.suns[i];
    vec2 uv = env_uv(sun->direction);
    size_t x = (size_t)(uv.x * (float)s.map.width);
    size_t y = (size_t)(uv.y * (float)s.map.height);
    float angle = ibl_source_solid_angle(&s.map, (int)y);
    s.map.pixels[y * (size_t)s.map.width + x] =
        vec3_scale(sun->power, 1 / angle);
  }
  *out = (ibl_methods){.mip = {s.map}, .mips = 1};
  while (out->mips < IBL_MOST_MIPS && out->mip[out->mips - 1].height > 1) {
    out->mip[out->mips] = half_image(&out->mip[out->mips - 1], mem);
    out->mips++;
  }
  make_powers(out, &s.map, mem);
  wave_analyse(&out->spectrum, &s.map, mem, threads);
}

vec3 ibl_about(vec3 axis, vec3 local) {
  vec3 other = fabsf(axis.y) < 0.9f ? (vec3){0, 1, 0} : (vec3){1, 0, 0};
  vec3 s = vec3_unit(vec3_cross(other, axis)), t = vec3_cross(axis, s);
  return vec3_mad(vec3_mad(vec3_scale(axis, local.z), local.x, s), local.y, t);
}

// The sum over all texels, each a point light in its middle.
static vec3 brute_force(const image *map, const lobe *l, vec3 d) {
  double sum[3] = {0, 0, 0};
  for (int y = 0; y < map->height; y++) {
    double row[3] = {0, 0, 0};
    for (int x = 0; x < map->width; x++) {
      vec3 v = map->pixels[(size_t)y * (size_t)map->width + (size_t)x];
      vec2 uv = {((float)x + 0.5f) / (float)map->width,
                 ((float)y + 0.5f) / (float)map->height};
      double w = (double)lobe_weight(l, d, env_direction(uv));
      row[0] += w * (double)v.x;
      row[1] += w * (double)v.y;
      row[2] += w * (double)v.z;
    }
    double angle = (double)ibl_source_solid_angle(map, y);
    for (int c = 0; c < 3; c++)
      sum[c] += angle * row[c];
  }
  return (vec3){(float)sum[0], (float)sum[1], (float)sum[2]};
}

// The i-th of n points of the unit square: a Fibonacci lattice.
static vec2 lattice_point(int i, int n) {
  float turn = (float)i * 0.61803399f;
  return (vec2){((float)i + 0.5f) / (float)n, turn - floorf(turn)};
}

// Bilinear between texels, linear between sizes; size 0 is the map.
static vec3 read_mip(const ibl_methods *m, vec3 d, float size) {
  size = fminf(fmaxf(size, 0), (float)(m->mips - 1));
  int i = (int)size < m->mips - 1 ? (int)size : m->mips - 2;
  env fine = {.kind = ENV_MAP, .map = m->mip[i], .scale = 1};
  env coarse = {.kind = ENV_MAP, .map = m->mip[i + 1], .scale = 1};
  return vec3_lerp(env_radiance(&fine, d), env_radiance(&coarse, d),
                   size - (float)i);
}

// Directions of equal solid angle.
static vec3 uniform_samples(const ibl_methods *m, const lobe *l, vec3 d) {
  vec3 sum = {0, 0, 0};
  for (int i = 0; i < IBL_METHOD_SAMPLES; i++) {
    vec2 u = lattice_point(i, IBL_METHOD_SAMPLES);
    vec2 around = num_circle(u.y);
    float r = sqrtf(1 - u.x * u.x);
    vec3 w = ibl_about(d, (vec3){r * around.x, r * around.y, u.x});
    sum = vec3_mad(sum, lobe_weight(l, d, w), read_mip(m, w, 0));
  }
  return vec3_scale(sum, 2 * PI / IBL_METHOD_SAMPLES);
}

// Directions reflected by facets, or by the cosine; the ratio of weight and
// density is in both sums.  With mips, a sample stands for the solid angle 1
// over samples times density.  Source: Colbert and Krivanek, GPU Gems 3, 2007,
// chapter 20.
static vec3 lobe_samples(const ibl_methods *m, const lobe *l, vec3 d,
                         bool mips) {
  vec3 sum = {0, 0, 0};
  float weights = 0, a2 = l->alpha * l->alpha;
  float texel = 4 * PI / ((float)m->mip[0].width * (float)m->mip[0].height);
  for (int i = 0; i < IBL_METHOD_SAMPLES; i++) {
    vec2 u = lattice_point(i, IBL_METHOD_SAMPLES);
    vec2 around = num_circle(u.y);
    float c2 = l->alpha == 0 ? 1 - u.x : (1 - u.x) / (1 + (a2 - 1) * u.x);
    float c = sqrtf(c2), r = sqrtf(fmaxf(1 - c2, 0)), pdf = c / PI;
    if (l->alpha > 0) {
      pdf = ggx_d(1 - c2, c, l->alpha) * 0.25f;
      r = 2 * c * r, c = 2 * c2 - 1;  // from the half vector to the light
    }
    if (!(c > 0) || !(pdf > 0)) continue;
    vec3 w = ibl_about(d, (vec3){r * around.x, r * around.y, c});
    float share = 1 / (IBL_METHOD_SAMPLES * pdf);
    float size = mips ? 0.5f * num_log2(share / texel) : 0;
    float weight = lobe_weight(l, d, w) / pdf;
    sum = vec3_mad(sum, weight, read_mip(m, w, size));
    weights += weight;
  }
  float scale = l->alpha == 0 ? PI / weights : 1 / weights;
  return vec3_scale(sum, scale);
}

// A block is taken whole when it is smaller than this share of the lobe's scale
// where it lies.
#define TREE_SHARE 0.25f

// A block of some level.
typedef struct tree_block {
  int level, x, y;
} tree_block;

// Four blocks wait for each that is opened.
enum { TREE_STACK = 4 * IBL_MOST_MIPS };

// Add a block, or put its quarters on the stack; returns how many there are.
static int visit_block(vec3 *sum, tree_block *stack, int n,
                       const ibl_methods *m, vec3 d) {
  tree_block b = stack[--n];
  const image *p = &m->power[b.level];
  size_t at = (size_t)b.y * (size_t)p->width + (size_t)b.x;
  vec3 w = vec3_unit(m->middle[b.level].pixels[at]), apart = vec3_sub(w, d);
  if (!(vec3_peak(p->pixels[at]) > 0)) return n;
  float t = 0.25f * vec3_dot(apart, apart), a = m->by.alpha;
  float scale = a == 0 ? 1 : 2 * sqrtf(a * a + t);
  if (b.level == 0 || PI / (float)p->height <= TREE_SHARE * scale) {
    *sum = vec3_mad(*sum, lobe_weight(&m->by, d, w), p->pixels[at]);
    return n;
  }
  for (int i = 0; i < 4; i++)
    stack[n++] = (tree_block){b.level - 1, 2 * b.x + i % 2, 2 * b.y + i / 2};
  return n;
}

// From the coarsest level down.
static vec3 tree_of_blocks(const ibl_methods *m, vec3 d) {
  vec3 sum = {0, 0, 0};
  tree_block stack[TREE_STACK];
  const image *top = &m->power[m->powers - 1];
  for (int y = 0; y < top->height; y++)
    for (int x = 0; x < top->width; x++) {
      int n = 0;
      stack[n++] = (tree_block){m->powers - 1, x, y};
      while (n > 0)
        n = visit_block(&sum, stack, n, m, d);
    }
  return sum;
}

// The nine functions of order 0 to 2: P_lm(cos theta) e^(i m phi) of unit norm,
// where phi = 2 pi u is 0 at +Z and grows towards -X.  Source: Ramamoorthi and
// Hanrahan 2001.
static vec3 order_2(const ibl_methods *m, vec3 d) {
  double x = (double)d.z, y = -(double)d.x, z = (double)d.y;
  const double p[6][2] = {
      {0.282094792, 0},
      {0.488602512 * z, 0},
      {0.315391565 * (3 * z * z - 1), 0},
      {0.345494149 * x, 0.345494149 * y},
      {0.772548404 * z * x, 0.772548404 * z * y},
      {0.386274202 * (x * x - y * y), 0.386274202 * 2 * x * y}};
  static const int degree[6] = {0, 1, 2, 1, 2, 2},
                   order[6] = {0, 0, 0, 1, 1, 2};
  double sum[3] = {0, 0, 0};
  for (int i = 0; i < 6; i++)
    for (int c = 0; c < 3; c++) {
      const wave *w = &m->spectrum;
      const double *a = w->a[wave_at(w, degree[i], order[i])].c[c];
      double both = a[0] * p[i][0] - a[1] * p[i][1];
      sum[c] += m->k[degree[i]] * both * (order[i] > 0 ? 2 : 1);
    }
  return (vec3){(float)sum[0], (float)sum[1], (float)sum[2]};
}

void ibl_methods_aim(ibl_methods *m, lobe by) {
  m->by = by;
  lobe_spectrum(m->k, 2, &by);
}

vec3 ibl_method_at(const ibl_methods *m, ibl_method how, vec3 d) {
  switch (how) {
  case IBL_BRUTE_FORCE: return brute_force(&m->mip[0], &m->by, d);
  case IBL_UNIFORM: return uniform_samples(m, &m->by, d);
  case IBL_SAMPLED: return lobe_samples(m, &m->by, d, false);
  case IBL_MIPPED: return lobe_samples(m, &m->by, d, true);
  case IBL_TREE: return tree_of_blocks(m, d);
  default: return order_2(m, d);
  }
}

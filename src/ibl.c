// ibl.c — a sum of light by angle is a convolution on the sphere, so a product
// of spectra; the few lights too sharp for that are added one by one.

#include "ibl.h"

#include "clock.h"
#include "ibl_cache.h"
#include "ibl_lobe.h"
#include "ibl_source.h"
#include "ibl_wave.h"

// The roughness of levels where any may be asked for.
static const float standard_levels[] = {0.1f, 0.15f, 0.2f, 0.25f, 0.3f,   0.35f,
                                        0.4f, 0.5f,  0.6f, 0.75f, 0.875f, 1};

enum { STANDARD_LEVELS = sizeof standard_levels / sizeof *standard_levels };

// Insert a roughness into the ordered levels, once.
static void add_level(ibl *b, float roughness) {
  int at = 0;
  while (at < b->level_count && b->level[at].roughness < roughness)
    at++;
  if (at < b->level_count && b->level[at].roughness == roughness) return;
  for (int i = b->level_count++; i > at; i--)
    b->level[i] = b->level[i - 1];
  b->level[at] = ibl_level_of(roughness);
}

// The levels that are needed: those asked for, raised to the least one; or the
// standard ones.  Roughness 0 needs none.
static void choose_levels(ibl *b, const ibl_need *need) {
  bool few = need->count <= IBL_MAX_LEVELS && !need->all;
  b->level_count = 0;
  for (int i = 0; i < need->count && few; i++) {
    float r = fminf(need->roughness[i], 1);
    if (r > 0) add_level(b, fmaxf(r, IBL_LEAST_ROUGHNESS));
  }
  for (int i = 0; i < STANDARD_LEVELS && !few; i++)
    add_level(b, standard_levels[i]);
}

int ibl_levels_of(const ibl_need *need) {
  ibl b;
  choose_levels(&b, need);
  return b.level_count;
}

// What the threads need to fill a level.
typedef struct level_job {
  const ibl_source *source;
  ibl_level *level;
  lobe lobe;
} level_job;

// Add the suns to a row, and take away what rounding left below 0.
static void add_suns_to_row(void *context, size_t row, int worker) {
  (void)worker;
  const level_job *job = context;
  const ibl_level *l = job->level;
  vec3 *texels = l->texels + (row + 1) * (size_t)l->width;
  float v = (float)row / (float)(l->height - 1);
  for (int x = 0; x < l->width; x++) {
    vec3 d = env_direction((vec2){(float)x / (float)l->width, v});
    vec3 sum = vec3_max(texels[x], vec3_all(0));
    for (int i = 0; i < job->source->sun_count; i++) {
      const ibl_sun *s = &job->source->suns[i];
      sum = vec3_mad(sum, lobe_weight(&job->lobe, d, s->direction), s->power);
    }
    texels[x] = sum;
  }
}

// One level from the spectrum and the suns.
static void level_fill(ibl_level *l, const ibl_source *s, const wave *w,
                       lobe by, pool *threads) {
  double k[WAVE_MAX_DEGREE + 1];
  int most = l->width / 2 - 1 < w->degree ? l->width / 2 - 1 : w->degree;
  int degree = lobe_spectrum(k, most, &by);
  wave_grid grid = {l->width, l->height, l->texels + l->width};
  wave_synthesise(&grid, w, k, degree, threads);
  level_job job = {s, l, by};
  pool_run(threads, (size_t)l->height, add_suns_to_row, &job);
  ibl_level_to_spline(l, threads);
}

// An environment without any direction: every sum is known.
static void fill_constant(ibl *b, vec3 radiance) {
  for (int i = -1; i < b->level_count; i++) {
    ibl_level *l = i < 0 ? &b->irradiance : &b->level[i];
    if (l->texels == NULL) continue;
    size_t n = (size_t)(l->height + 2) * (size_t)l->width;
    for (size_t k = 0; k < n; k++)
      l->texels[k] = vec3_scale(radiance, i < 0 ? PI : 1);
  }
}

// Fill all levels.
static void fill_levels(ibl *b, pool *threads) {
  const env *e = b->env;
  if (e->kind == ENV_CONSTANT) fill_constant(b, e->constant);
  bool map = e->kind == ENV_MAP && e->map.pixels != NULL;
  if (!map && e->kind != ENV_SKY) return;
  arena once = {0};
  ibl_source s;
  wave w;
  ibl_source_make(&s, e, &once, threads);
  wave_analyse(&w, &s.map, &once, threads);
  if (b->irradiance.texels != NULL)
    level_fill(&b->irradiance, &s, &w, lobe_cosine(), threads);
  for (int i = 0; i < b->level_count; i++)
    level_fill(&b->level[i], &s, &w,
               lobe_rough(b->model, b->level[i].roughness), threads);
  arena_free(&once);
}

// All levels that have texels, in one list; returns how many.
static int levels_listed(ibl_level *all, const ibl *b) {
  int n = 0;
  for (int i = 0; i < b->level_count; i++)
    all[n++] = b->level[i];
  if (b->irradiance.texels != NULL) all[n++] = b->irradiance;
  return n;
}

size_t ibl_bytes(const ibl *b) {
  ibl_level all[IBL_MAX_LEVELS + 1];
  size_t bytes = 0;
  for (int i = levels_listed(all, b); i-- > 0;)
    bytes += ibl_level_texels(&all[i]) * sizeof(vec3);
  return bytes;
}

void ibl_make(ibl *out, const env *e, const ibl_need *need, arena *mem,
              pool *threads) {
  double start = clock_seconds();
  *out = (ibl){.env = e, .model = need->model};
  choose_levels(out, need);
  if (need->diffuse) {
    out->irradiance = ibl_level_of(-1);
    ibl_level_allocate(&out->irradiance, mem);
  }
  for (int i = 0; i < out->level_count; i++)
    ibl_level_allocate(&out->level[i], mem);
  uint64_t limit = cache_limit();
  bool known = e->kind != ENV_SKY && e->map.pixels == NULL;
  bool cached = need->use_cache && limit > 0 && !known;
  ibl_level all[IBL_MAX_LEVELS + 1];
  ibl_cache_set set = {e, need->model, all, levels_listed(all, out)};
  cache_key key = {0};
  if (cached) key = ibl_cache_key_of(&set);
  out->from_cache = cached && ibl_cache_load(&set, key);
  if (!out->from_cache) fill_levels(out, threads);
  if (cached && !out->from_cache) ibl_cache_save(&set, key, limit);
  out->seconds = clock_seconds() - start;
}

// The level in direction d, with the environment's rotation and scale.
static vec3 level_towards(const ibl *b, const ibl_level *l, vec3 d) {
  if (l->texels == NULL || !vec3_finite(d)) return vec3_all(0);
  vec2 uv = env_uv(d);
  return vec3_scale(ibl_level_at(l, uv.x + b->env->rotate, uv.y),
                    b->env->scale);
}

vec3 ibl_irradiance(const ibl *b, vec3 n) {
  return level_towards(b, &b->irradiance, n);
}

vec3 ibl_radiance(const ibl *b, vec3 d, float roughness) {
  if (!(roughness > 0) || b->level_count == 0) return env_radiance(b->env, d);
  float first = b->level[0].roughness;
  if (roughness < first) {
    float t = roughness / first;
    t = t * t * t * t;
    return vec3_lerp(env_radiance(b->env, d), level_towards(b, &b->level[0], d),
                     t);
  }
  int i = 0;
  while (i + 1 < b->level_count && b->level[i + 1].roughness <= roughness)
    i++;
  vec3 low = level_towards(b, &b->level[i], d);
  if (i + 1 == b->level_count || roughness == b->level[i].roughness) return low;
  float step = b->level[i + 1].roughness - b->level[i].roughness;
  float t = (roughness - b->level[i].roughness) / step;
  return vec3_lerp(low, level_towards(b, &b->level[i + 1], d), t);
}

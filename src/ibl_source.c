// ibl_source.c

#include "ibl_source.h"

enum { SOURCE_LEAST = 256, SOURCE_MOST = 512 };

// PI with all digits of a double.
#define SOURCE_PI 3.14159265358979324

// The part of [i / n, (i + 1) / n] that texel j of m covers, as a share of the
// texel; what is 0 .. 1 may be an azimuth or a height.
static double overlap(double lo, double hi, double a, double b) {
  return fmax(fmin(hi, b) - fmax(lo, a), 0);
}

// What the threads need to average rows.
typedef struct source_job {
  const env *e;
  image map;
} source_job;

// The mean of row y of the original over the columns of the new row, added
// with a weight.
static void add_row(vec3 *sum, int width, const image *from, int y,
                    double weight) {
  const vec3 *row = from->pixels + (size_t)y * (size_t)from->width;
  for (int i = 0; i < width; i++) {
    double lo = (double)i * from->width / width;
    double hi = (double)(i + 1) * from->width / width;
    for (int x = (int)lo; x < from->width && x < hi; x++) {
      double part = overlap(lo, hi, x, x + 1) / (hi - lo);
      sum[i] = vec3_mad(sum[i], (float)(weight * part), row[x]);
    }
  }
}

// One row of the reduced map: the mean of what it covers, by solid angle,
// which is the difference of cosines.
static void reduce_row(void *context, size_t item, int worker) {
  (void)worker;
  const source_job *job = context;
  const image *from = &job->e->map;
  int width = job->map.width, height = job->map.height;
  vec3 *out = job->map.pixels + item * (size_t)width;
  double lo = (double)item / height, hi = (double)(item + 1) / height;
  double whole = cos(SOURCE_PI * lo) - cos(SOURCE_PI * hi);
  for (int y = (int)(lo * from->height); y < from->height; y++) {
    double a = fmax(lo, (double)y / from->height);
    double b = fmin(hi, (double)(y + 1) / from->height);
    if (a >= hi) break;
    if (b <= a) continue;
    add_row(out, width, from, y,
            (cos(SOURCE_PI * a) - cos(SOURCE_PI * b)) / whole);
  }
}

// One row of a map that is read at points.
static void read_row(void *context, size_t item, int worker) {
  (void)worker;
  const source_job *job = context;
  env plain = *job->e;
  plain.rotate = 0, plain.scale = 1;
  for (int x = 0; x < job->map.width; x++) {
    vec2 uv = {((float)x + 0.5f) / (float)job->map.width,
               ((float)item + 0.5f) / (float)job->map.height};
    job->map.pixels[item * (size_t)job->map.width + (size_t)x] =
        env_radiance(&plain, env_direction(uv));
  }
}

float ibl_source_solid_angle(const image *map, int y) {
  double theta = SOURCE_PI * (y + 0.5) / map->height;
  return (float)(4 * SOURCE_PI / map->width * sin(theta) *
                 sin(SOURCE_PI / (2 * map->height)));
}

static double brightness(vec3 v) {
  return (double)v.x + (double)v.y + (double)v.z;
}

// All light of a map, by its sum of channels.
static double all_light(const image *map) {
  double sum = 0;
  for (int y = 0; y < map->height; y++) {
    double row = 0;
    for (int x = 0; x < map->width; x++)
      row +=
          brightness(map->pixels[(size_t)y * (size_t)map->width + (size_t)x]);
    sum += row * (double)ibl_source_solid_angle(map, y);
  }
  return sum;
}

// Take a texel out of the map.
static void add_sun(ibl_source *s, int x, int y) {
  vec3 *texel = s->map.pixels + (size_t)y * (size_t)s->map.width + (size_t)x;
  vec2 uv = {((float)x + 0.5f) / (float)s->map.width,
             ((float)y + 0.5f) / (float)s->map.height};
  float weight = ibl_source_solid_angle(&s->map, y);
  s->suns[s->sun_count++] =
      (ibl_sun){env_direction(uv), vec3_scale(*texel, weight)};
  *texel = vec3_all(0);
}

// Move texels that outshine the rest to the suns.
static void take_suns(ibl_source *s, arena *mem) {
  double least = all_light(&s->map) * IBL_SUN_SHARE;
  s->suns = ARENA_NEW(mem, ibl_sun, (size_t)(1 / IBL_SUN_SHARE) + 1);
  s->sun_count = 0;
  if (!(least > 0)) return;
  for (int y = 0; y < s->map.height; y++)
    for (int x = 0; x < s->map.width; x++) {
      vec3 v = s->map.pixels[(size_t)y * (size_t)s->map.width + (size_t)x];
      if (brightness(v) * (double)ibl_source_solid_angle(&s->map, y) > least)
        add_sun(s, x, y);
    }
}

void ibl_source_make(ibl_source *out, const env *e, arena *mem, pool *threads) {
  bool texels = e->kind == ENV_MAP && e->map.height >= SOURCE_LEAST &&
                e->map.width >= 2 * SOURCE_LEAST;
  int width = 2 * SOURCE_LEAST, height = SOURCE_LEAST;
  if (texels) {
    while (width < e->map.width && width < 2 * SOURCE_MOST)
      width *= 2;
    height = e->map.height < SOURCE_MOST ? e->map.height : SOURCE_MOST;
  }
  source_job job = {e, image_new(mem, width, height)};
  pool_run(threads, (size_t)height, texels ? reduce_row : read_row, &job);
  out->map = job.map;
  take_suns(out, mem);
}

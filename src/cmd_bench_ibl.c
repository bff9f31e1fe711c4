// cmd_bench_ibl.c — facet bench ibl: ways to sum the light of an environment,
// their time and how far they are from the sum over all texels.

#include "cmd_shared.h"

#include "clock.h"
#include "ibl.h"
#include "ibl_methods.h"
#include "num.h"

#include <math.h>
#include <string.h>

// Directions that are compared: half all around, half about the brightest
// texel.
enum { BENCH_DIRECTIONS = 128 };

// The products that are compared; below 0 is irradiance.
static const float bench_roughness[] = {-1, 0.1f, 0.2f, 0.35f, 0.5f, 1};

enum { BENCH_PRODUCTS = sizeof bench_roughness / sizeof *bench_roughness };

typedef struct ibl_bench {
  const options *o;
  env e;
  ibl_methods methods;
  pool *threads;
  vec3 brightest;
  json j;
} ibl_bench;

// One product by one method, as the threads fill it.
typedef struct bench_task {
  const ibl_bench *bench;
  ibl_method how;
  vec3 at[BENCH_DIRECTIONS], value[BENCH_DIRECTIONS];
} bench_task;

static vec3 brightest_direction(const image *map) {
  size_t best = 0, n = (size_t)map->width * (size_t)map->height;
  for (size_t i = 0; i < n; i++)
    if (vec3_peak(map->pixels[i]) > vec3_peak(map->pixels[best])) best = i;
  size_t x = best % (size_t)map->width, y = best / (size_t)map->width;
  return env_direction((vec2){((float)x + 0.5f) / (float)map->width,
                              ((float)y + 0.5f) / (float)map->height});
}

// Points of a spiral: over the sphere, or over a cap about the brightest
// texel as wide as the lobe is.
static void choose_directions(bench_task *t, float roughness) {
  float width = roughness < 0 ? 1 : fminf(6 * roughness * roughness, 1.5f);
  int half = BENCH_DIRECTIONS / 2;
  for (int i = 0; i < BENCH_DIRECTIONS; i++) {
    float turn = (float)i * 0.61803399f;
    vec2 around = num_circle(turn - floorf(turn));
    float share = ((float)(i % half) + 0.5f) / (float)half;
    float c = i < half ? 1 - 2 * share : cosf(share * width);
    float r = sqrtf(fmaxf(1 - c * c, 0));
    vec3 local = {r * around.x, r * around.y, c};
    vec3 axis = i < half ? (vec3){0, 0, 1} : t->bench->brightest;
    t->at[i] = ibl_about(axis, local);
  }
}

static void bench_direction(void *context, size_t item, int worker) {
  (void)worker;
  bench_task *t = context;
  t->value[item] = ibl_method_at(&t->bench->methods, t->how, t->at[item]);
}

// The largest difference of the channels' mean over the largest value, and
// how many values are negative.
typedef struct bench_error {
  double worst;
  int negative;
} bench_error;

static double channel_mean(vec3 v) {
  return ((double)v.x + (double)v.y + (double)v.z) / 3;
}

static bench_error compare_values(const vec3 *a, const vec3 *truth) {
  double peak = 1e-30, worst = 0;
  bench_error e = {0, 0};
  for (int i = 0; i < BENCH_DIRECTIONS; i++) {
    peak = fmax(peak, channel_mean(truth[i]));
    worst = fmax(worst, fabs(channel_mean(a[i]) - channel_mean(truth[i])));
    e.negative += a[i].x < 0 || a[i].y < 0 || a[i].z < 0;
  }
  e.worst = worst / peak;
  return e;
}

// A line of the table.
static void print_bench(ibl_bench *b, const char *product, const char *method,
                        double microseconds, bench_error e) {
  if (!b->o->value[OPT_JSON].given) {
    printf("%-14s %-20s %12.2f %12.2e", product, method, microseconds, e.worst);
    if (e.negative > 0) printf("   %d negative", e.negative);
    fputc('\n', stdout);
    return;
  }
  json_open(&b->j, NULL, '{');
  json_text(&b->j, "product", product);
  json_text(&b->j, "method", method);
  json_number(&b->j, "seconds_per_value", microseconds * 1e-6);
  json_number(&b->j, "error", e.worst);
  json_count(&b->j, "negative", (unsigned long long)e.negative);
  json_close(&b->j, '{');
}

// All methods for one product.
static void bench_product(ibl_bench *b, float roughness, arena *mem) {
  bool matt = roughness < 0;
  pbr_model model = (pbr_model)b->o->value[OPT_PBR_MODEL].words;
  const char *name =
      matt ? "irradiance" : arena_format(mem, "radiance %g", (double)roughness);
  bench_task t = {.bench = b};
  ibl_methods_aim(&b->methods,
                  matt ? lobe_cosine() : lobe_rough(model, roughness));
  choose_directions(&t, roughness);
  vec3 truth[BENCH_DIRECTIONS];
  for (int how = 0; how < IBL_METHODS; how++) {
    t.how = (ibl_method)how;
    double start = clock_seconds();
    pool_run(b->threads, BENCH_DIRECTIONS, bench_direction, &t);
    double each = (clock_seconds() - start) * 1e6 / BENCH_DIRECTIONS;
    if (how == IBL_BRUTE_FORCE) memcpy(truth, t.value, sizeof truth);
    print_bench(b, name, ibl_method_name(t.how), each,
                compare_values(t.value, truth));
  }
  ibl made;
  ibl_need need = {model, matt, false, &roughness, matt ? 0 : 1, false};
  ibl_make(&made, &b->e, &need, mem, b->threads);
  for (int i = 0; i < BENCH_DIRECTIONS; i++)
    t.value[i] = matt ? ibl_irradiance(&made, t.at[i])
                      : ibl_radiance(&made, t.at[i], roughness);
  const ibl_level *l = matt ? &made.irradiance : &made.level[0];
  double nodes = (double)l->width * l->height;
  print_bench(b, name, "spectrum", made.seconds * 1e6 / nodes,
              compare_values(t.value, truth));
}

// All products at once, as a render with every roughness prepares them.
static void bench_whole(ibl_bench *b, arena *mem) {
  size_t repeat = (size_t)b->o->value[OPT_REPEAT].whole[0];
  double *seconds = ARENA_NEW(mem, double, repeat);
  ibl_need need = {.model = (pbr_model)b->o->value[OPT_PBR_MODEL].words,
                   .diffuse = true,
                   .all = true};
  int levels = 0;
  for (size_t i = 0; i < repeat; i++) {
    arena once = {0};
    ibl made;
    ibl_make(&made, &b->e, &need, &once, b->threads);
    seconds[i] = made.seconds;
    levels = made.level_count;
    arena_free(&once);
  }
  double median = cmd_median(seconds, repeat);
  if (!b->o->value[OPT_JSON].given)
    printf("irradiance and %d levels by spectrum: %.3f s, median of %zu\n",
           levels, median, repeat);
  else
    json_number(&b->j, "seconds_all", median);
}

int cmd_bench_ibl(const options *o) {
  arena mem = {0};
  error err;
  ibl_bench b = {.o = o, .threads = pool_new(&mem, cmd_threads(o))};
  b.j.out = stdout;
  int code = EXIT_DONE;
  bool as_json = o->value[OPT_JSON].given;
  if (!cmd_env_of(&b.e, o->operands[0], &mem, NULL, &err)) {
    code = cmd_fail(o, EXIT_INPUT, "%s", err.text);
  } else {
    ibl_methods_open(&b.methods, &b.e, &mem, b.threads);
    b.brightest = brightest_direction(&b.methods.mip[0]);
    if (as_json) {
      json_open(&b.j, NULL, '{');
      json_count(&b.j, "threads", (unsigned long long)pool_threads(b.threads));
      json_open(&b.j, "methods", '[');
    } else {
      printf("%d threads\n%-14s %-20s %12s %12s\n", pool_threads(b.threads),
             "product", "method", "us a value", "error");
    }
    for (int i = 0; i < BENCH_PRODUCTS; i++)
      bench_product(&b, bench_roughness[i], &mem);
    if (as_json) json_close(&b.j, '[');
    bench_whole(&b, &mem);
    if (as_json) json_close(&b.j, '{');
    if (as_json) json_end(&b.j);
  }
  pool_free(b.threads);
  arena_free(&mem);
  return code;
}

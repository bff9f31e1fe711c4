// figures.c — the pictures of chapter 15.

#include "../studio.h"
#include "adaptive.h"
#include "doubling.h"
#include "halves.h"
#include "plot.h"
#include "render.h"
#include "text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Where the pictures go.
typedef struct output {
  const char *folder;
  arena mem;
  pool *threads;
} output;

static void publish_plot(output *o, const char *name, const plot *p) {
  sketch s = plot_sketch(p, &o->mem);
  publish(o->folder, name, sketch_image(&s, &o->mem));
}

// The font, in two sizes and two directions.
static void draw_letters(output *o) {
  static const char *const lines[] = {
      "ABCDEFGHIJKLMNOPQRSTUVWXYZ", "abcdefghijklmnopqrstuvwxyz",
      "0123456789 +-*/=<>()[]{}", "!\"#$%&'.,:;?@\\^_`|~"};
  sketch s = sketch_new(&o->mem, 460, 150);
  sketch_pen pen = {vec3_all(0.02f), 1.8f};
  sketch_type type = {16, 0, false};
  for (int i = 0; i < 4; i++)
    sketch_text(&s, pen, &type, (vec2){12, (float)(30 + 34 * i)}, lines[i]);
  sketch_type small = {8, 0.5f, true};
  pen.width = 1.3f;
  sketch_text(&s, pen, &small, (vec2){446, 75}, "a sentence upwards");
  publish(o->folder, "letters", sketch_image(&s, &o->mem));
}

// A picture of pixels with an edge through each: below the line it is 1.
enum { EDGE_SIDE = 64, EDGE_PIXELS = EDGE_SIDE * EDGE_SIDE };

typedef struct edge {
  double slope, height;  // y < height - slope x, which stays within the pixel
} edge;

static edge edge_of(size_t i) {
  rng r = rng_of(15, i, 0);
  double slope = 0.2 + 0.6 * (double)rng_next(&r);
  return (edge){slope, slope + (1 - slope) * (double)rng_next(&r)};
}

static double edge_truth(size_t i) {
  edge e = edge_of(i);
  return e.height - e.slope / 2;
}

static vec3 edge_sample(size_t i, uint64_t key, uint32_t sample) {
  edge e = edge_of(i);
  sampler s = sampler_of(SAMPLER_SOBOL, 1, key, sample);
  vec2 u = sampler_2(&s);
  return vec3_all((double)u.y < e.height - e.slope * (double)u.x ? 1 : 0);
}

static double edge_error(vec3 (*mean)(const void *, size_t), const void *of) {
  double sum = 0;
  for (size_t i = 0; i < EDGE_PIXELS; i++) {
    double t = edge_truth(i), d = (double)mean(of, i).x - t;
    sum += d * d / (t * t + 0.01);
  }
  return sqrt(sum / EDGE_PIXELS);
}

static vec3 mean_of_film(const void *f, size_t i) {
  return film_mean(f, i);
}

static vec3 mean_of_halves(const void *h, size_t i) {
  return halves_mean(h, i);
}

enum { EDGE_STEPS = 9 };

// The three estimates, each over its own picture's error.
static void draw_estimates(output *o) {
  double x[EDGE_STEPS], y[3][EDGE_STEPS];
  film f = film_new(&o->mem, EDGE_SIDE, EDGE_SIDE, true);
  halves h = halves_new(&o->mem, EDGE_SIDE, EDGE_SIDE);
  render_guide d = doubling_guide(doubling_new(&o->mem, EDGE_SIDE, EDGE_SIDE));
  uint32_t done = 0;
  d.watch(d.self, &f);
  for (int k = 0; k < EDGE_STEPS; k++) {
    uint32_t n = 2u << k;
    for (size_t i = 0; i < EDGE_PIXELS; i++)
      for (uint32_t s = done; s < n; s++) {
        vec3 sample = edge_sample(i, i, s);
        d.add(d.self, i, s, sample);
        film_add(&f, i, sample);
        halves_add(&h, i, s, edge_sample(i, i + (s & 1) * EDGE_PIXELS, s >> 1));
      }
    done = n;
    double whole = edge_error(mean_of_film, &f);
    x[k] = n;
    y[0][k] = film_error(&f) / whole;
    y[1][k] = d.error(d.self, NULL) / whole;
    y[2][k] =
        halves_error(&h, NULL, NULL).error / edge_error(mean_of_halves, &h);
    printf("%4u samples: variance %.3f, doubling %.3f, halves %.3f of the true "
           "error\n",
           n, y[0][k], y[1][k], y[2][k]);
  }
  plot_series series[] = {{"variance / N", plot_color(1), PLOT_DISC,
                           .n = EDGE_STEPS, .x = x, .y = y[0]},
                          {"doubling", plot_color(0), PLOT_SQUARE,
                           .n = EDGE_STEPS, .x = x, .y = y[1]},
                          {"halves", plot_color(2), PLOT_DIAMOND,
                           .n = EDGE_STEPS, .x = x, .y = y[2]}};
  plot p = {.width = 440,
            .height = 280,
            .x = {.label = "samples a pixel", .log = true},
            .y = {.label = "printed / true error", .from = 0, .to = 6},
            .series = series,
            .count = 3};
  publish_plot(o, "estimates", &p);
}

// A tile of 16 pixels in two parts, that shines once in 256 samples, then with
// 256: how many of n samples do, and their mean.
typedef struct sparks {
  rng random;
  uint32_t taken, met;
} sparks;

static void take_sparks(sparks *s, uint32_t until) {
  for (; s->taken < until; s->taken++)
    s->met += rng_next(&s->random) < 1.0f / 256;
}

static double spark_mean(const sparks *s) {
  return 256.0 * (double)s->met / (double)s->taken;
}

// The number of samples that a variance calls for: 128 at least, and up to 16
// times as many.
static uint32_t sparks_wanted(const sparks *s, double price) {
  double p = (double)s->met / (double)s->taken;
  double n = price * 256 * sqrt(p * (1 - p));
  return (uint32_t)fmin(fmax(n, 128), 2048);
}

// Averages over many tiles: of the mean, where each part decides for itself
// and where the others do, and of the samples a pixel.
static void spark_means(double price, double own_and_other[2], double *spp) {
  enum { TILES = 40000 };
  double sum[2] = {0, 0}, samples = 0;
  for (uint64_t t = 0; t < TILES; t++)
    for (int other = 0; other < 2; other++) {
      sparks half[2] = {{rng_of(16, t, 0), 0, 0}, {rng_of(16, t, 1), 0, 0}};
      for (int k = 0; k < 2; k++)
        take_sparks(&half[k], 128);
      uint32_t n[2] = {sparks_wanted(&half[0], price),
                       sparks_wanted(&half[1], price)};
      for (int k = 0; k < 2; k++)
        take_sparks(&half[k], n[other ? 1 - k : k]);
      if (other == 0) samples += half[0].taken + half[1].taken;
      sum[other] += (spark_mean(&half[0]) + spark_mean(&half[1])) / 2;
    }
  own_and_other[0] = sum[0] / TILES, own_and_other[1] = sum[1] / TILES;
  *spp = samples / TILES / 16;
}

static void draw_bias(output *o) {
  enum { STEPS = 7 };
  double x[STEPS], y[2][STEPS], mean[2];
  for (int k = 0; k < STEPS; k++) {
    spark_means(pow(2, k) * 2, mean, &x[k]);
    y[0][k] = mean[0], y[1][k] = mean[1];
    printf("%5.1f samples: own decision %.4f, the others' %.4f\n", x[k],
           mean[0], mean[1]);
  }
  plot_series series[] = {{"decides for itself", plot_color(1), PLOT_DISC,
                           .n = STEPS, .x = x, .y = y[0]},
                          {"the others decide", plot_color(0), PLOT_SQUARE,
                           .n = STEPS, .x = x, .y = y[1]}};
  plot p = {.width = 460,
            .height = 260,
            .x = {.label = "samples a pixel", .log = true},
            .y = {.label = "mean (truth: 1)", .from = 0.3, .to = 1.2},
            .series = series,
            .count = 2};
  publish_plot(o, "bias", &p);
}

// Everything that tracing the garden in halves takes.
typedef struct garden {
  studio all;
  camera_view view;
  integrator twice;
  halves_walk halves;
  jury jury;
  adaptive *samples;
  render_guide guide;
  render_settings settings;
} garden;

enum { GARDEN_WIDTH = 228, GARDEN_HEIGHT = 144 };

static void garden_ready(output *o, garden *g) {
  studio_open(&g->all, "scenes/garden.scene", &o->mem, o->threads);
  g->halves = (halves_walk){&g->all.by, GARDEN_WIDTH * GARDEN_HEIGHT};
  g->twice = halves_integrator(&g->halves);
  g->view = view_by(&g->all.scene.cameras[0], GARDEN_WIDTH, GARDEN_HEIGHT);
  g->jury = (jury){.by = &g->all.by, .view = &g->view};
  g->jury.width = GARDEN_WIDTH, g->jury.height = GARDEN_HEIGHT;
  adaptive_settings a = {GARDEN_WIDTH, GARDEN_HEIGHT, 0.08, 1e6, &g->jury};
  g->samples = adaptive_new(&a, &o->mem);
  g->guide = adaptive_guide(g->samples);
  g->settings = (render_settings){.width = GARDEN_WIDTH,
                                  .height = GARDEN_HEIGHT,
                                  .spp = 1 << 20,
                                  .by = &g->twice,
                                  .aovs = RENDER_AOV_SAMPLES,
                                  .guide = &g->guide,
                                  .error = a.error};
}

// Two pictures of the garden, side by side.
static void publish_pair(output *o, const char *name, const image *left,
                         const image *right) {
  image out = image_new(&o->mem, 2 * GARDEN_WIDTH + 4, GARDEN_HEIGHT);
  for (int y = 0; y < GARDEN_HEIGHT; y++)
    for (int x = 0; x < out.width; x++) {
      int u = x - GARDEN_WIDTH - 4;
      out.pixels[y * out.width + x] =
          u >= 0             ? right->pixels[y * GARDEN_WIDTH + u]
          : x < GARDEN_WIDTH ? left->pixels[y * GARDEN_WIDTH + x]
                             : vec3_all(1);
    }
  publish(o->folder, name, out);
}

// A grey between two doublings.
static vec3 grey_of(double x, double from, double to) {
  double t = (log2(x) - from) / (to - from);
  return vec3_all((float)srgb_decode(fmin(fmax(t, 0), 1)));
}

static image exposed(output *o, const image *im, float exposure) {
  image out = image_new(&o->mem, im->width, im->height);
  for (size_t i = 0; i < (size_t)GARDEN_WIDTH * GARDEN_HEIGHT; i++)
    out.pixels[i] = vec3_scale(im->pixels[i], exp2f(exposure));
  return out;
}

// What each pixel adds to the sum of errors, and those that a jury asks.
static image draw_terms(output *o, const halves *h) {
  enum { PIXELS = GARDEN_WIDTH * GARDEN_HEIGHT };
  image out = image_new(&o->mem, GARDEN_WIDTH, GARDEN_HEIGHT);
  double *terms = ARENA_NEW(&o->mem, double, PIXELS), sum = 0, asked = 0;
  halves_error(h, terms, o->threads);
  for (int i = 0; i < PIXELS; i++)
    sum += terms[i];
  for (int i = 0; i < PIXELS; i++)
    out.pixels[i] = grey_of(terms[i] * PIXELS / sum, -10, 4);
  for (int i = GARDEN_WIDTH + 1; i < PIXELS - GARDEN_WIDTH - 1; i++) {
    if (terms[i] * PIXELS / sum < 64) continue;
    asked++;
    for (int k = 0; k < 9; k++)
      out.pixels[i + (k / 3 - 1) * GARDEN_WIDTH + k % 3 - 1] = plot_color(1);
  }
  printf("garden: %g pixels have 64 times the average term\n", asked);
  return out;
}

static void draw_samples(output *o) {
  garden *g = ARENA_NEW(&o->mem, garden, 1);
  garden_ready(o, g);
  render_result r;
  render_run(&r, &g->all.world, &g->view, &g->settings, &o->mem, o->threads);
  image seen = exposed(o, &r.color, g->all.scene.exposure);
  image taken = image_new(&o->mem, GARDEN_WIDTH, GARDEN_HEIGHT);
  for (int i = 0; i < GARDEN_WIDTH * GARDEN_HEIGHT; i++)
    taken.pixels[i] = grey_of((double)r.aov[4].pixels[i].x, 3, 7);
  printf("garden: %d samples a pixel on average, error %.4f\n", r.spp, r.error);
  publish_pair(o, "samples", &seen, &taken);
  image terms = draw_terms(o, adaptive_sums(g->samples));
  publish_pair(o, "jury", &seen, &terms);
}

// Lines of measured.csv, as facet bench error --csv printed them.
typedef struct measured {
  char method[16];
  int spp, runs;
  double seconds, square;  // the least of the runs, the sum of relMSE
} measured;

enum { MOST_POINTS = 100 };

static span field(span *line) {
  const char *comma = memchr(line->at, ',', line->length);
  size_t n = comma != NULL ? (size_t)(comma - line->at) : line->length;
  span out = {line->at, n};
  n += comma != NULL;
  *line = (span){line->at + n, line->length - n};
  return out;
}

static int read_measured(output *o, measured *out) {
  error err;
  span text, line;
  if (!text_read(&text, "chapters/15-time-against-error/measured.csv", &o->mem,
                 &err))
    give_up(&err, 4);
  text_lines lines = text_lines_of(text, 1);
  int n = 0;
  while (text_next_line(&lines, &line)) {
    span method = field(&line), spp = field(&line);
    long long samples;
    float seconds, relmse;
    field(&line);
    if (!span_int(spp, &samples) || !span_float(field(&line), &seconds))
      continue;
    field(&line), field(&line);
    if (!span_float(field(&line), &relmse)) continue;
    if (n == 0 || !span_is(method, out[n - 1].method) ||
        out[n - 1].spp != (int)samples) {
      out[n] = (measured){.spp = (int)samples, .seconds = (double)INFINITY};
      snprintf(out[n].method, sizeof out[n].method, "%.*s", (int)method.length,
               method.at);
      n++;
    }
    out[n - 1].runs++;
    out[n - 1].seconds = fmin(out[n - 1].seconds, (double)seconds);
    out[n - 1].square += (double)relmse;
  }
  text_lines_free(&lines);
  return n;
}

// Every method of the book: seconds against error.
static void draw_book(output *o) {
  static measured m[MOST_POINTS];
  static double x[MOST_POINTS], y[MOST_POINTS];
  plot_series series[16] = {{0}};
  int n = read_measured(o, m);
  size_t count = 0;
  for (int i = 0; i < n; i++) {
    x[i] = m[i].seconds, y[i] = sqrt(m[i].square / m[i].runs);
    if (i == 0 || strcmp(m[i].method, m[i - 1].method) != 0) {
      series[count] = (plot_series){.name = m[i].method,
                                    .color = plot_color(count),
                                    .mark = (plot_mark)(1 + count % 6),
                                    .x = &x[i],
                                    .y = &y[i]};
      count++;
    }
    series[count - 1].n++;
  }
  plot p = {.width = 480,
            .height = 340,
            .title = "the garden, 160x100",
            .x = {.label = "seconds (whole process)", .log = true},
            .y = {.label = "relative error", .log = true},
            .series = series,
            .count = count};
  publish_plot(o, "book", &p);
}

int main(int argc, char **argv) {
  if (argc != 2) return 2;
  output o = {.folder = argv[1]};
  o.threads = pool_new(&o.mem, pool_default_threads());
  draw_letters(&o);
  draw_estimates(&o);
  draw_bias(&o);
  draw_samples(&o);
  draw_book(&o);
  pool_free(o.threads);
  arena_free(&o.mem);
  return 0;
}

// halves.c

#include "halves.h"

#include "two_means.h"

// A worker's room: what the walker needs, and the starts as it is to see them.
typedef struct halves_room {
  void *inner;
  path_start starts[INTEGRATOR_BATCH];
} halves_room;

static uint64_t other_pixel(const halves_walk *w, uint64_t pixel,
                            uint32_t sample) {
  return pixel + (sample & 1) * w->pixels;
}

static vec2 halves_place(const void *self, uint64_t pixel, uint32_t sample) {
  const halves_walk *w = self;
  return w->by->place(w->by->self, other_pixel(w, pixel, sample), sample >> 1);
}

static void halves_begin(const void *self, const path_row *row,
                         path_start *out) {
  const halves_walk *w = self;
  path_row other = *row;
  other.pixel = other_pixel(w, row->pixel, row->sample);
  other.sample >>= 1;
  integrator_begin(w->by, &other, out);
  for (int i = 0; i < row->count; i++) {
    out[i].pixel = row->pixel + (uint64_t)i;
    out[i].sample = row->sample;
  }
}

static void *halves_room_new(const void *self, arena *mem) {
  const halves_walk *w = self;
  halves_room *room = ARENA_NEW(mem, halves_room, 1);
  room->inner = w->by->room(w->by->self, mem);
  return room;
}

static void halves_radiance(const void *self, const path_start *starts,
                            size_t n, vec3 *out, path_stats *stats,
                            void *context) {
  const halves_walk *w = self;
  halves_room *room = context;
  for (size_t i = 0; i < n; i++) {
    const path_start *s = &starts[i];
    room->starts[i] = (path_start){s->ray, other_pixel(w, s->pixel, s->sample),
                                   s->sample >> 1};
  }
  w->by->radiance(w->by->self, room->starts, n, out, stats, room->inner);
}

integrator halves_integrator(const halves_walk *w) {
  return (integrator){w, halves_place, halves_room_new, halves_radiance,
                      halves_begin};
}

halves halves_new(arena *mem, int width, int height) {
  return (halves){
      {film_new(mem, width, height, true), film_new(mem, width, height, true)}};
}

void halves_add(halves *h, size_t i, uint32_t sample, vec3 color) {
  film_add(&h->half[sample & 1], i, color);
}

vec3 halves_mean(const halves *h, size_t i) {
  vec3 a = film_mean(&h->half[0], i), b = film_mean(&h->half[1], i);
  if (h->half[1].count[i] == 0) return a;
  if (h->half[0].count[i] == 0) return b;
  return vec3_scale(vec3_add(a, b), 0.5f);
}

vec3 halves_variance(const halves *h, size_t i) {
  vec3 a = film_variance(&h->half[0], i), b = film_variance(&h->half[1], i);
  return vec3_scale(vec3_add(a, b), 0.25f);
}

void halves_means(const halves *h, size_t i, int channel, double out[2]) {
  for (int k = 0; k < 2; k++) {
    double n = (double)h->half[k].count[i];
    out[k] = n > 0 ? h->half[k].sum[i][channel] / n : 0;
  }
}

static void halves_run(const void *self, size_t i, int n,
                       const two_means_run *out) {
  const halves *h = self;
  for (size_t k = 0; k < (size_t)n; k++) {
    out->has[k] = h->half[0].count[i + k] > 0 && h->half[1].count[i + k] > 0;
    for (int c = 0; c < 3; c++) {
      double m[2];
      halves_means(h, i + k, c, m);
      out->a[3 * k + (size_t)c] = m[0];
      out->b[3 * k + (size_t)c] = m[1];
    }
  }
}

// The root's relative error is half of that of its square; and what is printed
// misses what is by 4 / 3 as much variance as its own.
halves_estimate halves_error(const halves *h, double *terms, pool *threads) {
  two_means t = {h->half[0].width, h->half[0].height, h, halves_run};
  two_means_sums s = two_means_measure(&t, terms, threads);
  if (!(s.square > 0)) return (halves_estimate){0, 0};
  return (halves_estimate){sqrt(s.square), s.doubt / s.square / sqrt(3)};
}

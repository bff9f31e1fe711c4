// jury.c — the trick: what a few pixels are divided by decides what is told of
// the whole picture, and a few pixels are quickly asked.

#include "jury.h"

#include <math.h>

// All samples of a picture that are taken once more at most.
#define JURY_SHARE (1.0 / 16)

// A pixel that would get fewer samples than this, in those of an average pixel
// of the picture, isn't asked: it might miss what the picture has met.
#define LEAST 4

// Samples of a pixel, at most a batch.
typedef struct seat {
  size_t pixel;          // in the window
  uint32_t from, count;  // samples
  double sum[3];
  uint32_t finite;  // of them
} seat;

typedef struct court {
  const jury *jury;
  int width;  // of the window
  seat *seats;
  size_t seat_count;
  size_t *first;  // seats of each item of work; the end of the last
  size_t item_count;
  void **room;  // of each worker
  path_stats *paths;
} court;

// How many samples, of so many, a pixel is asked for.
static uint32_t samples_of(double term, double sum, double all, double least) {
  double n = sum > 0 ? floor(JURY_SHARE * all * (term / sum)) : 0;
  return n >= least ? (uint32_t)fmin(n, 1u << 30) : 0;
}

// Seats for those that are to be asked, in order; only counted where to is
// NULL.
static size_t seat_all(const double *terms, size_t pixels, double sum,
                       double all, seat *to) {
  size_t n = 0;
  for (size_t i = 0; i < pixels; i++) {
    double least = LEAST * all / (double)pixels;
    uint32_t left = samples_of(terms[i], sum, all, least), from = 0;
    for (; left > 0; n++) {
      uint32_t some = left < INTEGRATOR_BATCH ? left : INTEGRATOR_BATCH;
      if (to != NULL) to[n] = (seat){.pixel = i, .from = from, .count = some};
      left -= some, from += some;
    }
  }
  return n;
}

// As many seats for an item as fill a batch.
static void deal_seats(court *c, arena *mem) {
  c->first = ARENA_NEW(mem, size_t, c->seat_count + 1);
  size_t full = INTEGRATOR_BATCH;
  for (size_t i = 0; i < c->seat_count; i++) {
    if (full + c->seats[i].count > INTEGRATOR_BATCH) {
      c->first[c->item_count++] = i;
      full = 0;
    }
    full += c->seats[i].count;
  }
  c->first[c->item_count] = c->seat_count;
}

// Samples by a sequence of the pixel that neither half knows.
static path_start *start_seat(const court *c, const seat *s, path_start *to) {
  const jury *j = c->jury;
  path_row row = {.view = j->view, .count = 1};
  row.x = j->x0 + (int)(s->pixel % (size_t)c->width);
  row.y = j->y0 + (int)(s->pixel / (size_t)c->width);
  uint64_t width = (uint64_t)j->width, all = width * (uint64_t)j->height;
  row.pixel = 2 * all + (uint64_t)row.y * width + (uint64_t)row.x;
  for (uint32_t k = 0; k < s->count; k++) {
    row.sample = s->from + k;
    integrator_begin(j->by, &row, to++);
  }
  return to;
}

static const vec3 *add_seat(seat *s, const vec3 *colors) {
  for (uint32_t k = 0; k < s->count; k++, colors++) {
    if (!vec3_finite(*colors)) continue;
    s->sum[0] += (double)colors->x;
    s->sum[1] += (double)colors->y;
    s->sum[2] += (double)colors->z;
    s->finite++;
  }
  return colors;
}

static void ask_seats(void *context, size_t item, int worker) {
  court *c = context;
  const integrator *by = c->jury->by;
  path_start starts[INTEGRATOR_BATCH], *end = starts;
  vec3 colors[INTEGRATOR_BATCH];
  for (size_t i = c->first[item]; i < c->first[item + 1]; i++)
    end = start_seat(c, &c->seats[i], end);
  by->radiance(by->self, starts, (size_t)(end - starts), colors,
               &c->paths[worker], c->room[worker]);
  const vec3 *at = colors;
  for (size_t i = c->first[item]; i < c->first[item + 1]; i++)
    at = add_seat(&c->seats[i], at);
}

// The term of a pixel by the seats that are its own, from *s on, which is moved
// to the next pixel's.
static double term_of(const halves *h, const seat **s, const seat *end) {
  size_t i = (*s)->pixel;
  double sum[3] = {0, 0, 0}, n = 0, term = 0;
  for (; *s < end && (*s)->pixel == i; ++*s) {
    n += (*s)->finite;
    for (int c = 0; c < 3; c++)
      sum[c] += (*s)->sum[c];
  }
  for (int c = 0; c < 3; c++) {
    double m[2], radiance = sum[c] / fmax(n, 1);
    halves_means(h, i, c, m);
    term += (m[0] - m[1]) * (m[0] - m[1]) / 4 / (radiance * radiance + 0.01);
  }
  return term;
}

static double sum_of(const double *terms, size_t n) {
  double sum = 0;
  for (size_t i = 0; i < n; i++)
    sum += terms[i];
  return sum;
}

// What the sum of the terms is now says what the error is.
static halves_estimate judge(const double *terms, size_t n, double before,
                             halves_estimate was) {
  double sum = sum_of(terms, n), squares = 0;
  for (size_t i = 0; i < n; i++)
    squares += terms[i] * terms[i];
  return (halves_estimate){was.error * sqrt(sum / before),
                           sqrt(squares) / sum / sqrt(3)};
}

static double samples_taken(const halves *h, size_t pixels) {
  double sum = 0;
  for (size_t i = 0; i < pixels; i++)
    sum += (double)h->half[0].count[i] + (double)h->half[1].count[i];
  return sum;
}

// Let all seats be asked, by all threads; how many rays that takes.
static uint64_t ask_all(court *c, arena *mem, pool *threads) {
  const integrator *by = c->jury->by;
  size_t workers = threads != NULL ? (size_t)pool_threads(threads) : 1;
  c->room = ARENA_NEW(mem, void *, workers);
  c->paths = ARENA_NEW(mem, path_stats, workers);
  for (size_t i = 0; i < workers; i++)
    c->room[i] = by->room(by->self, mem);
  deal_seats(c, mem);
  pool_run(threads, c->item_count, ask_seats, c);
  uint64_t rays = 0;
  for (size_t i = 0; i < workers; i++)
    rays += c->paths[i].rays;
  return rays;
}

static halves_estimate ask(jury *j, const halves *h, double *terms,
                           halves_estimate is, pool *threads) {
  arena scratch = {0};
  court c = {.jury = j, .width = h->half[0].width};
  size_t pixels = (size_t)c.width * (size_t)h->half[0].height;
  double all = samples_taken(h, pixels), sum = sum_of(terms, pixels);
  c.seat_count = seat_all(terms, pixels, sum, all, NULL);
  if (c.seat_count == 0) return is;
  c.seats = ARENA_NEW(&scratch, seat, c.seat_count);
  seat_all(terms, pixels, sum, all, c.seats);
  j->rays += ask_all(&c, &scratch, threads);
  for (size_t i = 0; i < c.seat_count; i++)
    j->samples += c.seats[i].count;
  const seat *end = c.seats + c.seat_count;
  for (const seat *s = c.seats; s < end; j->pixels++) {
    size_t pixel = s->pixel;
    terms[pixel] = term_of(h, &s, end);
  }
  is = judge(terms, pixels, sum, is);
  arena_free(&scratch);
  return is;
}

halves_estimate jury_error(jury *j, const halves *h, double goal,
                           pool *threads) {
  arena scratch = {0};
  size_t pixels = (size_t)h->half[0].width * (size_t)h->half[0].height;
  double *terms = ARENA_NEW(&scratch, double, pixels);
  halves_estimate is = halves_error(h, terms, threads);
  if (is.error > 0 && is.error <= goal) is = ask(j, h, terms, is, threads);
  arena_free(&scratch);
  return is;
}

// render.c — the trick: a sample is a pure function of (seed, pixel, sample
// number) and each pixel adds its own samples in order, so neither threads nor
// tiles nor the way the samples are cut into passes can be seen in the picture.

#include "render.h"

#include "clock.h"
#include <stdatomic.h>

enum { TILE = RENDER_TILE };

// A thread takes a run of tiles, so many that one sample of each pixel fills a
// batch; but each thread should get several runs.
enum { TILE_RUN = INTEGRATOR_BATCH / (TILE * TILE), RUNS = 8 };

// The seconds that a pass should take where someone waits for its end, and
// between two calls of the progress function.
#define PASS_SECONDS 0.5
#define PROGRESS_SECONDS 0.1

// Samples that nobody minds waiting for: half a second of a microsecond each.
#define FIRST_SAMPLES (1 << 19)

// The fewest samples a pixel after which the estimated error is believed.
enum { ERROR_MIN_SPP = 16 };

// A worker: its counts, apart from its neighbour's cache line, and the samples
// that it has taken up: where they start and which pixel of the window each
// is for.
typedef struct worker {
  tally tally;
  size_t count;
  path_start *starts;
  size_t *pixels;
  vec3 *colors;
  void *room;      // of the integrator
  uint64_t spent;  // rays of paths in this tile and pass
  char apart[64];
} worker;

// One call of render_run.
typedef struct job {
  const path_world *world;
  const camera_view *view;
  const render_settings *set;
  int x0, y0, width, height;  // the crop window
  shard shard;                // of that
  int tile_count, run;        // its tiles, and how many a thread takes at once
  double pixels;              // of these tiles; 1 where there are none
  render_sums sums;
  tally kept;             // of those who rendered before
  float farthest;         // of the scene along the view axis
  int begin, end;         // the samples of this pass, unless there is a guide
  uint32_t first;         // that was taken by this run
  double before, during;  // samples of all pixels: taken, and in this pass
  double pass_start;
  atomic_int done;  // its finished tiles
  double start, last_progress, error, begun;
  integrator by;
  worker *team;
  int workers;
} job;

static bool wants_first(const render_settings *s) {
  unsigned of_first = RENDER_AOV_NORMAL | RENDER_AOV_DEPTH | RENDER_AOV_ALBEDO;
  return s->shading != RENDER_RADIANCE || (s->aovs & of_first) != 0;
}

_Static_assert((int)TILE <= (int)PATH_ROW, "a row of a tile is a path_row");

static bool has_turn(const render_turn *turn, int x, int y) {
  return turn->color == RENDER_BOTH_COLORS || ((x ^ y) & 1) == turn->color;
}

// Take up the sample of those of pixels (x0, y) to (x1 - 1, y) of the window
// whose turn it is.
static void start_row(const job *j, int x0, int x1, int y,
                      const render_turn *turn, worker *w) {
  size_t i = (size_t)y * (size_t)j->width + (size_t)x0;
  path_row row = {.view = j->view,
                  .x = x0 + j->x0,
                  .y = y + j->y0,
                  .count = x1 - x0,
                  .sample = turn->sample};
  row.pixel = (uint64_t)row.y * (uint64_t)j->set->width + (uint64_t)row.x;
  path_start *starts = w->starts + w->count;
  integrator_begin(&j->by, &row, starts);
  for (int k = 0; k < row.count; k++) {
    if (!has_turn(turn, x0 + k, y)) continue;
    w->starts[w->count] = starts[k];
    w->pixels[w->count++] = i + (size_t)k;
  }
}

// Finish what the worker has taken up, in that order.
static void end_samples(job *j, worker *w) {
  tally *t = &w->tally;
  bool firsts = wants_first(j->set);
  bool radiance = j->set->shading == RENDER_RADIANCE;
  uint64_t rays = t->paths.rays;
  if (radiance)
    j->by.radiance(j->by.self, w->starts, w->count, w->colors, &t->paths,
                   w->room);
  w->spent += t->paths.rays - rays;
  for (size_t k = 0; k < w->count; k++) {
    const path_start *s = &w->starts[k];
    first_hit first = {0};
    if (firsts) first = first_hit_of(j->world, j->view, &s->ray, &t->paths);
    vec3 color = radiance
                     ? w->colors[k]
                     : first_hit_shade(&first, j->set->shading, j->farthest);
    if (!vec3_finite(color)) {
      tally_drop(t, s->sample, s->pixel);
      continue;
    }
    const render_guide *g = j->set->guide;
    if (g != NULL) g->add(g->self, w->pixels[k], s->sample, color);
    film_add(&j->sums.color, w->pixels[k], color);
    if (firsts) render_sums_add_first(&j->sums, w->pixels[k], &first);
  }
  t->samples += w->count;
  w->count = 0;
}

// Samples of all pixels.
static double samples_done(const job *j) {
  double tiles = (double)atomic_load(&j->done) / fmax((double)j->tile_count, 1);
  return j->before + tiles * j->during;
}

// Samples a pixel, on average.
static int spp_so_far(const job *j) {
  return (int)((j->before + j->during) / j->pixels + 0.5);
}

// The share of the whole that is done, by samples, by error or by time.
static double share_done(const job *j, double now) {
  double share = samples_done(j) / (j->pixels * (double)j->set->spp);
  if (j->set->error > 0 && j->error > 0) {
    double root = j->set->error / j->error;
    if (root * root > share) share = root * root;
  }
  if (j->set->deadline > 0) {
    double timed = (now - j->start) / (j->set->deadline - j->start);
    if (timed > share) share = timed;
  }
  return share > 0 && share < 1 ? share : share > 0;
}

static void tell_progress(job *j, double now) {
  render_progress p = {.done = share_done(j, now),
                       .begun = j->begun,
                       .seconds = now - j->start,
                       .samples = (uint64_t)samples_done(j) - j->kept.samples,
                       .error = j->error};
  j->last_progress = now;
  j->set->progress(j->set->progress_context, &p);
}

// The next sample of a tile's pixels in this pass.
static bool next_turn(const job *j, size_t tile, uint32_t *at,
                      render_turn *turn) {
  const render_guide *g = j->set->guide;
  if (g != NULL && g->next != NULL) return g->next(g->self, tile, at, turn);
  *turn = (render_turn){(uint32_t)j->begin + (*at)++, RENDER_BOTH_COLORS};
  return turn->sample < (uint32_t)j->end;
}

// The samples of this pass in one tile; a few may be left taken up.
static void render_tile(job *j, size_t tile, worker *w) {
  film_box box = shard_box(&j->shard, tile);
  uint32_t at = 0;
  render_turn turn;
  while (next_turn(j, tile, &at, &turn)) {
    for (int y = box.y0; y < box.y1; y++)
      start_row(j, box.x0, box.x1, y, &turn, w);
    if (w->count + TILE * TILE > INTEGRATOR_BATCH) end_samples(j, w);
  }
}

// Work of the pool: a run of tiles.
static void render_tiles(void *context, size_t item, int number) {
  job *j = context;
  worker *w = &j->team[number];
  int begin = (int)item * j->run, end = begin + j->run;
  if (end > j->tile_count) end = j->tile_count;
  const render_guide *g = j->set->guide;
  for (int k = begin; k < end; k++) {
    size_t tile = shard_tile(&j->shard, (size_t)k);
    render_tile(j, tile, w);
    if (g == NULL || g->spend == NULL) continue;
    end_samples(j, w);
    g->spend(g->self, tile, w->spent);
    w->spent = 0;
  }
  end_samples(j, w);
  atomic_fetch_add(&j->done, end - begin);
  if (number != 0 || j->set->progress == NULL) return;
  double now = clock_seconds();
  if (now - j->last_progress >= PROGRESS_SECONDS) tell_progress(j, now);
}

// The seconds for a pass.
static double pass_room(const job *j, double now) {
  const render_settings *s = j->set;
  double room = PASS_SECONDS;
  if (s->keep != NULL) room = fmin(room, s->keep->pass_seconds);
  return s->deadline > 0 ? fmin(room, s->deadline - now) : room;
}

// At least one; whole stacks of four (path_wave.c) where there are several.
static int fit(double samples, int left) {
  int n = (int)fmax(fmin(samples, (double)left), 1);
  return n > 4 && n < left ? n & ~3 : n;
}

// How many samples the next pass takes; 0 to stop.  All that is left when
// nobody waits; else what should fit into PASS_SECONDS and before the
// deadline, after a first pass of few.
static int pass_samples(const job *j) {
  const render_settings *s = j->set;
  int done = j->end, fresh = done - (int)j->first, left = s->spp - done;
  bool bound = s->deadline > 0 || s->error > 0 || s->keep != NULL;
  bool waits = bound || s->stop != NULL || s->progress != NULL;
  if (!waits || left < 1) return left > 0 ? left : 0;
  if (fresh == 0) return bound ? 1 : fit(FIRST_SAMPLES / j->pixels, left);
  if (s->stop != NULL && *s->stop) return 0;
  if (s->error > 0 && done >= ERROR_MIN_SPP && j->error <= s->error) return 0;
  double now = clock_seconds(), each = (now - j->start) / fresh;
  if (s->deadline > 0 && now + each > s->deadline) return 0;
  return fit(fmin(pass_room(j, now) / fmax(each, 1e-9), 4.0 * fresh), left);
}

// Seconds for one sample of one pixel, as it was so far and in the last pass.
static double sample_seconds(const job *j, double now) {
  double fresh = j->before + j->during - (double)j->kept.samples;
  double all = (now - j->start) / fmax(fresh, 1);
  double last = (now - j->pass_start) / fmax(j->during, 1);
  return fmax(fmax(all, last), 1e-12);
}

// The samples of the next pass over all pixels as the guide has it.
static double guided_samples(const job *j) {
  const render_settings *s = j->set;
  const render_guide *g = s->guide;
  render_budget b = {2 * j->pixels, (double)INFINITY};
  if (!(j->during > 0)) return g->plan(g->self, &b);
  if (s->stop != NULL && *s->stop) return 0;
  double now = clock_seconds(), each = sample_seconds(j, now);
  double room = pass_room(j, now);
  if (s->deadline > 0) b.left = (s->deadline - now) / each;
  if (!(room > 0)) return 0;
  b.pass = room / each;
  double n = g->plan(g->self, &b);
  return n > b.left ? 0 : n;
}

// Plan the next pass; false when there is none.
static bool plan_pass(job *j) {
  bool guided = j->set->guide != NULL && j->set->guide->plan != NULL;
  int n = guided ? 0 : pass_samples(j);
  double all = guided ? guided_samples(j) : n * j->pixels;
  j->before += j->during;
  j->during = all;
  j->begin = j->end;
  j->end += n;
  j->pass_start = clock_seconds();
  return all > 0;
}

static double error_so_far(const job *j, pool *threads) {
  const render_guide *g = j->set->guide;
  if (g != NULL) return g->error(g->self, threads);
  return j->shard.count > 1 ? 0 : film_error(&j->sums.color);
}

static worker *hire_workers(const job *j, arena *mem) {
  worker *team = ARENA_NEW(mem, worker, (size_t)j->workers);
  for (int i = 0; i < j->workers; i++) {
    team[i].starts = ARENA_NEW(mem, path_start, INTEGRATOR_BATCH);
    team[i].pixels = ARENA_NEW(mem, size_t, INTEGRATOR_BATCH);
    team[i].colors = ARENA_NEW(mem, vec3, INTEGRATOR_BATCH);
    team[i].room = j->by.room(j->by.self, mem);
  }
  return team;
}

// What all have counted until now.
static void count_all(job *j) {
  j->sums.tally = j->kept;
  for (int i = 0; i < j->workers; i++)
    tally_add(&j->sums.tally, &j->team[i].tally);
  j->sums.taken = (uint32_t)j->end;
}

static void keep_sums(job *j, bool last) {
  const render_keep *k = j->set->keep;
  count_all(j);
  if (k != NULL) k->save(k->self, &j->sums, last);
}

// Give the picture so far to whoever asked for it since the last pass.
static void hand_snapshot(const job *j) {
  const render_settings *s = j->set;
  if (s->snapshot == NULL || !*s->snapshot) return;
  *s->snapshot = 0;
  arena once = {0};
  render_result so_far = {.spp = spp_so_far(j), .error = j->error};
  so_far.seconds = clock_seconds() - j->start;
  render_sums_images(&so_far, &j->sums, s->aovs, s->guide, &once);
  s->on_snapshot(s->snapshot_context, &so_far);
  arena_free(&once);
}

// Whether somebody will hear of the error before the last pass.
static bool error_is_heard(const job *j) {
  const render_settings *s = j->set;
  bool wanted = s->snapshot != NULL && *s->snapshot;
  return s->error > 0 || s->progress != NULL || wanted;
}

static void render_passes(job *j, pool *threads) {
  bool known = true;
  while (plan_pass(j)) {
    atomic_store(&j->done, 0);
    size_t runs = (size_t)((j->tile_count + j->run - 1) / j->run);
    pool_run(threads, runs, render_tiles, j);
    known = error_is_heard(j);
    if (known) j->error = error_so_far(j, threads);
    keep_sums(j, false);
    hand_snapshot(j);
  }
  if (!known) j->error = error_so_far(j, threads);
  keep_sums(j, true);
  if (j->set->progress != NULL) tell_progress(j, clock_seconds());
}

// Whether the film needs squares, but for a guide that watches it.
static bool wants_squares(const render_settings *s) {
  return s->keep != NULL || (s->aovs & RENDER_AOV_VARIANCE) != 0 ||
         (s->guide == NULL && (s->error > 0 || s->progress != NULL));
}

// Films for the sums, empty or with what is kept.
static void ready_sums(job *j, arena *mem, pool *threads) {
  const render_settings *s = j->set;
  const render_guide *g = s->guide;
  bool watched = g != NULL && g->watch != NULL;
  bool squares = watched || wants_squares(s);
  if (s->keep == NULL || !s->keep->load(s->keep->self, &j->sums))
    j->sums = render_sums_new(j->width, j->height, s->aovs, squares, mem);
  if (watched) g->watch(g->self, &j->sums.color);
  j->kept = j->sums.tally;
  j->before = (double)j->kept.samples;
  j->first = j->sums.taken;
  j->end = (int)j->first;
  if (j->kept.samples == 0) return;
  j->error = error_so_far(j, threads);
  j->begun = share_done(j, j->start);
}

// The window, and which of its tiles are to be rendered.
static void choose_tiles(job *j) {
  const render_settings *s = j->set;
  bool crop = s->x1 > 0;
  j->x0 = crop ? s->x0 : 0, j->y0 = crop ? s->y0 : 0;
  j->width = crop ? s->x1 - s->x0 : s->width;
  j->height = crop ? s->y1 - s->y0 : s->height;
  int shards = s->shards > 0 ? s->shards : 1;
  j->shard = (shard){j->width, j->height, s->shard, shards};
  j->tile_count = (int)shard_tiles(&j->shard);
  j->pixels = fmax((double)shard_pixels(&j->shard), 1);
  j->run = j->tile_count / (RUNS * j->workers);
  if (j->run < 1) j->run = 1;
  if (j->run > TILE_RUN) j->run = TILE_RUN;
}

void render_run(render_result *out, const path_world *world,
                const camera_view *view, const render_settings *settings,
                arena *mem, pool *threads) {
  const render_settings *s = settings;
  job j = {.world = world, .view = view, .set = s, .start = clock_seconds()};
  j.farthest = first_hit_farthest(world->scene, view);
  j.last_progress = j.start;
  arena scratch = {0};
  path_naive naive = {world, s->seed};
  j.by = s->by != NULL ? *s->by : path_naive_integrator(&naive);
  j.workers = threads == NULL ? 1 : pool_threads(threads);
  choose_tiles(&j);
  j.team = hire_workers(&j, &scratch);
  ready_sums(&j, &scratch, threads);
  render_passes(&j, threads);
  *out = (render_result){.spp = spp_so_far(&j), .error = j.error};
  out->stopped = s->stop != NULL && *s->stop && out->spp < s->spp;
  render_sums_counts(out, &j.sums, s->width);
  out->squares &= wants_squares(s);
  render_sums_images(out, &j.sums, s->aovs, s->guide, mem);
  arena_free(&scratch);
  out->seconds = clock_seconds() - j.start;
}

// cmd_keep.c

#include "cmd_keep.h"

#include "clock.h"
#include "cmd_output.h"
#include "cmd_signals.h"
#include "file.h"
#include "scene_digest.h"
#include "text.h"

#include <errno.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

// --shard I/N: I from 1 to N, or from 0, where 0 is N.
static int choose_shard(cmd_keep *k) {
  const char *text = k->o->value[OPT_SHARD].text;
  k->part.shard = 0, k->part.shards = 1;
  if (text == NULL) return EXIT_DONE;
  const char *slash = strchr(text, '/');
  long long i = 0, n = 0;
  bool good = slash != NULL &&
              span_int((span){text, (size_t)(slash - text)}, &i) &&
              span_int((span){slash + 1, strlen(slash + 1)}, &n) && n >= 1 &&
              n <= PART_SHARDS_MAX && i >= 0 && i <= n;
  if (!good)
    return cmd_fail(k->o, EXIT_USAGE,
                    "--shard wants I/N, N from 1 to %d and I from 1 to N or "
                    "from 0 to N-1, not '%s'",
                    PART_SHARDS_MAX, text);
  k->part.shard = (int)(i % n);
  k->part.shards = (int)n;
  return EXIT_DONE;
}

// Options that make no sense without another, or with one.
static int check_company(const cmd_keep *k) {
  const option_value *v = k->o->value;
  if (k->path == NULL && (v[OPT_RESUME].given || v[OPT_EVERY].given))
    return cmd_fail(k->o, EXIT_USAGE, "--%s needs --checkpoint FILE",
                    v[OPT_RESUME].given ? "resume" : "every");
  if (v[OPT_SHARD].given && (v[OPT_TIME].given || v[OPT_ERROR].given))
    return cmd_fail(k->o, EXIT_USAGE,
                    "--shard cannot go with --%s: where samples go depends on "
                    "the whole picture, of which a shard has a part; use --spp",
                    v[OPT_TIME].given ? "time" : "error");
  return EXIT_DONE;
}

int cmd_keep_plan(cmd_keep *k, const options *o, arena *mem) {
  *k = (cmd_keep){.o = o, .mem = mem};
  k->path = o->value[OPT_CHECKPOINT].text;
  k->every = (double)o->value[OPT_EVERY].number[0];
  int code = choose_shard(k);
  if (code == EXIT_DONE) code = check_company(k);
  if (code != EXIT_DONE || k->path == NULL) return code;
  int problem = output_problem(k->path, mem);
  if (problem != 0)
    return cmd_fail(o, EXIT_OUTPUT, "%s: cannot be written: %s", k->path,
                    strerror(problem));
  file_sweep(k->path, mem);
  return EXIT_DONE;
}

int cmd_keep_aim(cmd_keep *k, bool to_part) {
  k->to_part = to_part;
  if (to_part || !k->o->value[OPT_SHARD].given) return EXIT_DONE;
  return cmd_fail(k->o, EXIT_USAGE,
                  "%s: --shard writes a .part, of which facet merge makes a "
                  "picture",
                  k->o->value[OPT_OUTPUT].text);
}

bool cmd_keep_wanted(const cmd_keep *k) {
  return k->path != NULL || k->to_part;
}

// The word of an option that is in force.
static const char *word_of(const cmd_keep *k, option_id id) {
  char *word = ARENA_NEW(k->mem, char, 32);
  option_word(&option_table[id], k->o->value[id].words, word, 32);
  return word;
}

// A sum over the sources of this facet, by the Makefile: a version may have
// many of them while it is being made.
extern const char source_sum[];

// All that the samples of a pixel depend on, as lines.
static const char *write_key(const cmd_keep *k, const shot *sh,
                             const render_settings *s) {
  const film_box *w = &k->part.window;
  scene_digest d = scene_digest_of(&sh->scene, &sh->view);
  bool naive = k->o->value[OPT_INTEGRATOR].words == 1;
  char *settings = arena_format(
      k->mem,
      "version %s %s\nfilm %dx%d\nwindow %d,%d,%d,%d\nhalves %s\nshading %s\n"
      "aov %u\nseed %llu\nintegrator %s\nsampler %s\nmax-depth %d\n"
      "lights %s\npbr-model %s\n",
      FACET_VERSION, source_sum, s->width, s->height, w->x0, w->y0, w->x1,
      w->y1, k->part.films >> PART_EVEN & 1 ? "yes" : "no",
      word_of(k, OPT_SHADING), s->aovs, (unsigned long long)s->seed,
      word_of(k, OPT_INTEGRATOR), naive ? "random" : word_of(k, OPT_SAMPLER),
      (int)k->o->value[OPT_MAX_DEPTH].whole[0], word_of(k, OPT_LIGHTS),
      word_of(k, OPT_PBR_MODEL));
  const uint64_t numbers[] = {d.camera,   d.geometry, d.materials,
                              d.textures, d.lights,   d.environment};
  static const char *const names[] = {"camera",   "geometry", "materials",
                                      "textures", "lamps",    "environment"};
  for (int i = 0; i < 6; i++)
    settings = arena_format(k->mem, "%s%s %016llx\n", settings, names[i],
                            (unsigned long long)numbers[i]);
  return settings;
}

// What the part is of, without any samples.
static void describe(cmd_keep *k, const shot *sh, const render_settings *s) {
  part *p = &k->part;
  const option_value *v = k->o->value;
  bool in_halves = s->error > 0 || s->deadline > 0, crop = s->x1 > 0;
  p->width = s->width;
  p->height = s->height;
  p->window = crop ? (film_box){s->x0, s->y0, s->x1, s->y1}
                   : (film_box){0, 0, s->width, s->height};
  p->spp = (uint32_t)s->spp;
  p->radiance = s->shading == RENDER_RADIANCE;
  p->exposure =
      v[OPT_EXPOSURE].given ? v[OPT_EXPOSURE].number[0] : sh->scene.exposure;
  p->aovs = s->aovs;
  p->films = in_halves ? 1u << PART_EVEN | 1u << PART_ODD : 1u << PART_COLOR;
  if (!in_halves && p->shards == 1) p->films |= 1u << PART_MARKS;
  if (s->aovs & RENDER_AOV_NORMAL) p->films |= 1u << PART_NORMAL;
  if (s->aovs & RENDER_AOV_DEPTH) p->films |= 1u << PART_DEPTH;
  if (s->aovs & RENDER_AOV_ALBEDO) p->films |= 1u << PART_ALBEDO;
  p->key = write_key(k, sh, s);
  part_deal(p, k->mem);
}

// Samples of each pixel that a part has; of one in halves, no number.
static uint32_t part_taken(const part *p) {
  bool some = p->tile_count > 0 && (p->films >> PART_COLOR & 1) != 0;
  return some ? p->tiles[0].state.taken[0] : 0;
}

// Whether what is in the file is what is asked for; an exit code.
static int check_old(const cmd_keep *k, const part *old) {
  const part *p = &k->part;
  char text[256];
  if (part_keys_differ(old->key, p->key, text, sizeof text))
    return cmd_fail(k->o, EXIT_INPUT,
                    "%s: cannot be gone on with, it is of another picture: "
                    "its %s",
                    k->path, text);
  if (old->shard != p->shard || old->shards != p->shards)
    return cmd_fail(k->o, EXIT_INPUT,
                    "%s: cannot be gone on with: it is shard %d/%d, not %d/%d",
                    k->path, part_shard_name(old), old->shards,
                    part_shard_name(p), p->shards);
  if (part_taken(old) > p->spp)
    return cmd_fail(k->o, EXIT_USAGE,
                    "%s: has %u samples a pixel already; --spp is their total, "
                    "and %u is fewer",
                    k->path, part_taken(old), p->spp);
  return EXIT_DONE;
}

// Read the checkpoint; an exit code.
static int read_old(cmd_keep *k) {
  error err;
  part old;
  if (access(k->path, F_OK) != 0 && errno == ENOENT) {
    if (!k->o->value[OPT_QUIET].given)
      fprintf(stderr, "%s: not there yet, starting at the first sample\n",
              k->path);
    return EXIT_DONE;
  }
  if (!part_read_head(&old, k->path, k->mem, &err))
    return cmd_fail(k->o, EXIT_INPUT, "%s", err.text);
  int code = check_old(k, &old);
  if (code != EXIT_DONE) return code;
  part_films_new(&old, k->mem);
  if (!part_read_sums(&old, k->path, &err))
    return cmd_fail(k->o, EXIT_INPUT, "%s", err.text);
  old.spp = k->part.spp;
  old.exposure = k->part.exposure;
  old.complete = false;
  k->part = old;
  k->resumed = true;
  k->before = old.tally.samples;
  return EXIT_DONE;
}

// In two halves the guide has the sums, and the film only counts.
static void count_halves(part *p, arena *mem) {
  film *all = &p->film[PART_COLOR];
  *all = film_new(mem, part_width(p), part_height(p), true);
  size_t n = (size_t)all->width * (size_t)all->height;
  for (size_t i = 0; i < n; i++)
    all->count[i] = p->film[PART_EVEN].count[i] + p->film[PART_ODD].count[i];
}

static bool keep_load(void *self, render_sums *sums) {
  cmd_keep *k = self;
  part *p = &k->part;
  k->last = clock_seconds();
  *sums = (render_sums){.color = p->film[PART_COLOR],
                        .normal = p->film[PART_NORMAL],
                        .depth = p->film[PART_DEPTH],
                        .albedo = p->film[PART_ALBEDO],
                        .tally = p->tally,
                        .taken = part_taken(p)};
  return true;
}

// The table of tiles as it is now.
static void update_tiles(cmd_keep *k, const render_sums *sums) {
  part *p = &k->part;
  if (k->adaptive == NULL) {
    for (size_t i = 0; i < p->tile_count; i++)
      p->tiles[i].state = (adaptive_tile){.taken = {sums->taken, 0}};
    return;
  }
  arena scratch = {0};
  adaptive_tile *tiles = ARENA_NEW(&scratch, adaptive_tile, p->tile_count);
  adaptive_tiles(k->adaptive, tiles);
  for (size_t i = 0; i < p->tile_count; i++)
    p->tiles[i].state = tiles[i];
  arena_free(&scratch);
}

// Write the checkpoint.  That it cannot be written is said, and the picture is
// gone on with.
static void write_checkpoint(cmd_keep *k) {
  error err;
  double start = clock_seconds();
  k->lost = !part_write(&k->part, k->path, &err);
  k->last = clock_seconds();
  k->seconds += k->last - start;
  k->writes += !k->lost;
  if (k->lost) cmd_fail(k->o, EXIT_OUTPUT, "%s", err.text);
}

static void keep_save(void *self, const render_sums *sums, bool last) {
  cmd_keep *k = self;
  part *p = &k->part;
  p->tally = sums->tally;
  update_tiles(k, sums);
  bool all = k->adaptive == NULL && sums->taken >= p->spp;
  p->complete = all || (last && !signal_stop);
  if (k->path == NULL || (all && !last)) return;
  if (last || clock_seconds() - k->last >= k->every) write_checkpoint(k);
}

int cmd_keep_open(cmd_keep *k, const shot *sh, render_settings *s) {
  if (!cmd_keep_wanted(k)) return EXIT_DONE;
  part *p = &k->part;
  describe(k, sh, s);
  if (k->o->value[OPT_RESUME].given) {
    int code = read_old(k);
    if (code != EXIT_DONE) return code;
  }
  if (!k->resumed) part_films_new(p, k->mem);
  if (p->films >> PART_EVEN & 1) count_halves(p, k->mem);
  s->shard = p->shard;
  s->shards = p->shards;
  k->hooks = (render_keep){k, keep_load, keep_save, fmax(k->every, 0.01)};
  s->keep = &k->hooks;
  return EXIT_DONE;
}

void cmd_keep_watch(cmd_keep *k) {
  part *p = &k->part;
  if (k->adaptive != NULL) {
    const halves *sums = adaptive_sums(k->adaptive);
    halves old = {{p->film[PART_EVEN], p->film[PART_ODD]}};
    arena scratch = {0};
    adaptive_tile *tiles = ARENA_NEW(&scratch, adaptive_tile, p->tile_count);
    for (size_t i = 0; i < p->tile_count; i++)
      tiles[i] = p->tiles[i].state;
    if (k->resumed) adaptive_go_on(k->adaptive, tiles, &old);
    p->film[PART_EVEN] = sums->half[0];
    p->film[PART_ODD] = sums->half[1];
    arena_free(&scratch);
  }
  if (k->doubling != NULL) {
    if (k->resumed) doubling_go_on(k->doubling, &p->marks);
    p->marks = doubling_look(k->doubling);
  }
}

int cmd_keep_close(cmd_keep *k, const render_result *r) {
  if (k->path == NULL || !r->stopped) return EXIT_DONE;
  if (k->lost)
    return cmd_fail(k->o, EXIT_OUTPUT, "%s: stopped, and not saved", k->path);
  if (!k->o->value[OPT_QUIET].given)
    fprintf(stderr, "%s: stopped after %d spp; --resume goes on from there\n",
            k->path, r->spp);
  return EXIT_EARLY;
}

void cmd_keep_json(json *j, const cmd_keep *k) {
  if (k->path == NULL) return;
  json_open(j, "checkpoint", '{');
  json_text(j, "path", k->path);
  json_flag(j, "resumed", k->resumed);
  json_count(j, "before", (unsigned long long)k->before);
  json_count(j, "writes", (unsigned long long)k->writes);
  json_number(j, "seconds", k->seconds);
  json_close(j, '{');
}

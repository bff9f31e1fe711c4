// figures.c — the pictures of chapter 16, and the numbers that its text quotes.

#include "../studio.h"
#include "file.h"
#include "hdr.h"
#include "part_set.h"
#include "pfm.h"
#include "png.h"
#include "render.h"
#include "tga.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Where the pictures go, and what is rendered.
typedef struct output {
  const char *folder;
  arena mem;
  pool *threads;
  studio all;
} output;

// n pictures of one size, `across` in a row, with 4 white pixels between.
static image sheet(output *o, const image *im, int n, int across) {
  int w = im->width + 4, h = im->height + 4, rows = (n + across - 1) / across;
  image out = paper(&o->mem, across * w - 4, rows * h - 4);
  for (int k = 0; k < n; k++)
    paste(out, im[k], k % across * w, k / across * h);
  return out;
}

// Brighter by so many stops, and cut off at white.
static image exposed(output *o, const image *im, float stops) {
  image out = image_new(&o->mem, im->width, im->height);
  for (int i = 0; i < im->width * im->height; i++)
    out.pixels[i] =
        vec3_min(vec3_scale(im->pixels[i], exp2f(stops)), vec3_all(1));
  return out;
}

static render_result render(output *o, const render_settings *set) {
  camera_view view = view_by(&o->all.scene.cameras[0], set->width, set->height);
  render_result r;
  render_run(&r, &o->all.world, &view, set, &o->mem, o->threads);
  return r;
}

enum { WIDTH = 156, HEIGHT = 100, SHARDS = 3, SPP = 32 };

// Keeps one shard as a part.
typedef struct keeper {
  part part;
} keeper;

static bool keeper_load(void *self, render_sums *sums) {
  *sums = (render_sums){.color = ((keeper *)self)->part.film[PART_COLOR]};
  return true;
}

static void keeper_save(void *self, const render_sums *sums, bool last) {
  keeper *k = self;
  k->part.tally = sums->tally;
  k->part.complete = last;
  for (size_t i = 0; i < k->part.tile_count; i++)
    k->part.tiles[i].state.taken[0] = sums->taken;
}

// Render shard i into a file, and return what it shows.
static image render_shard(output *o, int i, const char *path) {
  error err;
  keeper k = {{.width = WIDTH,
               .height = HEIGHT,
               .window = {0, 0, WIDTH, HEIGHT},
               .shard = i % SHARDS,
               .shards = SHARDS,
               .spp = SPP,
               .radiance = true,
               .films = 1u << PART_COLOR,
               .key = "scene garden\n"}};
  part_deal(&k.part, &o->mem);
  part_films_new(&k.part, &o->mem);
  render_keep keep = {&k, keeper_load, keeper_save, 1};
  render_settings set = {.width = WIDTH,
                         .height = HEIGHT,
                         .spp = SPP,
                         .by = &o->all.by,
                         .shard = i % SHARDS,
                         .shards = SHARDS,
                         .keep = &keep};
  image im = render(o, &set).color;
  if (!part_write(&k.part, path, &err)) give_up(&err, 4);
  return im;
}

// Three shards, what they are together, what one run makes, and how far these
// two are apart.
static void draw_shards(output *o) {
  error err;
  image all[6];
  const char *paths[SHARDS];
  for (int i = 0; i < SHARDS; i++) {
    paths[i] = arena_format(&o->mem, "%s/%d.part", o->folder, i);
    all[i] = render_shard(o, i + 1, paths[i]);
  }
  part_set set;
  part whole;
  report why = {.mem = &o->mem};
  if (!part_set_read(&set, paths, SHARDS, &o->mem, &err)) give_up(&err, 4);
  if (!part_set_fits(&set, &why)) exit(1);
  if (!part_set_join(&whole, &set, &o->mem, &err)) give_up(&err, 4);
  for (int i = 0; i < SHARDS; i++)
    remove(paths[i]);
  all[3] = film_image(&whole.film[PART_COLOR], &o->mem);
  render_settings one = {
      .width = WIDTH, .height = HEIGHT, .spp = SPP, .by = &o->all.by};
  all[4] = render(o, &one).color;
  all[5] = image_new(&o->mem, WIDTH, HEIGHT);
  int differing = 0;
  for (int i = 0; i < WIDTH * HEIGHT; i++) {
    vec3 d = vec3_sub(all[3].pixels[i], all[4].pixels[i]);
    differing += d.x != 0 || d.y != 0 || d.z != 0;
    all[5].pixels[i] = (vec3){fabsf(d.x), fabsf(d.y), fabsf(d.z)};
  }
  for (int i = 0; i < 5; i++)
    all[i] = exposed(o, &all[i], o->all.scene.exposure);
  printf("merged and single: %d pixels differ\n", differing);
  publish(o->folder, "shards", sheet(o, all, 6, 3));
}

// A colour for each hand of tiles.
static vec3 color_of(size_t hand) {
  static const vec3 colors[8] = {{0.80f, 0.25f, 0.02f}, {0.05f, 0.20f, 0.60f},
                                 {0.02f, 0.35f, 0.20f}, {0.75f, 0.60f, 0.05f},
                                 {0.45f, 0.10f, 0.40f}, {0.10f, 0.45f, 0.80f},
                                 {0.85f, 0.75f, 0.60f}, {0.12f, 0.12f, 0.12f}};
  return colors[hand % 8];
}

// Which hand has which tile of a picture of 640x400.
static image deal_map(output *o, int hands, bool straight) {
  enum { ACROSS = 40, DOWN = 25, SIDE = 5 };
  image im = image_new(&o->mem, ACROSS * SIDE, DOWN * SIDE);
  shard s = {ACROSS * SHARD_TILE, DOWN * SHARD_TILE, 0, hands};
  for (s.index = 0; s.index < hands; s.index++)
    for (size_t k = 0; k < shard_tiles(&s); k++) {
      size_t t =
          straight ? (size_t)s.index + k * (size_t)hands : shard_tile(&s, k);
      for (int i = 0; i < SIDE * SIDE; i++) {
        int x = (int)(t % ACROSS) * SIDE + i % SIDE;
        int y = (int)(t / ACROSS) * SIDE + i / SIDE;
        im.pixels[y * im.width + x] = color_of((size_t)s.index);
      }
    }
  return im;
}

static void draw_deals(output *o) {
  image two[2] = {deal_map(o, 8, true), deal_map(o, 8, false)};
  publish(o->folder, "deals", sheet(o, two, 2, 2));
}

// Random numbers by run instead of by pixel: as if each of three runs had
// started its generator once for each sample of the picture.
static uint64_t pixel_of_run(uint64_t pixel) {
  uint64_t across = (WIDTH + SHARD_TILE - 1) / SHARD_TILE;
  uint64_t x = pixel % WIDTH / SHARD_TILE, y = pixel / WIDTH / SHARD_TILE;
  return (y * across + x) % SHARDS;
}

static vec2 seam_place(const void *self, uint64_t pixel, uint32_t sample) {
  const integrator *by = self;
  return by->place(by->self, pixel_of_run(pixel), sample);
}

static void *seam_room(const void *self, arena *mem) {
  const integrator *by = self;
  return by->room(by->self, mem);
}

static void seam_radiance(const void *self, const path_start *starts, size_t n,
                          vec3 *out, path_stats *stats, void *room) {
  static path_start moved[INTEGRATOR_BATCH];
  const integrator *by = self;
  for (size_t i = 0; i < n; i++) {
    moved[i] = starts[i];
    moved[i].pixel = pixel_of_run(starts[i].pixel);
  }
  by->radiance(by->self, moved, n, out, stats, room);
}

// Each pixel of the middle as four.
static image twice_as_large(output *o, const image *im, int side) {
  image out = image_new(&o->mem, 2 * im->width - 4 * side, 2 * im->height);
  for (int y = 0; y < out.height; y++)
    for (int x = 0; x < out.width; x++)
      out.pixels[y * out.width + x] =
          im->pixels[y / 2 * im->width + side + x / 2];
  return out;
}

// The same numbers in every tile: by one thread, as it shares a buffer.
static void draw_seams(output *o) {
  integrator wrong = {&o->all.by, seam_place, seam_room, seam_radiance, NULL};
  render_settings set = {
      .width = WIDTH, .height = HEIGHT, .spp = 4, .by = &o->all.by};
  image all[2];
  all[0] = render(o, &set).color;
  pool *threads = o->threads;
  o->threads = NULL;
  set.by = &wrong;
  all[1] = render(o, &set).color;
  o->threads = threads;
  set.spp = 1024;
  set.by = &o->all.by;
  image truth = render(o, &set).color;
  for (int k = 0; k < 2; k++) {
    double sum = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
      double d = (double)(all[k].pixels[i].y - truth.pixels[i].y);
      double t = (double)truth.pixels[i].y;
      sum += d * d / (t * t + 0.01);
    }
    printf("%s: relative error %.3f\n", k == 0 ? "by pixel" : "by run",
           sqrt(sum / (WIDTH * HEIGHT)));
    all[k] = exposed(o, &all[k], o->all.scene.exposure);
  }
  for (int k = 0; k < 2; k++)
    all[k] = twice_as_large(o, &all[k], 40);
  publish(o->folder, "seams", sheet(o, all, 2, 2));
}

// The mean of two pictures: of their sums, and of their PNGs; both shown darker
// by two stops.
static void draw_clipped(output *o) {
  image all[2], half[2];
  for (int k = 0; k < 2; k++) {
    o->all.tracer.seed = (uint64_t)k;
    render_settings set = {
        .width = WIDTH, .height = HEIGHT, .spp = 32, .by = &o->all.by};
    half[k] = render(o, &set).color;
    all[k] = image_new(&o->mem, WIDTH, HEIGHT);
  }
  o->all.tracer.seed = 0;
  srgb_table codes = srgb_table_new();
  for (int i = 0; i < WIDTH * HEIGHT; i++)
    for (int c = 0; c < 3; c++) {
      float a = (&half[0].pixels[i].x)[c], b = (&half[1].pixels[i].x)[c];
      float gain = exp2f(o->all.scene.exposure);
      double x = srgb_decode(srgb_code(&codes, gain * a) / 255.0);
      double y = srgb_decode(srgb_code(&codes, gain * b) / 255.0);
      (&all[0].pixels[i].x)[c] = gain * (a + b) / 2;
      (&all[1].pixels[i].x)[c] = (float)((x + y) / 2);
    }
  for (int k = 0; k < 2; k++)
    all[k] = exposed(o, &all[k], -3);
  publish(o->folder, "clipped", sheet(o, all, 2, 2));
}

// What became of a picture of which one byte was changed.
typedef enum outcome {
  SAME_FILE,
  REFUSED,
  SAME_PICTURE,
  OTHER_PICTURE
} outcome;

// A small file, and whoever reads it.
typedef struct subject {
  const char *path;
  bool (*load_stored)(pixmap *, FILE *, const char *, arena *, error *);
  bool (*load_linear)(image *, FILE *, const char *, arena *, error *);
  uint8_t bytes[256];
  size_t size;
} subject;

// The pixels of s as bytes in mem, NULL when it is refused; *n is how many.
static const void *pixels_of(const subject *s, size_t *n, arena *mem) {
  error err;
  pixmap map;
  image im;
  FILE *f = fmemopen((void *)(uintptr_t)s->bytes, s->size, "rb");
  bool ok = f != NULL && (s->load_stored != NULL
                              ? s->load_stored(&map, f, s->path, mem, &err)
                              : s->load_linear(&im, f, s->path, mem, &err));
  if (f != NULL) fclose(f);
  if (!ok) return NULL;
  if (s->load_linear != NULL) {
    *n = (size_t)im.width * (size_t)im.height * sizeof *im.pixels;
    return im.pixels;
  }
  *n = (size_t)map.width * (size_t)map.height * (size_t)map.channels *
       (size_t)map.depth / 8;
  return map.samples;
}

static outcome outcome_of(const subject *s, size_t at, uint8_t value) {
  if (s->bytes[at] == value) return SAME_FILE;
  arena mem = {0};
  subject bad = *s;
  bad.bytes[at] = value;
  size_t n = 0, m = 0;
  const void *right = pixels_of(s, &n, &mem), *got = pixels_of(&bad, &m, &mem);
  outcome result = OTHER_PICTURE;
  if (got == NULL)
    result = REFUSED;
  else if (right != NULL && n == m && memcmp(right, got, n) == 0)
    result = SAME_PICTURE;
  arena_free(&mem);
  return result;
}

// A column for each byte of a file, a row for every fourth value, 0 on top.
static void draw_outcomes(image *im, int top, const subject *s) {
  static const vec3 color[] = {[SAME_FILE] = {0, 0, 0},
                               [REFUSED] = {0.72f, 0.72f, 0.72f},
                               [SAME_PICTURE] = {0.05f, 0.2f, 0.6f},
                               [OTHER_PICTURE] = {0.9f, 0.35f, 0.02f}};
  enum { CELL = 4, STEP = 4 };
  for (size_t at = 0; at < s->size; at++)
    for (int v = 0; v < 256; v += STEP) {
      vec3 c = color[outcome_of(s, at, (uint8_t)(v + s->bytes[at] % STEP))];
      for (int x = 0; x < CELL - 1; x++)
        im->pixels[(top + v / STEP) * im->width + (int)at * CELL + x] = c;
    }
}

// Every byte of four files, changed.
static void draw_changes(output *o) {
  subject all[] = {
      {.path = "tests/fuzz/seeds/png/rgb8", .load_stored = png_load},
      {.path = "tests/fuzz/seeds/hdr/runs", .load_linear = hdr_load},
      {.path = "tests/fuzz/seeds/tga/palette", .load_stored = tga_load},
      {.path = "tests/fuzz/seeds/pfm/colour", .load_linear = pfm_load}};
  enum { COUNT = sizeof all / sizeof *all, TALL = 64, GAP = 8 };
  image im = image_new(&o->mem, 4 * 88, COUNT * (TALL + GAP) - GAP);
  for (int i = 0; i < im.width * im.height; i++)
    im.pixels[i] = vec3_all(1);
  for (int i = 0; i < COUNT; i++) {
    error err;
    FILE *f = file_open(all[i].path, &err);
    if (f == NULL) give_up(&err, 4);
    all[i].size = fread(all[i].bytes, 1, sizeof all[i].bytes, f);
    fclose(f);
    draw_outcomes(&im, i * (TALL + GAP), &all[i]);
  }
  publish(o->folder, "changes", im);
}

int main(int argc, char **argv) {
  if (argc != 2) return 2;
  output o = {.folder = argv[1]};
  o.threads = pool_new(&o.mem, pool_default_threads());
  studio_open(&o.all, "scenes/garden.scene", &o.mem, o.threads);
  draw_shards(&o);
  draw_deals(&o);
  draw_clipped(&o);
  studio_open(&o.all, "scenes/cornell.scene", &o.mem, o.threads);
  draw_seams(&o);
  draw_changes(&o);
  pool_free(o.threads);
  arena_free(&o.mem);
  return 0;
}

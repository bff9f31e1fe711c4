// figures.c — the pictures of chapter 14, and the numbers that its text quotes.

#include "../tripod.h"
#include "clock.h"
#include "post.h"
#include "raster.h"
#include "view_paths.h"
#include "view_script.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Where the pictures go, and what is shown.
typedef struct output {
  const char *folder;
  arena mem;
  pool *threads;  // the caller is one of them
  pool *tracers;  // the caller is none of them
  scene scene;
  gl *g;
} output;

static void fill(image *im, int x0, int y0, int w, int h, vec3 color) {
  for (int y = y0; y < y0 + h; y++)
    for (int x = x0; x < x0 + w; x++)
      if (x >= 0 && x < im->width && y >= 0 && y < im->height)
        im->pixels[y * im->width + x] = color;
}

// n pictures of one size, `across` in a row, with 4 pixels between.
static image sheet(output *o, const image *im, int n, int across) {
  int w = im->width + 4, h = im->height + 4, rows = (n + across - 1) / across;
  image out = paper(&o->mem, across * w - 4, rows * h - 4);
  for (int i = 0; i < n; i++)
    paste(out, im[i], i % across * w, i / across * h);
  return out;
}

// Brighter by so many stops, and cut off at white.
static image exposed(output *o, const image *im, float gain) {
  image out = image_new(&o->mem, im->width, im->height);
  for (int i = 0; i < im->width * im->height; i++)
    out.pixels[i] = vec3_min(vec3_scale(im->pixels[i], gain), vec3_all(1));
  return out;
}

static image frosted(output *o, const image *im, float radius) {
  return post_frosted(im, (post_frost){.radius = radius}, &o->mem, o->threads);
}

static view_paths *paths_new(output *o, int width, int height) {
  view_paths_settings set = {.width = width,
                             .height = height,
                             .world = {.scene = &o->scene, .lights = true}};
  set.world.dfg = matter_table(&o->scene, PBR_GGX, &o->mem, o->threads);
  return view_paths_new(&set, o->tracers, &o->mem);
}

// A view of the scene's first camera, path-traced.
static image traced(output *o, int width, int height, int spp) {
  error err;
  view_look look = {.camera = o->scene.cameras[0]};
  view_paths *p = paths_new(o, width, height);
  if (!view_paths_restart(p, &look, &err)) give_up(&err, 4);
  return view_paths_finish(p, spp, &o->mem);
}

// A script's frames; those with no path tracer by OpenGL.
static const char FLIGHT[] = "frame start\n"
                             "key w down\nwait 1.2\nkey w up\nmouse 60 10\n"
                             "frame flown\n"
                             "key shift\nframe frosted\nkey shift\n"
                             "key space\nframe paths\n"
                             "key 0\nframe balls\n"
                             "key 4\nkey 4\nkey 4\nframe rough\n";

enum { STRIP_WIDTH = 156, STRIP_HEIGHT = 100, STRIP_SPP = 24 };

static raster *open_raster(output *o, int width, int height) {
  error err;
  raster *r;
  raster_settings set = {.width = width,
                         .height = height,
                         .msaa = 4,
                         .lights = true,
                         .shadows = true,
                         .sky = true};
  if (!raster_new(&r, o->g, &o->scene, &set, &o->mem, &err)) give_up(&err, 4);
  return r;
}

static image drawn(output *o, raster *r, const camera *c, int width,
                   int height) {
  error err;
  camera_view view = view_by(c, width, height);
  if (!raster_draw(r, &view, &err)) give_up(&err, 4);
  return raster_read(r, &o->mem);
}

// The scene's first camera, by OpenGL.
static image rastered(output *o, int width, int height) {
  raster *r = open_raster(o, width, height);
  image im = drawn(o, r, &o->scene.cameras[0], width, height);
  raster_free(r);
  return im;
}

static image draw_frame(output *o, const view_state *s, raster *r,
                        view_paths *p) {
  error err;
  image im;
  if (s->paths) {
    if (!view_paths_restart(p, &s->look, &err)) give_up(&err, 4);
    im = view_paths_finish(p, STRIP_SPP, &o->mem);
  } else {
    im = drawn(o, r, &s->look.camera, STRIP_WIDTH, STRIP_HEIGHT);
  }
  return s->frosted ? frosted(o, &im, 3) : im;
}

static void draw_strip(output *o) {
  error err;
  view_script script;
  span text = {FLIGHT, sizeof FLIGHT - 1};
  if (!view_script_read(&script, text, "flight", &o->mem, &err))
    give_up(&err, 4);
  raster *r = open_raster(o, STRIP_WIDTH, STRIP_HEIGHT);
  view_paths *p = paths_new(o, STRIP_WIDTH, STRIP_HEIGHT);
  view_state s =
      view_start(&o->scene.cameras[0], o->scene.lo, o->scene.hi, true);
  image frames[6];
  int n = 0;
  for (size_t i = 0; i < script.count; i++) {
    view_happen(&s, &script.events[i]);
    if (script.events[i].kind == VIEW_EVENT_FRAME && n < 6)
      frames[n++] = draw_frame(o, &s, r, p);
  }
  raster_free(r);
  publish(o->folder, "flight", sheet(o, frames, 6, 3));
}

// Where grains look, from a picture whose colours are coordinates: dots about
// the middle of a square.  Beside it the same with distances uniform.
static void draw_grains(output *o) {
  enum { SIDE = 160, RADIUS = 70 };
  image ramp = image_new(&o->mem, 400, 400), two[2];
  for (int i = 0; i < 400 * 400; i++)
    ramp.pixels[i] = (vec3){(float)(i % 400), (float)(i / 400), 0};
  image out = frosted(o, &ramp, RADIUS);
  for (int k = 0; k < 2; k++)
    two[k] = paper(&o->mem, SIDE, SIDE);
  for (int i = 0; i < 1500; i++) {
    int x = 100 + i % 200, y = 100 + i / 200 * 20;
    vec3 p = out.pixels[y * 400 + x];
    vec2 d = {p.x - (float)x, p.y - (float)y};
    float part = sqrtf(d.x * d.x + d.y * d.y) / RADIUS;
    for (int k = 0; k < 2; k++) {
      float by = k == 0 ? part : 1;
      fill(&two[k], SIDE / 2 + (int)floorf(d.x * by),
           SIDE / 2 + (int)floorf(d.y * by), 2, 2, (vec3){0.02f, 0.1f, 0.4f});
    }
  }
  publish(o->folder, "grains", sheet(o, two, 2, 2));
}

// The garden: behind panes, and by stops.
static void draw_garden(output *o) {
  image im = rastered(o, 232, 130), four[4], three[3];
  static const float RADII[] = {0, 2, 6, 18};
  for (int i = 0; i < 4; i++) {
    image pane = frosted(o, &im, RADII[i]);
    four[i] = exposed(o, &pane, 1.4f);
  }
  publish(o->folder, "frosted", sheet(o, four, 4, 2));
  image small = rastered(o, 156, 88);
  for (int i = 0; i < 3; i++)
    three[i] = exposed(o, &small, i == 0 ? 0.25f : i == 1 ? 1 : 4);
  publish(o->folder, "exposure", sheet(o, three, 3, 3));
}

static void draw_passes(output *o) {
  static const int SPP[] = {1, 4, 16, 64};
  image four[4];
  for (int i = 0; i < 4; i++) {
    image im = traced(o, 156, 98, SPP[i]);
    four[i] = exposed(o, &im, 1);
  }
  publish(o->folder, "passes", sheet(o, four, 4, 2));
}

// What the thread of the window does, from left to right: events (black),
// drawing (blue), a pass of paths (orange), and above it when keys arrive.
static void draw_timeline(output *o) {
  const vec3 ink = vec3_all(0.02f), blue = {0.05f, 0.2f, 0.6f},
             orange = {0.8f, 0.25f, 0.02f}, grey = vec3_all(0.75f);
  image im = paper(&o->mem, 480, 150);
  // One thread: a pass of 220 pixels, three keys that wait for its end.
  for (int i = 0; i < 2; i++) {
    fill(&im, 4 + 234 * i, 34, 8, 20, blue);
    fill(&im, 14 + 234 * i, 34, 220, 20, orange);
  }
  for (int i = 0; i < 3; i++) {
    int key = 60 + 40 * i;
    fill(&im, key, 12, 3, 12, ink);
    fill(&im, key, 24, 238 - key, 2, grey);
    fill(&im, 236 + 3 * i, 24, 2, 10, ink);
  }
  // Two: the pass is stopped at the first key, and a frame is drawn at each.
  fill(&im, 4, 90, 8, 20, blue);
  fill(&im, 14, 114, 46, 20, orange);
  for (int i = 0; i < 3; i++) {
    int key = 60 + 40 * i;
    fill(&im, key, 72, 3, 12, ink);
    fill(&im, key + 2, 84, 2, 6, ink);
    fill(&im, key + 3, 90, 8, 20, blue);
  }
  fill(&im, 154, 114, 322, 20, orange);
  publish(o->folder, "timeline", im);
}

// Distance over time of two flights, at 30 and at 100 frames a second that
// turn to 15: a step a frame (left), a step by the clock (right).
static void draw_speed(output *o) {
  image two[2];
  const vec3 colors[2] = {{0.8f, 0.25f, 0.02f}, {0.05f, 0.2f, 0.6f}};
  for (int k = 0; k < 2; k++) {
    two[k] = paper(&o->mem, 230, 150);
    fill(&two[k], 10, 138, 216, 2, vec3_all(0));
    fill(&two[k], 10, 6, 2, 134, vec3_all(0));
    for (int m = 0; m < 2; m++) {
      double time = 0, way = 0;
      while (time < 2) {
        double step = m == 0 ? 1.0 / 30 : time < 1 ? 1.0 / 100 : 1.0 / 15;
        way += k == 0 ? 1.0 / 60 : step;
        time += step;
        int x = 12 + (int)(105 * time), y = 136 - (int)(60 * way);
        fill(&two[k], x - 1, y - 1 + 4 * m * k, 3, 3, colors[m]);
      }
    }
  }
  publish(o->folder, "speed", sheet(o, two, 2, 2));
}

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// How long a restart keeps its caller, in the middle of a pass.
static void time_restarts(output *o) {
  enum { COUNT = 101 };
  double took[COUNT];
  error err;
  arena once = {0};
  view_look look = {.camera = o->scene.cameras[0]};
  view_paths *p = paths_new(o, 480, 270);
  double pass = clock_seconds();
  if (!view_paths_restart(p, &look, &err)) give_up(&err, 4);
  view_paths_finish(p, 1, &once);
  pass = clock_seconds() - pass;
  view_paths_restart(p, &look, &err);
  for (int i = 0; i < COUNT; i++) {
    struct timespec wait = {0, 5000000};
    nanosleep(&wait, NULL);
    double start = clock_seconds();
    view_paths_restart(p, &look, &err);
    took[i] = clock_seconds() - start;
  }
  view_paths_stop(p);
  qsort(took, COUNT, sizeof *took, by_size);
  printf("a pass of 480x270        %6.0f ms\n", 1e3 * pass);
  printf("a restart, median        %6.1f ms\n", 1e3 * took[COUNT / 2]);
  printf("a restart, longest       %6.1f ms\n", 1e3 * took[COUNT - 1]);
  arena_free(&once);
}

static void time_glass(output *o) {
  image im = image_new(&o->mem, 1280, 720);
  double start = clock_seconds();
  post_frosted(&im, (post_frost){.radius = 8}, &o->mem, NULL);
  printf("glass on 1280x720        %6.0f ms\n",
         1e3 * (clock_seconds() - start));
}

int main(int argc, char **argv) {
  if (argc != 2) return 2;
  output o = {.folder = argv[1]};
  o.threads = pool_new(&o.mem, pool_default_threads());
  o.tracers = pool_new(&o.mem, pool_default_threads() + 1);
  error err;
  if (!gl_open(&o.g, GL_BACKEND_AUTO, &o.mem, &err)) give_up(&err, 4);
  draw_timeline(&o);
  draw_speed(&o);
  draw_grains(&o);
  open_scene(&o.scene, "scenes/materials.scene", NULL, &o.mem, o.threads);
  draw_strip(&o);
  draw_passes(&o);
  open_scene(&o.scene, "scenes/garden.scene", NULL, &o.mem, o.threads);
  draw_garden(&o);
  time_restarts(&o);
  time_glass(&o);
  gl_close(o.g);
  pool_free(o.tracers);
  pool_free(o.threads);
  arena_free(&o.mem);
  return 0;
}

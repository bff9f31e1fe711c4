// figures.c — the pictures of chapter 15.

#include "picture.h"
#include "plot.h"

#include <stdio.h>
#include <stdlib.h>

// Where the pictures go.
typedef struct output {
  const char *folder;
  arena mem;
} output;

static void publish(output *o, const char *name, image im) {
  error err;
  const char *path = arena_format(&o->mem, "%s/%s.png", o->folder, name);
  if (picture_write(&im, path, PICTURE_PNG, 8, &err)) return;
  fprintf(stderr, "%s\n", err.text);
  exit(4);
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
  publish(o, "letters", sketch_image(&s, &o->mem));
}

int main(int argc, char **argv) {
  if (argc != 2) return 2;
  output o = {.folder = argv[1]};
  draw_letters(&o);
  arena_free(&o.mem);
  return 0;
}

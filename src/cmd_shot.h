// cmd_shot.h — what a command line asks to be shown, by whichever engine: a
// scene, and a camera with a film.

#ifndef CMD_SHOT_H
#define CMD_SHOT_H

#include "cmd_shared.h"
#include "pool.h"
#include "scene.h"

typedef struct shot {
  const options *o;
  arena *mem;
  pool *threads;
  report remarks;  // starts with mem
  scene scene;
  int width, height;   // of the film in pixels
  int x0, y0, x1, y1;  // the crop, half-open; all 0 without one
  camera camera;
  camera_view view;
} shot;

// Read the scene that the command line names and apply what it says of
// surfaces.  An exit code; when it is not EXIT_DONE, all has been said.
int shot_read(shot *s);

// The same without the pictures that the scene names: they are found, not
// decoded.  shot_decode follows.
int shot_open(shot *s);

// Decode the textures of each material whose bits are set in wanted, or all
// where that is NULL, and the map of the environment; an exit code.
int shot_decode(shot *s, const unsigned *wanted, bool environment);

// Print what was noticed so far; with --strict a warning is an error.  An exit
// code.
int shot_remark(const shot *s);

// Choose film, crop and camera; an exit code.
int shot_frame(shot *s);

// The camera for a film of another size, without a crop; an exit code.
int shot_resize(shot *s, int width, int height);

#endif

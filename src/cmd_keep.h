// cmd_keep.h — renders that another run goes on with: shards, checkpoints, and
// parts of pictures.

#ifndef CMD_KEEP_H
#define CMD_KEEP_H

#include "cmd_shot.h"
#include "part.h"
#include "render_keep.h"

#include "render.h"

typedef struct cmd_keep {
  const options *o;
  arena *mem;
  const char *path;    // of the checkpoint; NULL: none
  bool to_part;        // the output is a part
  double every, last;  // seconds between two, and when there was one
  part part;           // as it is to be written
  adaptive *adaptive;  // who watches: one of these, or nobody
  doubling *doubling;
  render_keep hooks;
  int writes;
  double seconds;      // that they took
  bool resumed, lost;  // the last write failed
  uint64_t before;     // samples that were there
} cmd_keep;

// What the command line says; an exit code.
int cmd_keep_plan(cmd_keep *k, const options *o, arena *mem);

// Whether the output is a part is known now; an exit code.
int cmd_keep_aim(cmd_keep *k, bool to_part);

// Whether sums are to be kept at all.
bool cmd_keep_wanted(const cmd_keep *k);

// Know the picture, whose settings are all but by and guide, and with --resume
// read what there is of it.  Adds shard and keep to the settings.  An exit
// code.
int cmd_keep_open(cmd_keep *k, const shot *sh, render_settings *s);

// Who watches has been chosen: tell what it knew.
void cmd_keep_watch(cmd_keep *k);

// After rendering, before a picture is written: an exit code, EXIT_EARLY when
// it was stopped and the checkpoint stands for the picture.
int cmd_keep_close(cmd_keep *k, const render_result *r);

// The member "checkpoint".
void cmd_keep_json(json *j, const cmd_keep *k);

#endif

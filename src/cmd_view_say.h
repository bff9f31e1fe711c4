// cmd_view_say.h — what the viewer has to say in words.

#ifndef CMD_VIEW_SAY_H
#define CMD_VIEW_SAY_H

#include "cmd_shared.h"
#include "view_state.h"

// The `facet render` line for what is seen, to standard output.
void view_print_command(const options *o, const view_state *s, int width,
                        int height, arena *mem);

// The keys, to stderr.
void view_print_keys(void);

// That a picture was written, to stderr.
void view_say_written(const char *path);

// The window's title; spp 0 where no path is traced.
const char *view_title(const char *scene_path, int spp, arena *mem);

// The first of SCENE-1.png, SCENE-2.png, ... in the current folder that does
// not exist.
const char *view_free_name(const char *scene_path, arena *mem);

#endif

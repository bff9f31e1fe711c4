// cmd_render_plan.h — the plan of a render: made, and told what was done.

#ifndef CMD_RENDER_PLAN_H
#define CMD_RENDER_PLAN_H

#include "cmd_render_say.h"

// What the picture needs, and that much of its files; an exit code.
int render_plan_make(render_job *j);

// The films that the plan wants, by the bits of render.h; with --no-skip more
// than are written.
unsigned render_plan_films(const render_job *j);

// Tell the plan what paths did, and what the picture and its companions took.
void render_plan_note_paths(render_job *j);
void render_plan_note_output(render_job *j);

#endif

// cmd_plan.h — the plan of a shot: made from a command line, carried out on its
// scene, and printed.

#ifndef CMD_PLAN_H
#define CMD_PLAN_H

#include "cmd_shot.h"
#include "plan.h"

// What the command line asks for, of the engine that draws.
plan_request cmd_plan_request(const shot *s, bool path);

// What facet render asks for without any flag, of a scene that is not rendered.
// False, and why, where its camera cannot be used.
bool cmd_plan_usual(plan_request *out, const scene *s, bool path, error *err);

// Take from the shot's scene what the plan does not need and decode what it
// does; an exit code.
int cmd_plan_carry_out(plan *p, shot *s);

// The table of --explain, to out.
void cmd_plan_print(const plan *p, FILE *out);

// The member key: a list of stages.
void cmd_plan_json(json *j, const char *key, const plan *p);

#endif

// cmd_forced.h — for --no-skip: the stages that a shot has no use for, done all
// the same, and their results thrown away.

#ifndef CMD_FORCED_H
#define CMD_FORCED_H

#include "cmd_plan.h"

// Do each stage of a list that the plan wants forced and nobody has done yet,
// and note it.
void cmd_forced_tables(plan *p, const shot *s);

// A tree that no ray will ask.
void cmd_forced_tree(plan *p, const shot *s);

#endif

// help_text.h — what help and the manual say beside the option table.

#ifndef HELP_TEXT_H
#define HELP_TEXT_H

#include "option_table.h"

// A run of options under one heading: from `first` to the next group's.
typedef struct help_group {
  option_id first;
  const char *title;
} help_group;

// In the order of options; ended by a group without a title.
extern const help_group help_groups[];

// A command line that is worth copying, and what it does.
typedef struct help_example {
  unsigned command;  // one of CMD_
  const char *line, *what;
} help_example;

// Ended by an entry without a line.
extern const help_example help_examples[];

// What the manual says of all commands: a term and its explanation, under the
// title of the last entry that has one.
typedef struct help_item {
  const char *title;  // "FILES", or NULL
  const char *term, *text;
} help_item;

// Ended by an entry without a term.
extern const help_item help_items[];

#endif

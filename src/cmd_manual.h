// cmd_manual.h — the option table in the languages of man and of shells.

#ifndef CMD_MANUAL_H
#define CMD_MANUAL_H

#include "option_table.h"

#include <stdio.h>

// "-o, --output FILE" into text of the given size.
void cmd_write_flag(char *text, size_t size, const option *o);

// What help says of an option, and its default.
void cmd_write_help(char *text, size_t size, const option *o);

// The heading under which help has an option; the same pointer for all of one
// group.
const char *cmd_group_of(option_id id);

// The manual page of a command, facet-COMMAND(1); of all of facet for NULL.
void cmd_print_manual(FILE *out, const command *c);

// What lets "bash", "zsh" or "fish" complete commands, options, and the words
// that these take.
void cmd_print_completion(FILE *out, const char *shell);

#endif

// option.h — a command line, checked against the table.

#ifndef OPTION_H
#define OPTION_H

#include "error.h"
#include "option_table.h"

#include <stddef.h>

// The argument of one option, in the form that its kind gives it.
typedef struct option_value {
  bool given;        // on the command line, not only the fallback
  const char *text;  // as written; NULL when there is neither
  unsigned words;    // the word's place, 0 first; of OPTION_WORDS a bit each
  long long whole[4];
  float number[3];
} option_value;

// A command line.
typedef struct options {
  const command *command;
  option_value value[OPTION_COUNT];
  const char **operands;
  int operand_count;
  double started;  // clock_seconds when main began
} options;

// Parse argv of main; operands needs room for argc pointers and lies in
// out->operands.  Both --name VALUE and --name=VALUE, -n VALUE and -nVALUE,
// switches in a bundle (-qv); the last one wins; -- ends the options.  What is
// wrong is said with the nearest right thing, and calls for exit status 2.
bool options_parse(options *out, int argc, char **argv, const char **operands,
                   error *err);

// The command whose words are at the front of argv[1..argc-1], argc > 1, and
// how many words that took; NULL when there is none, with the reason in err.
const command *command_of(int argc, char **argv, int *words, error *err);

// Append to text (of the given size) the i-th of the words that an option's
// argument lists; false when there are not so many.
bool option_word(const option *o, unsigned i, char *text, size_t size);

// The i-th of the numbers that the argument of OPTION_WHOLES lists; false when
// there are not so many.
bool option_whole(const option_value *v, unsigned i, int *number);

// The i-th of the sizes that the argument of OPTION_SIZES lists; false when
// there are not so many.
bool option_size(const option_value *v, unsigned i, int *width, int *height);

#endif

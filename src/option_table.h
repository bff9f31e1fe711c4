// option_table.h — every command and every option, said once.

#ifndef OPTION_TABLE_H
#define OPTION_TABLE_H

#include "option_id.h"

#include <stdbool.h>

// Commands as bits, so that an option can say which ones know it.
enum {
  CMD_RENDER = 1,
  CMD_INFO = 2,
  CMD_COMPARE = 4,
  CMD_BENCH_LOAD = 8,
  CMD_BENCH_RAYS = 16,
  CMD_BENCH_RASTER = 32,
  CMD_HELP = 64,
  CMD_VIEW = 128,
  CMD_IBL = 256,
  CMD_BENCH_IBL = 512,
  CMD_BENCH_ERROR = 1024,
  CMD_MERGE = 2048,
  CMD_CACHE = 4096,
  CMD_ALL = 8191
};

// A command: its one or two words, and what it wants after the options.
typedef struct command {
  const char *name;      // "bench rays"
  unsigned bit;          // one of CMD_
  const char *operands;  // as help shows them
  int least, most;       // how many operands
  const char *summary;   // one line
  const char *details;   // paragraphs for help and man page
} command;

// What an option's argument is.
typedef enum option_kind {
  OPTION_SWITCH,  // none
  OPTION_TEXT,    // any text
  OPTION_WORD,    // one of the words that `argument` lists, split at |
  OPTION_WORDS,   // some of them, split at commas
  OPTION_WHOLE,   // a whole number, low..high
  OPTION_NUMBER,  // a number, low..high
  OPTION_TRIPLE,  // X,Y,Z
  OPTION_SIZE,    // WxH, whole
  OPTION_SIZES,   // some of them, split at commas
  OPTION_BOX,     // X0,Y0,X1,Y1, whole
  OPTION_WHOLES   // whole numbers, split at commas
} option_kind;

// An option: what the parser accepts, and what help prints.
typedef struct option {
  const char *name;  // without the dashes
  char letter;       // the short form, or 0
  unsigned commands;
  option_kind kind;
  const char *argument;  // as help shows it; the words of OPTION_WORD(S)
  const char *fallback;  // parsed where the option is not given; or NULL
  double low, high;      // of numbers; the ends belong to it unless `open`
  bool open;
  const char *help;
} option;

extern const option option_table[OPTION_COUNT];

// Ended by an entry without a name.
extern const command command_table[];

// Words that name parts of facet still to come, NULL-ended.
extern const char *const later_words[];

#endif

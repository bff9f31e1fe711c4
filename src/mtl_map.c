// mtl_map.c

#include "mtl_map.h"

#include <string.h>

// What follows an option.
typedef enum map_argument {
  ARGUMENT_VECTOR,   // one to three numbers
  ARGUMENT_NUMBER,   // one
  ARGUMENT_NUMBERS,  // two
  ARGUMENT_SWITCH,   // on or off
  ARGUMENT_WORD
} map_argument;

// What an option does.
typedef enum map_option_kind {
  OPTION_SCALE,
  OPTION_OFFSET,
  OPTION_BUMP,
  OPTION_CLAMP,
  OPTION_CHANNEL,
  OPTION_IGNORED
} map_option_kind;

// An option by name: what follows it and what it does.
typedef struct map_option_entry {
  const char *name;
  map_argument argument;
  map_option_kind kind;
} map_option_entry;

// Every option of the format.
static const map_option_entry MAP_OPTIONS[] = {
    {"-s", ARGUMENT_VECTOR, OPTION_SCALE},
    {"-o", ARGUMENT_VECTOR, OPTION_OFFSET},
    {"-t", ARGUMENT_VECTOR, OPTION_IGNORED},
    {"-bm", ARGUMENT_NUMBER, OPTION_BUMP},
    {"-boost", ARGUMENT_NUMBER, OPTION_IGNORED},
    {"-texres", ARGUMENT_NUMBER, OPTION_IGNORED},
    {"-mm", ARGUMENT_NUMBERS, OPTION_IGNORED},
    {"-clamp", ARGUMENT_SWITCH, OPTION_CLAMP},
    {"-blendu", ARGUMENT_SWITCH, OPTION_IGNORED},
    {"-blendv", ARGUMENT_SWITCH, OPTION_IGNORED},
    {"-cc", ARGUMENT_SWITCH, OPTION_IGNORED},
    {"-imfchan", ARGUMENT_WORD, OPTION_CHANNEL},
    {"-type", ARGUMENT_WORD, OPTION_IGNORED},
};

// The number of options, and the entry of a word that is none.
enum { MAP_OPTION_COUNT = sizeof MAP_OPTIONS / sizeof MAP_OPTIONS[0] };

static int map_option_find(span word) {
  int i = 0;
  while (i < MAP_OPTION_COUNT && !span_is(word, MAP_OPTIONS[i].name))
    i++;
  return i;
}

// Take up to `most` numbers off the front of *rest, but not its last word,
// which is the file even when it looks like a number.
static int map_numbers(span *rest, int most, float *x) {
  int n = 0;
  while (n < most) {
    span after = *rest;
    float value;
    if (!span_float(text_word(&after), &value)) break;
    if (text_trim(after).length == 0) break;
    *rest = after;
    x[n++] = value;
  }
  return n;
}

// Apply an option that has its arguments.
static void map_apply(mtl_map *m, int option, const float x[3], span word) {
  switch (MAP_OPTIONS[option].kind) {
  case OPTION_SCALE: m->scale = (vec3){x[0], x[1], x[2]}; break;
  case OPTION_OFFSET: m->offset = (vec3){x[0], x[1], x[2]}; break;
  case OPTION_BUMP: m->bump = x[0]; break;
  case OPTION_CLAMP: m->clamp = span_is(word, "on"); break;
  case OPTION_CHANNEL: m->channel = word.at[0]; break;
  case OPTION_IGNORED: break;
  }
}

// Whether a word is what the option allows.
static bool map_word_fits(int option, span word) {
  if (MAP_OPTIONS[option].argument == ARGUMENT_SWITCH)
    return span_is(word, "on") || span_is(word, "off");
  if (MAP_OPTIONS[option].kind != OPTION_CHANNEL) return word.length > 0;
  return word.length == 1 && strchr("rgbmlz", word.at[0]) != NULL;
}

// Parse one option whose name has been taken off *rest.
static bool map_option(mtl_map *m, int option, span *rest,
                       const mtl_site *site) {
  static const int NUMBERS[] = {
      [ARGUMENT_VECTOR] = 3, [ARGUMENT_NUMBER] = 1, [ARGUMENT_NUMBERS] = 2};
  float missing = MAP_OPTIONS[option].kind == OPTION_SCALE ? 1.0f : 0.0f;
  float x[3] = {missing, missing, missing};
  map_argument argument = MAP_OPTIONS[option].argument;
  const char *name = MAP_OPTIONS[option].name;
  span word = {"", 0};
  if (argument == ARGUMENT_SWITCH || argument == ARGUMENT_WORD) {
    word = text_word(rest);
    if (!map_word_fits(option, word))
      return fail(site->err, "%s: %s \"%.*s\", expected %s", site->place, name,
                  (int)(word.length < 40 ? word.length : 40), word.at,
                  argument == ARGUMENT_SWITCH ? "on or off"
                                              : "one of r g b m l z");
  } else {
    int n = map_numbers(rest, NUMBERS[argument], x);
    if (n == 0 || (argument == ARGUMENT_NUMBERS && n < 2))
      return fail(site->err,
                  "%s: %s without its number, expected one and a file",
                  site->place, name);
  }
  map_apply(m, option, x, word);
  return true;
}

// The file name that is left, without quotes around it.
static span map_file(span rest) {
  rest = text_trim(rest);
  if (rest.length >= 2 && rest.at[0] == '"' && rest.at[rest.length - 1] == '"')
    return (span){rest.at + 1, rest.length - 2};
  return rest;
}

bool mtl_map_parse(mtl_map *out, span rest, const mtl_site *site) {
  mtl_map m = {.scale = {1, 1, 1}, .bump = 1};
  for (;;) {
    span after = rest;
    int option = map_option_find(text_word(&after));
    if (option == MAP_OPTION_COUNT) break;
    rest = after;
    if (!map_option(&m, option, &rest, site)) return false;
    if (MAP_OPTIONS[option].kind == OPTION_IGNORED)
      report_note(site->r, "%s: texture option %s is not used", site->place,
                  MAP_OPTIONS[option].name);
  }
  span file = map_file(rest);
  if (file.length == 0) {
    report_warn(site->r, "%s: texture without a file name", site->place);
    return true;
  }
  m.path = span_copy(site->mem, file);
  *out = m;
  return true;
}

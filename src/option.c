// option.c

#include "option.h"

#include "text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// The most words that a list of candidates for the nearest one can have.
enum { CANDIDATES = 32 };

static span span_of(const char *text) {
  return (span){text, strlen(text)};
}

// Whether s is the name of something that facet does not have yet.
static bool is_later(span s) {
  for (const char *const *w = later_words; *w != NULL; w++)
    if (span_is(s, *w)) return true;
  return false;
}

// The text up to the separator or the end, taken off the front of *rest.
static span split_off(span *rest, char separator) {
  const char *end = memchr(rest->at, separator, rest->length);
  span head = {rest->at, end == NULL ? rest->length : (size_t)(end - rest->at)};
  size_t taken = head.length + (end != NULL);
  *rest = (span){rest->at + taken, rest->length - taken};
  return head;
}

bool option_word(const option *o, unsigned i, char *text, size_t size) {
  span rest = span_of(o->argument);
  char separator = o->kind == OPTION_WORDS ? ',' : '|';
  for (unsigned k = 0; rest.length > 0; k++) {
    span word = split_off(&rest, separator);
    if (k != i) continue;
    snprintf(text, size, "%.*s", (int)word.length, word.at);
    return true;
  }
  return false;
}

// The place of a word among those of an option.
static bool find_word(unsigned *place, const option *o, span s, error *err) {
  char words[16][32];
  const char *list[17] = {NULL};
  for (unsigned i = 0; i < 16; i++) {
    if (!option_word(o, i, words[i], sizeof words[i])) break;
    list[i] = words[i];
    if (!span_is(s, words[i])) continue;
    *place = i;
    return true;
  }
  if (is_later(s))
    return fail(err, "--%s %.*s: not in this version of facet (%s)", o->name,
                (int)s.length, s.at, o->argument);
  const char *near = text_nearest(s, list);
  return fail(err, "--%s wants %s, not '%.*s'%s%s", o->name, o->argument,
              (int)s.length, s.at, near ? "; the nearest is " : "",
              near ? near : "");
}

// Say that the argument is not as many numbers as it should be, or one of them
// is out of range.
static bool bad_number(const option_value *v, const option *o, error *err) {
  bool alone = o->kind == OPTION_WHOLE || o->kind == OPTION_NUMBER;
  if (o->kind == OPTION_TRIPLE)
    return fail(err, "--%s wants %s, not '%s'", o->name, o->argument, v->text);
  return fail(err, "--%s wants %s%s from %.10g to %.10g%s, not '%s'", o->name,
              !alone                    ? o->argument
              : o->kind == OPTION_WHOLE ? "a whole number"
                                        : "a number",
              alone ? "" : ", each", o->low, o->high,
              o->open ? " (these excluded)" : "", v->text);
}

// Numbers separated by commas (or by x, for a size), exactly n of them.
static bool find_numbers(option_value *v, const option *o, int n, error *err) {
  span rest = span_of(v->text);
  bool size = o->kind == OPTION_SIZE || o->kind == OPTION_SIZES;
  char separator = size ? 'x' : ',';
  bool real = o->kind == OPTION_NUMBER || o->kind == OPTION_TRIPLE;
  for (int i = 0; i < n; i++) {
    // The last number takes all that is left, with whatever is too much.
    span part = i + 1 == n ? rest : split_off(&rest, separator);
    bool good =
        real ? span_float(part, &v->number[i]) : span_int(part, &v->whole[i]);
    if (!good) return bad_number(v, o, err);
    double x = real ? (double)v->number[i] : (double)v->whole[i];
    good = o->open ? x > o->low && x < o->high : x >= o->low && x <= o->high;
    if (o->kind == OPTION_TRIPLE) good = isfinite(x);
    if (!good) return bad_number(v, o, err);
  }
  return true;
}

// Some words separated by commas, each a bit.
static bool find_words(option_value *v, const option *o, error *err) {
  v->words = 0;
  span rest = span_of(v->text);
  for (bool more = true; more;) {
    more = memchr(rest.at, ',', rest.length) != NULL;
    unsigned place;
    if (!find_word(&place, o, split_off(&rest, ','), err)) return false;
    v->words |= 1u << place;
  }
  return true;
}

// Sizes separated by commas: all are read, the last one stays.
static bool find_sizes(option_value *v, const option *o, error *err) {
  const char *whole = v->text;
  bool ok = true;
  for (const char *at = whole; ok && at != NULL;) {
    char one[32];
    const char *comma = strchr(at, ',');
    int n = (int)(comma != NULL ? comma - at : (ptrdiff_t)strlen(at));
    snprintf(one, sizeof one, "%.*s", n, at);
    v->text = one;
    ok = find_numbers(v, o, 2, err);
    at = comma != NULL ? comma + 1 : NULL;
  }
  v->text = whole;
  return ok;
}

// Whole numbers separated by commas: all are read, the last one stays.
static bool find_wholes(option_value *v, const option *o, error *err) {
  span rest = span_of(v->text);
  for (bool more = true; more;) {
    more = memchr(rest.at, ',', rest.length) != NULL;
    bool good = span_int(split_off(&rest, ','), &v->whole[0]) &&
                (double)v->whole[0] >= o->low && (double)v->whole[0] <= o->high;
    if (!good) return bad_number(v, o, err);
  }
  return true;
}

bool option_whole(const option_value *v, unsigned i, int *number) {
  span rest = span_of(v->text), one = {0};
  for (unsigned k = 0; k <= i; k++) {
    if (rest.length == 0) return false;
    one = split_off(&rest, ',');
  }
  long long n;
  if (!span_int(one, &n)) return false;
  *number = (int)n;
  return true;
}

bool option_size(const option_value *v, unsigned i, int *width, int *height) {
  span rest = span_of(v->text), size = {0};
  for (unsigned k = 0; k <= i; k++) {
    if (rest.length == 0) return false;
    size = split_off(&rest, ',');
  }
  span first = split_off(&size, 'x');
  long long w, h;
  if (!span_int(first, &w) || !span_int(size, &h)) return false;
  *width = (int)w;
  *height = (int)h;
  return true;
}

// Read v->text as the option's kind says.
static bool read_value(option_value *v, const option *o, error *err) {
  switch (o->kind) {
  case OPTION_SWITCH:
  case OPTION_TEXT: return true;
  case OPTION_WORD: return find_word(&v->words, o, span_of(v->text), err);
  case OPTION_WORDS: return find_words(v, o, err);
  case OPTION_WHOLE:
  case OPTION_NUMBER: return find_numbers(v, o, 1, err);
  case OPTION_SIZE: return find_numbers(v, o, 2, err);
  case OPTION_SIZES: return find_sizes(v, o, err);
  case OPTION_TRIPLE: return find_numbers(v, o, 3, err);
  case OPTION_WHOLES: return find_wholes(v, o, err);
  case OPTION_BOX: return find_numbers(v, o, 4, err);
  }
  return true;
}

// The option of that name that the command knows, OPTION_COUNT when none.
static option_id find_option(const command *c, span name) {
  int i = 0;
  while (i < OPTION_COUNT && !((option_table[i].commands & c->bit) != 0 &&
                               span_is(name, option_table[i].name)))
    i++;
  return (option_id)i;
}

// The same by letter.
static option_id find_letter(const command *c, char letter) {
  int i = 0;
  while (i < OPTION_COUNT && !((option_table[i].commands & c->bit) != 0 &&
                               option_table[i].letter == letter))
    i++;
  return (option_id)i;
}

// Say that the command has no such option.
static bool unknown_option(const command *c, span name, error *err) {
  if (is_later(name))
    return fail(err, "--%.*s: not in this version of facet", (int)name.length,
                name.at);
  const char *list[OPTION_COUNT + 1] = {NULL};
  for (int i = 0, n = 0; i < OPTION_COUNT; i++)
    if ((option_table[i].commands & c->bit) != 0)
      list[n++] = option_table[i].name;
  const char *near = text_nearest(name, list);
  if (near != NULL)
    return fail(err, "unknown option --%.*s; the nearest is --%s",
                (int)name.length, name.at, near);
  return fail(err, "unknown option --%.*s; 'facet help %s' lists them",
              (int)name.length, name.at, c->name);
}

// What is left of the command line while it is parsed.
typedef struct cursor {
  char **at, **end;
} cursor;

// Store the option's argument: `joined` when it stood in the same word, else
// the next word, which must not look like another option.
static bool take_value(options *out, option_id id, const char *joined,
                       cursor *c, error *err) {
  const option *o = &option_table[id];
  option_value *v = &out->value[id];
  v->given = true;
  if (o->kind == OPTION_SWITCH) {
    if (joined != NULL) return fail(err, "--%s takes no value", o->name);
    return true;
  }
  if (joined == NULL) {
    if (c->at == c->end || (strncmp(*c->at, "--", 2) == 0))
      return fail(err, "--%s needs a value: %s", o->name, o->argument);
    joined = *c->at++;
  }
  if (*joined == 0)
    return fail(err, "--%s needs a value: %s", o->name, o->argument);
  v->text = joined;
  return read_value(v, o, err);
}

// --name, --name=VALUE; word starts behind the dashes.
static bool take_long(options *out, const char *word, cursor *c, error *err) {
  const char *equals = strchr(word, '=');
  span name = {word, equals ? (size_t)(equals - word) : strlen(word)};
  option_id id = find_option(out->command, name);
  if (id == OPTION_COUNT) return unknown_option(out->command, name, err);
  return take_value(out, id, equals ? equals + 1 : NULL, c, err);
}

// -q, -qv, -j4, -j 4; letters starts behind the dash.
static bool take_letters(options *out, const char *letters, cursor *c,
                         error *err) {
  for (; *letters != 0; letters++) {
    option_id id = find_letter(out->command, *letters);
    if (id == OPTION_COUNT)
      return fail(err, "unknown option -%c; 'facet help %s' lists them",
                  *letters, out->command->name);
    if (option_table[id].kind == OPTION_SWITCH) {
      out->value[id].given = true;
      continue;
    }
    return take_value(out, id, letters[1] ? letters + 1 : NULL, c, err);
  }
  return true;
}

// The values of options that are not given.  The table's fallbacks pass
// through the same reader, so that help cannot show one that is not so.
static bool read_fallbacks(options *out, error *err) {
  for (int i = 0; i < OPTION_COUNT; i++) {
    out->value[i].text = option_table[i].fallback;
    if (out->value[i].text != NULL &&
        !read_value(&out->value[i], &option_table[i], err))
      return false;
  }
  return true;
}

// Say that there is no such command.
static void unknown_command(const char *first, const char *both, error *err) {
  const char *list[CANDIDATES] = {NULL};
  for (const command *c = command_table; c->name != NULL; c++)
    list[c - command_table] = c->name;
  bool half = strcmp(first, "bench") == 0;
  const char *said = half ? both : first;
  const char *near = text_nearest(span_of(said), list);
  const char *dot = strrchr(first, '.');
  if (is_later(span_of(said)))
    fail(err, "%s: not in this version of facet", said);
  else if (half)
    fail(err,
         "bench what? There are 'bench error', 'bench load', 'bench rays', "
         "'bench raster' and 'bench ibl'");
  else if (dot != NULL && (!strcmp(dot, ".obj") || !strcmp(dot, ".scene")))
    fail(err, "unknown command '%s'; to make a picture: facet render %s", said,
         said);
  else if (near != NULL)
    fail(err, "unknown command '%s'; the nearest is '%s'", said, near);
  else
    fail(err, "unknown command '%s'; 'facet help' lists them", said);
}

const command *command_of(int argc, char **argv, int *words, error *err) {
  char both[128];
  snprintf(both, sizeof both, "%s%s%s", argv[1], argc > 2 ? " " : "",
           argc > 2 ? argv[2] : "");
  for (const command *c = command_table; c->name != NULL; c++) {
    bool two = strchr(c->name, ' ') != NULL;
    *words = two ? 2 : 1;
    if (strcmp(two ? both : argv[1], c->name) == 0) return c;
  }
  unknown_command(argv[1], both, err);
  return NULL;
}

bool options_parse(options *out, int argc, char **argv, const char **operands,
                   error *err) {
  int words;
  const command *known = command_of(argc, argv, &words, err);
  if (known == NULL) return false;
  *out = (options){.command = known, .operands = operands};
  if (!read_fallbacks(out, err)) return false;
  cursor c = {argv + 1 + words, argv + argc};
  bool only_operands = false;
  while (c.at < c.end) {
    const char *word = *c.at++;
    if (only_operands || word[0] != '-' || word[1] == 0)
      operands[out->operand_count++] = word;
    else if (strcmp(word, "--") == 0)
      only_operands = true;
    else if (!(word[1] == '-' ? take_long(out, word + 2, &c, err)
                              : take_letters(out, word + 1, &c, err)))
      return false;
  }
  if (out->value[OPT_HELP].given) return true;
  if (out->operand_count < known->least)
    return fail(err, "facet %s needs %s", known->name, known->operands);
  if (out->operand_count > known->most)
    return fail(err, "facet %s takes %s; what is '%s'?", known->name,
                known->operands, operands[known->most]);
  return true;
}

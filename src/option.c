// option.c

#include "option.h"

#include "text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// The most words that a list of candidates for the nearest one can have.
enum { CANDIDATES = 128 };

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

// Numbers separated by commas (or by x, for a size), exactly n of them.
static bool find_numbers(option_value *v, const option *o, int n, error *err) {
  span rest = span_of(v->text);
  bool whole = o->kind == OPTION_WHOLE || o->kind == OPTION_SIZE ||
               o->kind == OPTION_BOX;
  bool limited = o->kind != OPTION_TRIPLE;
  for (int i = 0; i < n; i++) {
    span part =
        n == 1 ? rest : split_off(&rest, o->kind == OPTION_SIZE ? 'x' : ',');
    bool last = i + 1 == n;
    double x = 0;
    bool good =
        whole ? span_int(part, &v->whole[i]) : span_float(part, &v->number[i]);
    if (good) x = whole ? (double)v->whole[i] : (double)v->number[i];
    if (limited)
      good = good && (o->open ? x > o->low && x < o->high
                              : x >= o->low && x <= o->high);
    if (good && isfinite(x) && (n == 1 || !last || rest.length == 0)) continue;
    if (!limited)
      return fail(err, "--%s wants %s, not '%s'", o->name, o->argument,
                  v->text);
    return fail(err, "--%s wants %s%s %.10g to %.10g%s, not '%s'", o->name,
                n > 1   ? o->argument
                : whole ? "a whole number"
                        : "a number",
                n > 1 ? ", each from" : " from", o->low, o->high,
                o->open ? " (these excluded)" : "", v->text);
  }
  return true;
}

// Read v->text as the option's kind says.
static bool read_value(option_value *v, const option *o, error *err) {
  switch (o->kind) {
  case OPTION_SWITCH:
  case OPTION_TEXT: return true;
  case OPTION_WORD: return find_word(&v->words, o, span_of(v->text), err);
  case OPTION_WORDS: {
    v->words = 0;
    for (span rest = span_of(v->text); rest.length > 0;) {
      unsigned place;
      if (!find_word(&place, o, split_off(&rest, ','), err)) return false;
      v->words |= 1u << place;
    }
    return true;
  }
  case OPTION_WHOLE:
  case OPTION_NUMBER: return find_numbers(v, o, 1, err);
  case OPTION_SIZE: return find_numbers(v, o, 2, err);
  case OPTION_TRIPLE: return find_numbers(v, o, 3, err);
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
  return fail(err, "unknown option --%.*s%s%s", (int)name.length, name.at,
              near ? "; the nearest is --" : "", near ? near : "");
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

const command *command_of(int argc, char **argv, int *words, error *err) {
  const char *list[CANDIDATES] = {NULL};
  char two[128] = "";
  if (argc > 1) snprintf(two, sizeof two, "%s", argv[1]);
  if (argc > 2) snprintf(two, sizeof two, "%s %s", argv[1], argv[2]);
  for (const command *c = command_table; c->name != NULL; c++) {
    bool both = strchr(c->name, ' ') != NULL;
    *words = both ? 2 : 1;
    if (argc > *words - 1 && strcmp(both ? two : argv[1], c->name) == 0)
      return c;
    list[c - command_table] = c->name;
  }
  bool half = argc > 1 && strcmp(argv[1], "bench") == 0;
  span said = span_of(half ? two : argv[1]);
  if (is_later(said) || is_later(span_of(argv[1])))
    fail(err, "%s: not in this version of facet", said.at);
  else {
    const char *near = text_nearest(said, list);
    if (half && argc < 3) near = "bench load' or 'bench rays";
    fail(err, "unknown command '%s'%s%s%s", said.at,
         near ? "; the nearest is '" : "", near ? near : "", near ? "'" : "");
  }
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

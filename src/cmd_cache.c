// cmd_cache.c — facet cache: what is kept from run to run, and away with it.

#include "cmd_shared.h"

#include "cache.h"

#include <string.h>
#include <time.h>

// Ages and sizes as people say them: the largest unit of which there are two.
typedef struct unit {
  double size;
  const char *name;
} unit;

static void write_amount(char *text, size_t room, double amount,
                         const unit *units) {
  while (units[1].name != NULL && amount < 2 * units->size)
    units++;
  snprintf(text, room, "%.0f %s", amount / units->size, units->name);
}

static void write_bytes(char *text, size_t room, uint64_t bytes) {
  static const unit units[] = {
      {1 << 20, "MiB"}, {1 << 10, "KiB"}, {1, "bytes"}, {0, NULL}};
  write_amount(text, room, (double)bytes, units);
}

static void write_age(char *text, size_t room, double seconds) {
  static const unit units[] = {{86400, "days ago"},
                               {3600, "hours ago"},
                               {60, "minutes ago"},
                               {1, "s ago"},
                               {0, NULL}};
  write_amount(text, room, seconds, units);
}

// Seconds since a file was used; never below 0, whatever the clocks say.
static double age_of(const cache_entry *e) {
  double age = difftime(time(NULL), e->used.tv_sec);
  return age > 0 ? age : 0;
}

// "ibl" of ibl-0123.bin; of what is still being written, "part".
static void write_kind(char *text, size_t room, const cache_entry *e) {
  int n = (int)strcspn(e->name, "-");
  if (e->name[0] == '.')
    snprintf(text, room, "part");
  else
    snprintf(text, room, "%.*s", n, e->name);
}

// The folder, its files, the one used last first, and what they take.
typedef struct cache_state {
  const char *folder;
  cache_entry *list;
  size_t count;
  uint64_t bytes;
} cache_state;

static cache_state look(arena *mem) {
  cache_state s = {.folder = cache_folder(mem)};
  s.count = cache_entries(&s.list, mem);
  for (size_t i = 0; i < s.count; i++)
    s.bytes += s.list[i].bytes;
  return s;
}

static void print_table(const cache_state *s) {
  char size[32], age[32], kind[32], what[CACHE_WHAT], limit[32];
  for (size_t i = s->count; i-- > 0;) {
    const cache_entry *e = &s->list[i];
    if (i + 1 == s->count)
      printf("%-5s %10s  %-14s  %s\n", "kind", "size", "used", "for");
    write_kind(kind, sizeof kind, e);
    write_bytes(size, sizeof size, e->bytes);
    write_age(age, sizeof age, age_of(e));
    cache_what(what, e);
    printf("%-5s %10s  %-14s  %s\n", kind, size, age,
           what[0] == '\0' ? "(another version)" : what);
  }
  write_bytes(size, sizeof size, s->bytes);
  write_bytes(limit, sizeof limit, cache_limit());
  printf("%zu file%s, %s of %s, in %s\n", s->count, s->count == 1 ? "" : "s",
         size, limit, s->folder);
}

static void print_json(const cache_state *s) {
  json j = {.out = stdout};
  json_open(&j, NULL, '{');
  json_text(&j, "folder", s->folder);
  json_count(&j, "limit", cache_limit());
  json_count(&j, "bytes", s->bytes);
  json_open(&j, "files", '[');
  for (size_t i = s->count; i-- > 0;) {
    const cache_entry *e = &s->list[i];
    char kind[32], what[CACHE_WHAT];
    write_kind(kind, sizeof kind, e);
    cache_what(what, e);
    json_open(&j, NULL, '{');
    json_text(&j, "kind", kind);
    json_count(&j, "bytes", e->bytes);
    json_number(&j, "age", age_of(e));
    json_text(&j, "for", what);
    json_text(&j, "name", e->name);
    json_close(&j, '{');
  }
  json_close(&j, '[');
  json_close(&j, '{');
  json_end(&j);
}

// Remove all; an exit code.
static int clear(const options *o, const cache_state *before, arena *mem) {
  size_t gone = cache_prune(0);
  cache_state after = look(mem);
  uint64_t freed =
      before->bytes > after.bytes ? before->bytes - after.bytes : 0;
  char size[32];
  write_bytes(size, sizeof size, freed);
  if (o->value[OPT_JSON].given) {
    json j = {.out = stdout};
    json_open(&j, NULL, '{');
    json_count(&j, "removed", gone);
    json_count(&j, "bytes", freed);
    json_close(&j, '{');
    json_end(&j);
  } else {
    printf("%zu file%s removed, %s\n", gone, gone == 1 ? "" : "s", size);
  }
  if (after.count == 0) return EXIT_DONE;
  return cmd_fail(o, EXIT_OUTPUT, "%s: %zu file%s could not be removed",
                  after.folder, after.count, after.count == 1 ? "" : "s");
}

int cmd_cache(const options *o) {
  const char *word = o->operand_count > 0 ? o->operands[0] : "show";
  bool away = strcmp(word, "clear") == 0;
  if (!away && strcmp(word, "show") != 0)
    return cmd_fail(o, EXIT_USAGE, "facet cache %s: expected show or clear",
                    word);
  arena mem = {0};
  cache_state s = look(&mem);
  int code = EXIT_DONE;
  if (s.folder == NULL)
    code = cmd_fail(o, EXIT_RESOURCES,
                    "no place for a cache: neither XDG_CACHE_HOME nor HOME is "
                    "an absolute path");
  else if (away)
    code = clear(o, &s, &mem);
  else if (o->value[OPT_JSON].given)
    print_json(&s);
  else
    print_table(&s);
  arena_free(&mem);
  return code;
}

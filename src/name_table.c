// name_table.c

#include "name_table.h"

#include <string.h>

// Names that meet by chance are found within a few slots; a walk that is longer
// than this is somebody's work.
enum { NAME_LONGEST_WALK = 256 };

// Source: Fowler, Noll, Vo: FNV-1a, 64 bits, with a key.
static uint64_t name_hash(span s, uint64_t key) {
  uint64_t h = 14695981039346656037u + key;
  for (size_t i = 0; i < s.length; i++)
    h = (h ^ (unsigned char)s.at[i]) * 1099511628211u;
  return h ^ h >> 32;
}

// The slot of name, or the free slot where it belongs.
static size_t name_slot(const name_table *t, span name) {
  size_t i = (size_t)name_hash(name, t->key) & (t->slot_count - 1);
  while (t->slots[i] != 0 && !span_is(name, t->names[t->slots[i] - 1]))
    i = (i + 1) & (t->slot_count - 1);
  return i;
}

// Put every name into empty slots.
static void name_table_fill(name_table *t) {
  for (size_t i = 0; i < t->count; i++) {
    span name = {t->names[i], strlen(t->names[i])};
    t->slots[name_slot(t, name)] = (uint32_t)i + 1;
  }
}

// Twice the slots, at least 64, and names for half of them.
static void name_table_grow(name_table *t, arena *mem) {
  t->slot_count = t->slot_count == 0 ? 64 : 2 * t->slot_count;
  t->slots = ARENA_NEW(mem, uint32_t, t->slot_count);
  const char **names = ARENA_NEW(mem, const char *, t->slot_count / 2);
  if (t->count > 0) memcpy(names, t->names, t->count * sizeof *names);
  t->names = names;
  name_table_fill(t);
}

// Another key, after a walk to the given slot that was too long: names that
// were made to meet do not meet again.
static void name_table_scatter(name_table *t, span name, size_t slot) {
  size_t home = (size_t)name_hash(name, t->key) & (t->slot_count - 1);
  if (((slot - home) & (t->slot_count - 1)) <= NAME_LONGEST_WALK) return;
  t->key++;
  memset(t->slots, 0, t->slot_count * sizeof *t->slots);
  name_table_fill(t);
}

int name_table_add(name_table *t, span name, arena *mem) {
  if (2 * t->count >= t->slot_count) name_table_grow(t, mem);
  // A name that is not the string that it will be stored as.
  if (name.length > 0 && memchr(name.at, '\0', name.length) != NULL)
    name.at = span_copy(mem, name);
  size_t slot = name_slot(t, name);
  if (t->slots[slot] != 0) return (int)t->slots[slot] - 1;
  t->names[t->count++] = span_copy(mem, name);
  t->slots[slot] = (uint32_t)t->count;
  name_table_scatter(t, name, slot);
  return (int)t->count - 1;
}

int name_table_find(const name_table *t, span name) {
  if (t->slot_count == 0) return -1;
  return (int)t->slots[name_slot(t, name)] - 1;
}

// obj_events.c

#include "name_table.h"
#include "obj_merge.h"

#include <string.h>

// The events so far: tables of names, the run that is open, runs that are
// closed.
typedef struct event_state {
  name_table objects, groups, materials;
  const char **libraries;
  uint64_t *library_lines, *material_lines;
  size_t library_count, library_room, line_room, material_room;
  size_t object_statements, group_statements;
  mesh_run open;
  mesh_run *runs;
  size_t run_count, run_room;
} event_state;

static bool same_state(const mesh_run *a, const mesh_run *b) {
  return a->object == b->object && a->group == b->group &&
         a->material == b->material && a->smooth == b->smooth;
}

// End the open run before the given triangle, and begin the next one there.
static void close_run(event_state *s, size_t triangle) {
  s->open.count = (uint32_t)triangle - s->open.first;
  if (s->open.count == 0) return;
  mesh_run *last = s->run_count > 0 ? &s->runs[s->run_count - 1] : NULL;
  if (last != NULL && same_state(last, &s->open)) {
    last->count += s->open.count;
  } else {
    s->runs =
        array_grow(s->runs, &s->run_room, s->run_count + 1, sizeof *s->runs);
    s->runs[s->run_count++] = s->open;
  }
  s->open.first = (uint32_t)triangle;
}

// A usemtl in the given line.
static void use_material(event_state *s, span name, uint64_t line, arena *mem) {
  size_t known = s->materials.count;
  s->open.material = name_table_add(&s->materials, name, mem);
  if (s->materials.count == known) return;
  s->material_lines =
      array_grow(s->material_lines, &s->material_room, known + 1, sizeof line);
  s->material_lines[known] = line;
}

// line is the number of the line before the chunk.
static void apply_event(event_state *s, const obj_event *e, span name,
                        uint64_t line, arena *mem) {
  switch (e->kind) {
  case OBJ_EVENT_OBJECT:
    s->open.object = name_table_add(&s->objects, name, mem);
    s->object_statements++;
    break;
  case OBJ_EVENT_GROUP:
    s->open.group = name_table_add(&s->groups, name, mem);
    s->group_statements++;
    break;
  case OBJ_EVENT_MATERIAL:
    use_material(s, name, line + (uint64_t)e->value, mem);
    break;
  case OBJ_EVENT_SMOOTH: s->open.smooth = e->value; break;
  case OBJ_EVENT_LIBRARY:
    s->libraries = array_grow(s->libraries, &s->library_room,
                              s->library_count + 1, sizeof *s->libraries);
    s->library_lines = array_grow(s->library_lines, &s->line_room,
                                  s->library_count + 1, sizeof line);
    s->library_lines[s->library_count] = line + (uint64_t)e->value;
    s->libraries[s->library_count++] = span_copy(mem, name);
    break;
  }
}

// n items copied into mem, exactly as large as they are.
static void *keep_items(const void *items, size_t n, size_t size, arena *mem) {
  void *kept = arena_alloc(mem, n, size);
  if (n > 0) memcpy(kept, items, n * size);
  return kept;
}

void obj_merge_events(mesh *m, const obj_chunk *chunks, const obj_place *places,
                      size_t n, arena *mem) {
  event_state s = {
      .open = {.object = -1, .group = -1, .material = -1, .smooth = -1}};
  for (size_t i = 0; i < n; i++) {
    const obj_chunk *c = &chunks[i];
    for (size_t j = 0; j < c->event_count; j++) {
      const obj_event *e = &c->events[j];
      close_run(&s, places[i].triangle + e->triangle);
      span name = {"", 0};
      if (e->length > 0) name = (span){c->names + e->name, e->length};
      apply_event(&s, e, name, places[i].line, mem);
    }
  }
  close_run(&s, places[n].triangle);
  m->runs = keep_items(s.runs, s.run_count, sizeof *s.runs, mem);
  m->run_count = s.run_count;
  m->libraries =
      keep_items(s.libraries, s.library_count, sizeof *s.libraries, mem);
  m->library_lines = keep_items(s.library_lines, s.library_count,
                                sizeof *s.library_lines, mem);
  m->library_count = s.library_count;
  m->object_statements = s.object_statements;
  m->group_statements = s.group_statements;
  m->object_names = s.objects.names;
  m->object_count = s.objects.count;
  m->group_names = s.groups.names;
  m->group_count = s.groups.count;
  m->material_names = s.materials.names;
  m->material_count = s.materials.count;
  m->material_lines = keep_items(s.material_lines, s.materials.count,
                                 sizeof *s.material_lines, mem);
  array_free(s.runs);
  array_free(s.libraries);
  array_free(s.library_lines);
  array_free(s.material_lines);
}

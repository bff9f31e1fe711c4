// test_obj.c — the OBJ dialect by example, and the laws of the reader.

#include "obj.h"

#include "expectation.h"

#include <math.h>
#include <unistd.h>

// Loops are this many times shorter under the sanitizers.
static int quick(void) {
  return getenv("FACET_QUICK") == NULL ? 1 : 50;
}

// What a reading gave, and the arena that holds it.
typedef struct reading {
  arena mem;
  mesh m;
  report r;
  error err;
  bool ok;
} reading;

static void read_it(reading *x, const obj_request *q) {
  *x = (reading){0};
  x->r.mem = &x->mem;
  x->ok = obj_read_request(&x->m, q, &x->mem, &x->r, &x->err);
}

// A name, or "-" for none.
static const char *name_of(const char **names, size_t count) {
  return count > 0 ? names[0] : "-";
}

// The last corner of the last triangle, as P/T/N from 0.
static void corner_text(const mesh *m, char *text, size_t size) {
  const uint32_t *index[3] = {m->position_index, m->texcoord_index,
                              m->normal_index};
  size_t at = 3 * m->triangle_count - 1, n = 0;
  for (int k = 0; k < 3; k++) {
    bool none = index[k] == NULL || index[k][at] == MESH_NONE;
    const char *slash = k > 0 ? "/" : "";
    if (none) n += (size_t)snprintf(text + n, size - n, "%s-", slash);
    if (!none)
      n += (size_t)snprintf(text + n, size - n, "%s%u", slash, index[k][at]);
  }
}

// The number that a word of an expectation is about; false when it is none.
static bool count_of(const reading *x, const char *name, double *count) {
  const mesh *m = &x->m;
  const struct {
    const char *name;
    double count;
  } all[] = {{"positions", (double)m->position_count},
             {"normals", (double)m->normal_count},
             {"texcoords", (double)m->texcoord_count},
             {"faces", (double)m->face_count},
             {"triangles", (double)m->triangle_count},
             {"area", mesh_area(m)},
             {"runs", (double)m->run_count},
             {"objects", (double)m->object_count},
             {"groups", (double)m->group_count},
             {"materials", (double)m->material_count},
             {"libraries", (double)m->library_count},
             {"lines", (double)m->line_elements},
             {"points", (double)m->point_elements},
             {"colors", m->colors != NULL},
             {"warnings", x->r.warnings},
             {"notes", x->r.notes}};
  for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
    if (strcmp(name, all[i].name) != 0) continue;
    *count = all[i].count;
    return true;
  }
  return false;
}

// The text that a word is about.
static const char *text_of(const mesh *m, const char *name, char corner[64]) {
  if (strcmp(name, "object") == 0)
    return name_of(m->object_names, m->object_count);
  if (strcmp(name, "group") == 0)
    return name_of(m->group_names, m->group_count);
  if (strcmp(name, "material") == 0)
    return name_of(m->material_names, m->material_count);
  if (strcmp(name, "library") == 0)
    return name_of(m->libraries, m->library_count);
  assert_string_equal(name, "corner");
  corner_text(m, corner, 64);
  return corner;
}

// Whether one word of the expectation holds for a mesh that was read.
static bool holds(const reading *x, const expectation *e) {
  double count, wanted[3];
  char corner[64];
  if (count_of(x, e->name, &count)) {
    expectation_numbers(e, wanted);
    if (fabs(count - wanted[0]) <= 1e-6 * fabs(wanted[0])) return true;
    print_message("# %s: %.9g, expected %s\n", e->name, count, e->value);
    return false;
  }
  if (strcmp(e->name, "warning") == 0) {
    bool found = false;
    REPORT_HAS(&x->r, e->value, found);
    if (!found) print_message("# no remark has \"%s\"\n", e->value);
    return found;
  }
  const char *text = text_of(&x->m, e->name, corner);
  if (strcmp(text, e->value) == 0) return true;
  print_message("# %s: \"%s\", expected \"%s\"\n", e->name, text, e->value);
  return false;
}

// Whether a message names the line and holds the text.
static bool message_holds(const char *message, const expectation *e) {
  char line[300];
  snprintf(line, sizeof line, strcmp(e->name, "line") == 0 ? ".obj:%s: " : "%s",
           e->value);
  if (strstr(message, line) != NULL) return true;
  print_message("# \"%s\", expected %s=%s\n", message, e->name, e->value);
  return false;
}

static bool check_file(const char *path, const char *expected) {
  reading x;
  expectation e;
  obj_request q = {.path = path};
  read_it(&x, &q);
  expectation_next(&expected, &e);
  bool ok = x.ok == (strcmp(e.name, "ok") == 0);
  if (!ok) print_message("# %s\n", x.ok ? "is read" : x.err.text);
  while (ok && expectation_next(&expected, &e))
    ok = x.ok ? holds(&x, &e) : message_holds(x.err.text, &e);
  arena_free(&x.mem);
  return ok;
}

// Every file of tests/data/obj is what its first line says.
static void files_are_what_they_say(void **state) {
  (void)state;
  expectation_run("tests/data/obj", ".obj", 70, check_file);
}

static bool same_bytes(const void *a, const void *b, size_t n) {
  if (a == NULL || b == NULL) return a == b;
  return n == 0 || memcmp(a, b, n) == 0;
}

static bool same_remarks(const report *a, const report *b) {
  const report_line *p = a->first, *q = b->first;
  for (; p != NULL && q != NULL; p = p->next, q = q->next)
    if (strcmp(p->text, q->text) != 0) return false;
  return p == q;
}

static bool same_runs(const mesh *a, const mesh *b) {
  if (a->run_count != b->run_count) return false;
  for (size_t i = 0; i < a->run_count; i++) {
    const mesh_run *r = &a->runs[i], *s = &b->runs[i];
    if (r->first != s->first || r->count != s->count ||
        r->object != s->object || r->group != s->group ||
        r->material != s->material || r->smooth != s->smooth)
      return false;
  }
  return true;
}

// Whether two readings are the same in every bit and every word.
static bool same_reading(const reading *a, const reading *b) {
  const mesh *m = &a->m, *n = &b->m;
  if (a->ok != b->ok) return false;
  if (!a->ok) return strcmp(a->err.text, b->err.text) == 0;
  return m->position_count == n->position_count &&
         m->normal_count == n->normal_count &&
         m->texcoord_count == n->texcoord_count &&
         m->triangle_count == n->triangle_count &&
         m->face_count == n->face_count &&
         same_bytes(m->positions, n->positions, 12 * m->position_count) &&
         same_bytes(m->colors, n->colors, 12 * m->position_count) &&
         same_bytes(m->normals, n->normals, 12 * m->normal_count) &&
         same_bytes(m->texcoords, n->texcoords, 8 * m->texcoord_count) &&
         same_bytes(m->position_index, n->position_index,
                    12 * m->triangle_count) &&
         same_bytes(m->normal_index, n->normal_index, 12 * m->triangle_count) &&
         same_bytes(m->texcoord_index, n->texcoord_index,
                    12 * m->triangle_count) &&
         same_runs(m, n) && same_remarks(&a->r, &b->r);
}

// The mesh, the remarks and the error do not depend on where the text is cut
// nor on how many threads read it: pieces of 1 to 997 bytes, 1, 2 and 7
// threads, every data file.
static bool check_pieces(const char *path, const char *expected) {
  static const size_t PIECES[] = {1, 2, 3, 7, 16, 61, 997};
  (void)expected;
  bool ok = true;
  reading whole, x;
  obj_request q = {.path = path};
  read_it(&whole, &q);
  for (int k = 0; k < 3 && ok; k++) {
    static const int THREADS[] = {1, 2, 7};
    int threads = THREADS[k];
    arena mem = {0};
    q.threads = pool_new(&mem, threads);
    for (size_t i = 0; i < sizeof PIECES / sizeof PIECES[0] && ok; i++) {
      q.piece_bytes = PIECES[i];
      read_it(&x, &q);
      ok = same_reading(&whole, &x);
      if (!ok)
        print_message("# pieces of %zu, %d threads\n", PIECES[i], threads);
      arena_free(&x.mem);
    }
    pool_free(q.threads);
    arena_free(&mem);
  }
  arena_free(&whole.mem);
  return ok;
}

static void pieces_and_threads_do_not_show(void **state) {
  (void)state;
  expectation_run("tests/data/obj", ".obj", 70, check_pieces);
}

// A text with something of everything, for the tests that damage it.
static const char SAMPLE[] =
    "mtllib a b.mtl\no Box\nv 0 0 0\nv 1.5e0 0 0 1 .5 0\nv 1 1 0\nv 0 1 -0.0\n"
    "vt 0 0\nvt 1 0.25\nvn 0 0 1\ng side one\nusemtl red\ns 1\n"
    "f 1/1/1 2/2/1 3/1/1 \\\n 4/2/1\r\nf -4//-1 -3//-1 -2//-1\n# done\r"
    "l 1 2\np 1\ns off\nusemtl\nfoo bar\nf 1 2 3 4 1 2 3\nf 1/2 2/1 4/1";

// Read a text; true when it could be read.  Whatever comes, the indices are in
// range.
static bool read_text(const char *text, size_t n, size_t piece) {
  reading x;
  obj_request q = {.path = "text.obj", .text = {text, n}, .piece_bytes = piece};
  read_it(&x, &q);
  for (size_t i = 0; x.ok && i < 3 * x.m.triangle_count; i++) {
    const uint32_t *t = x.m.texcoord_index, *v = x.m.normal_index;
    assert_true(x.m.position_index[i] < x.m.position_count);
    assert_true(t == NULL || t[i] == MESH_NONE || t[i] < x.m.texcoord_count);
    assert_true(v == NULL || v[i] == MESH_NONE || v[i] < x.m.normal_count);
  }
  if (!x.ok) assert_true(strncmp(x.err.text, "text.obj:", 9) == 0);
  bool ok = x.ok;
  arena_free(&x.mem);
  return ok;
}

// A text cut off at any byte is read or refused with a place.
static void every_truncation_ends_well(void **state) {
  (void)state;
  int read = 0;
  for (size_t n = 0; n < sizeof SAMPLE; n++) {
    char *exact = malloc(n + 1);  // so that a sanitizer sees reads behind it
    memcpy(exact, SAMPLE, n);
    read += read_text(exact, n, 0);
    read_text(exact, n, 5);
    free(exact);
  }
  assert_true(read > 100 && read < (int)sizeof SAMPLE);
}

// So is a text with some byte changed.
static void every_damage_ends_well(void **state) {
  (void)state;
  uint64_t random = 88172645463325252u;
  int turns = 10000 / quick(), read = 0;
  for (int i = 0; i < turns; i++) {
    char text[sizeof SAMPLE];
    memcpy(text, SAMPLE, sizeof text);
    random ^= random << 13;
    random ^= random >> 7;
    random ^= random << 17;
    text[random % (sizeof text - 1)] = (char)(random >> 32);
    read += read_text(text, sizeof text - 1, 0);
  }
  assert_true(read > turns / 10 && read < turns);
}

// A polygon of 100,000 corners, 100,000 groups and as many changes of material
// are read in linear time: together in seconds.
static void many_of_everything(void **state) {
  (void)state;
  int n = 100000 / quick();
  size_t room = (size_t)n * 120 + 100, at = 0;
  char *text = malloc(room);
  for (int i = 0; i < n; i++) {
    double a = 6.283185307179586 * i / n, r = i % 2 == 0 ? 1 : 0.99;
    at += (size_t)snprintf(text + at, room - at, "v %.6f %.6f 0\n", r * cos(a),
                           r * sin(a));
  }
  at += (size_t)snprintf(text + at, room - at, "f");
  for (int i = 0; i < n; i++)
    at += (size_t)snprintf(text + at, room - at, " %d", i + 1);
  for (int i = 0; i < n; i++)
    at += (size_t)snprintf(text + at, room - at,
                           "\ng group %d\nusemtl m%d\nf 1 2 3\n", i, i % 777);
  reading x;
  obj_request q = {.path = "text.obj", .text = {text, at}};
  read_it(&x, &q);
  assert_true(x.ok);
  assert_int_equal(x.m.triangle_count, 2 * n - 2);
  assert_int_equal(x.m.group_count, n);
  assert_int_equal(x.m.material_count, n < 777 ? n : 777);
  assert_int_equal(x.m.run_count, n + 1);
  assert_int_equal(x.r.warnings, 0);
  arena_free(&x.mem);
  free(text);
}

// A comment of megabytes, longer than any piece, is one line.
static void lines_have_any_length(void **state) {
  (void)state;
  size_t n = (size_t)20000000 / (size_t)quick();
  char *text = malloc(n);
  memset(text, 'x', n);
  text[0] = '#';
  static const char END[] = "\nv 0 0 0\nf 0 0 0\n";
  memcpy(text + n - sizeof END + 1, END, sizeof END - 1);
  reading x;
  obj_request q = {.path = "text.obj", .text = {text, n}};
  read_it(&x, &q);
  assert_false(x.ok);
  assert_memory_equal(x.err.text, "text.obj:3:", 11);
  arena_free(&x.mem);
  free(text);
}

// What cannot be read is refused, and the result is left alone.
static void what_is_no_file_is_refused(void **state) {
  (void)state;
  mesh m = {.face_count = 7};
  arena mem = {0};
  error err;
  assert_false(obj_read(&m, "tests", &mem, NULL, NULL, NULL, &err));
  assert_non_null(strstr(err.text, "folder"));
  assert_false(obj_read(&m, "/dev/null", &mem, NULL, NULL, NULL, &err));
  assert_non_null(strstr(err.text, "is a device"));
  assert_false(obj_read(&m, "tests/none.obj", &mem, NULL, NULL, NULL, &err));
  assert_non_null(strstr(err.text, "tests/none.obj"));
  assert_int_equal(m.face_count, 7);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(files_are_what_they_say),
      cmocka_unit_test(pieces_and_threads_do_not_show),
      cmocka_unit_test(every_truncation_ends_well),
      cmocka_unit_test(every_damage_ends_well),
      cmocka_unit_test(many_of_everything),
      cmocka_unit_test(lines_have_any_length),
      cmocka_unit_test(what_is_no_file_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

// test_mtl.c — material libraries by example, and how OBJ files find them.

#include "mtl.h"
#include "obj.h"

#include "expectation.h"

#include <math.h>
#include <sys/stat.h>
#include <unistd.h>

// What reading a library gave.
typedef struct library_reading {
  arena mem;
  mtl_library lib;
  report r;
  error err;
  bool ok;
} library_reading;

// Whether numbers agree as far as six digits go.
static bool near(double a, double b) {
  return fabs(a - b) <= 1e-6 * (1 + fabs(b));
}

static bool same_color(vec3 a, const double b[3]) {
  return near((double)a.x, b[0]) && near((double)a.y, b[1]) &&
         near((double)a.z, b[2]);
}

// A colour of the first material by its keyword; false when it is none.
static bool color_of(const mtl_material *m, const char *name, vec3 *color) {
  const struct {
    const char *name;
    vec3 color;
  } all[] = {{"Ka", m->ka},
             {"Kd", m->kd},
             {"Ks", m->ks},
             {"Ke", m->ke},
             {"Tf", m->tf},
             {"scale", m->map[MTL_MAP_KD - MTL_FIRST_MAP].scale},
             {"offset", m->map[MTL_MAP_KD - MTL_FIRST_MAP].offset}};
  for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
    if (strcmp(name, all[i].name) != 0) continue;
    *color = all[i].color;
    return true;
  }
  return false;
}

// A number of the first material or of the reading; false when it is none.
static bool number_of(const library_reading *x, const mtl_material *m,
                      const char *name, double *number) {
  const struct {
    const char *name;
    double number;
  } all[] = {{"materials", (double)x->lib.count},
             {"warnings", x->r.warnings},
             {"notes", x->r.notes},
             {"Ns", (double)m->ns},
             {"Ni", (double)m->ni},
             {"d", (double)m->d},
             {"Pr", (double)m->pr},
             {"Pm", (double)m->pm},
             {"illum", m->illum},
             {"clamp", m->map[MTL_MAP_KD - MTL_FIRST_MAP].clamp},
             {"bm", (double)m->map[MTL_MAP_BUMP - MTL_FIRST_MAP].bump}};
  for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
    if (strcmp(name, all[i].name) != 0) continue;
    *number = all[i].number;
    return true;
  }
  return false;
}

// Whether one word of the expectation holds.
static bool library_holds(const library_reading *x, const expectation *e) {
  mtl_material none = mtl_default("none");
  const mtl_material *m = x->lib.count > 0 ? &x->lib.materials[0] : &none;
  double numbers[3] = {0}, number;
  vec3 color;
  bool found = false;
  expectation_numbers(e, numbers);
  if (color_of(m, e->name, &color)) {
    found = same_color(color, numbers);
  } else if (number_of(x, m, e->name, &number)) {
    found = near(number, numbers[0]);
  } else if (strcmp(e->name, "warning") == 0) {
    REPORT_HAS(&x->r, e->value, found);
  } else if (strcmp(e->name, "channel") == 0) {
    found = m->map[MTL_MAP_BUMP - MTL_FIRST_MAP].channel == e->value[0];
  } else {
    for (int k = MTL_FIRST_MAP; k < MTL_KEY_COUNT; k++)
      if (strcmp(mtl_key_name((mtl_key)k), e->name) == 0 &&
          m->map[k - MTL_FIRST_MAP].path != NULL)
        found = strcmp(m->map[k - MTL_FIRST_MAP].path, e->value) == 0;
  }
  if (!found) print_message("# not %s=%s\n", e->name, e->value);
  return found;
}

static bool check_library(const char *path, const char *expected) {
  library_reading x = {0};
  expectation e;
  x.r.mem = &x.mem;
  x.ok = mtl_read(&x.lib, path, &x.mem, &x.r, &x.err);
  expectation_next(&expected, &e);
  bool ok = x.ok == (strcmp(e.name, "ok") == 0);
  if (!ok) print_message("# %s\n", x.ok ? "is read" : x.err.text);
  while (ok && expectation_next(&expected, &e)) {
    char line[300];
    if (x.ok) {
      ok = library_holds(&x, &e);
      continue;
    }
    snprintf(line, sizeof line,
             strcmp(e.name, "line") == 0 ? ".mtl:%s: " : "%s", e.value);
    ok = strstr(x.err.text, line) != NULL;
    if (!ok) print_message("# \"%s\"\n", x.err.text);
  }
  arena_free(&x.mem);
  return ok;
}

// Every file of tests/data/mtl is what its first line says.
static void libraries_are_what_they_say(void **state) {
  (void)state;
  expectation_run("tests/data/mtl", ".mtl", 34, check_library);
}

static char folder[64];

// Write a file into the folder and give its path.
static char *put(arena *mem, const char *name, const char *text, size_t n) {
  char *path = arena_format(mem, "%s/%s", folder, name);
  FILE *f = fopen(path, "wb");
  assert_non_null(f);
  fwrite(text, 1, n, f);
  fclose(f);
  return path;
}

static int make_folder(void **state) {
  (void)state;
  strcpy(folder, "/tmp/facet-mtl-XXXXXX");
  return mkdtemp(folder) == NULL;
}

static int remove_folder(void **state) {
  static const char *const NAMES[] = {"a b.mtl", "c.mtl", "d.mtl",
                                      "x.obj",   "x.mtl", ""};
  (void)state;
  char path[128];
  for (int i = 0; i < 6; i++) {
    snprintf(path, sizeof path, "%s/%s", folder, NAMES[i]);
    remove(path);
  }
  return 0;
}

// Read the libraries that an OBJ names; the number of materials.
static size_t read_libraries(const char *obj, report *r, arena *mem,
                             mtl_library *lib) {
  mesh m;
  error err;
  char *path = put(mem, "x.obj", obj, strlen(obj));
  assert_true(obj_read(&m, path, mem, NULL, NULL, NULL, &err));
  *lib = (mtl_library){0};
  assert_true(mtl_read_all(lib, &m, path, NULL, mem, r, &err));
  return lib->count;
}

// A mtllib line names one file with blanks in its name, or else several files;
// a file is read once however often it is named; one that is not there is one
// warning that says where it was looked for.
static void obj_files_find_their_libraries(void **state) {
  (void)state;
  arena mem = {0};
  report r = {.mem = &mem};
  mtl_library lib;
  put(&mem, "a b.mtl", "newmtl ab\n", 10);
  put(&mem, "c.mtl", "newmtl c\nNs 3\n", 14);
  put(&mem, "d.mtl", "newmtl d\n", 9);
  assert_int_equal(read_libraries("mtllib a b.mtl\n", &r, &mem, &lib), 1);
  assert_int_equal(mtl_find(&lib, "ab"), 0);
  assert_int_equal(mtl_find(&lib, "a"), -1);
  assert_int_equal(
      read_libraries("mtllib c.mtl d.mtl\nmtllib c.mtl\n", &r, &mem, &lib), 2);
  assert_int_equal(mtl_find(&lib, "d"), 1);
  assert_true(lib.materials[0].ns == 3);
  assert_int_equal(lib.materials[0].line[MTL_NS], 2);
  assert_string_equal(lib.materials[0].folder, folder);
  assert_int_equal(r.warnings + r.notes, 0);
  assert_int_equal(read_libraries("\nmtllib no ne.mtl\n", &r, &mem, &lib), 0);
  assert_int_equal(r.warnings, 1);
  assert_non_null(strstr(r.last->text, "x.obj:2: "));
  assert_non_null(strstr(r.last->text, "/no ne.mtl"));
  assert_int_equal(read_libraries("mtllib c.mtl e.mtl\n", &r, &mem, &lib), 1);
  assert_int_equal(r.warnings, 2);
  assert_non_null(strstr(r.last->text, "/e.mtl"));
  arena_free(&mem);
}

// A text with something of everything, for the tests that damage it.
static const char SAMPLE[] =
    "newmtl a b\r\nKa 1 1 1\nKd .5 .5 .5\\\n\nKs spectral x\nNs 10 20\nd -halo "
    ".5\nTr .25\nillum 2\nmap_Kd -s 1 2 3 -o 4 -clamp on -mm 0 1 \"a b.png\"\n"
    "bump -bm 2 -imfchan r b.png\nfoo\nnewmtl\nKe xyz 1\nnewmtl a b\nPr 1";

// Read a library of these bytes; true when it could be read.
static bool read_bytes(const char *text, size_t n) {
  arena mem = {0};
  mtl_library lib = {0};
  report r = {.mem = &mem};
  error err;
  char *exact = malloc(n + 1);  // so that a sanitizer sees reads behind it
  assert_non_null(exact);
  memcpy(exact, text, n);
  bool ok = mtl_read_text(&lib, (span){exact, n}, "x.mtl", &mem, &r, &err);
  free(exact);
  if (!ok) assert_non_null(strstr(err.text, "x.mtl:"));
  arena_free(&mem);
  return ok;
}

// A library cut off at any byte, or with some byte changed, is read or refused
// with a place.
static void damage_ends_well(void **state) {
  (void)state;
  int quick = getenv("FACET_QUICK") == NULL ? 1 : 20, read = 0;
  for (size_t n = 0; n < sizeof SAMPLE; n++)
    read += read_bytes(SAMPLE, n);
  assert_true(read > 100 && read < (int)sizeof SAMPLE);
  uint64_t s = 88172645463325252u;
  int turns = 10000 / quick;
  read = 0;
  for (int i = 0; i < turns; i++) {
    char text[sizeof SAMPLE];
    memcpy(text, SAMPLE, sizeof text);
    s ^= s << 13;
    s ^= s >> 7;
    s ^= s << 17;
    text[s % (sizeof text - 1)] = (char)(s >> 32);
    read += read_bytes(text, sizeof text - 1);
  }
  assert_true(read > turns / 10 && read < turns);
}

// 100,000 materials are found by name in linear time.
static void many_materials_are_found(void **state) {
  (void)state;
  arena mem = {0};
  mtl_library lib = {0};
  int n = getenv("FACET_QUICK") == NULL ? 100000 : 2000;
  char name[32];
  for (int i = 0; i < n; i++) {
    int length = snprintf(name, sizeof name, "material %d", i);
    mtl_add(&lib, (span){name, (size_t)length}, &mem)->ns = (float)i;
  }
  for (int i = 0; i < n; i++) {
    snprintf(name, sizeof name, "material %d", i);
    assert_int_equal(mtl_find(&lib, name), i);
    assert_true(lib.materials[i].ns == (float)i);
  }
  assert_int_equal(mtl_find(&lib, "material"), -1);
  arena_free(&mem);
}

// Every key has a name, and its own statement sets its line.
static void keys_have_names(void **state) {
  (void)state;
  arena mem = {0};
  error err;
  for (int k = 0; k < MTL_KEY_COUNT; k++) {
    const char *name = mtl_key_name((mtl_key)k);
    mtl_material m = mtl_default("x");
    bool known;
    assert_true(mtl_statement(&m, (span){name, strlen(name)}, (span){"1", 1}, 9,
                              "x:9", &known, &mem, NULL, &err));
    assert_true(known);
    assert_int_equal(m.line[k], 9);
  }
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(libraries_are_what_they_say),
      cmocka_unit_test(obj_files_find_their_libraries),
      cmocka_unit_test(damage_ends_well),
      cmocka_unit_test(many_materials_are_found),
      cmocka_unit_test(keys_have_names),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

// test_material.c — the decision table, row by row.

#include "material.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

// A material named `name` from MTL statements with newlines between them;
// the first line has number 2, below its newmtl.
static mtl_material written(const char *name, const char *text, arena *mem) {
  mtl_material m = mtl_default(name);
  m.file = "x.mtl";
  m.newmtl_line = 1;
  error err;
  text_lines lines = text_lines_of((span){text, strlen(text)}, 2);
  for (span line; text_next_line(&lines, &line);) {
    span key = text_word(&line);
    bool known;
    assert_true(mtl_statement(&m, key, line, (uint32_t)lines.line, "x.mtl",
                              &known, mem, NULL, &err));
    assert_true(known);
  }
  text_lines_free(&lines);
  return m;
}

// One row: what is written, and what must come of it.
typedef struct row {
  const char *object, *name, *text;
  int rule;
  material_kind kind;
  const char *why;  // exactly, after "rule N: "
} row;

// The table of the book, with each condition met and just not met.
static const row ROWS[] = {
    {NULL, "a", "Kd 1 0 0", 5, MATERIAL_BLINN_PHONG, "newmtl a at x.mtl:1"},
    {NULL, "a", "Kd 1 0 0\nPr 0.3", 2, MATERIAL_METAL_ROUGH,
     "Pr 0.3 at x.mtl:3"},
    {NULL, "a", "Pm 1", 2, MATERIAL_METAL_ROUGH, "Pm 1 at x.mtl:2"},
    {NULL, "a", "Pr 0", 2, MATERIAL_METAL_ROUGH, "Pr 0 at x.mtl:2"},
    {NULL, "a", "map_Pr r.png", 2, MATERIAL_METAL_ROUGH, "map_Pr at x.mtl:2"},
    {NULL, "a", "Ks 1 1 1\nillum 3", 3, MATERIAL_MIRROR,
     "illum 3 at x.mtl:3, Ks at x.mtl:2"},
    {NULL, "a", "illum 5\nKs .1 0 0", 3, MATERIAL_MIRROR,
     "illum 5 at x.mtl:2, Ks at x.mtl:3"},
    {NULL, "a", "illum 8\nKs 1 1 1", 3, MATERIAL_MIRROR,
     "illum 8 at x.mtl:2, Ks at x.mtl:3"},
    {NULL, "a", "illum 3", 5, MATERIAL_BLINN_PHONG, "newmtl a at x.mtl:1"},
    {NULL, "a", "illum 3\nKs 0 0 0", 5, MATERIAL_BLINN_PHONG,
     "newmtl a at x.mtl:1"},
    {NULL, "a", "illum 6\nNi 1.45", 3, MATERIAL_GLASS,
     "illum 6 at x.mtl:2, Ni 1.45 at x.mtl:3"},
    {NULL, "a", "illum 7\nNi 1.01", 3, MATERIAL_GLASS,
     "illum 7 at x.mtl:2, Ni 1.01 at x.mtl:3"},
    {NULL, "a", "illum 7\nNi 1", 5, MATERIAL_BLINN_PHONG,
     "newmtl a at x.mtl:1"},
    {NULL, "a", "illum 6", 5, MATERIAL_BLINN_PHONG, "newmtl a at x.mtl:1"},
    {NULL, "a", "illum 4\nd 0.5", 3, MATERIAL_BLINN_PHONG,
     "illum 4 at x.mtl:2"},
    {NULL, "a", "illum 9", 3, MATERIAL_BLINN_PHONG, "illum 9 at x.mtl:2"},
    {NULL, "a", "illum 2\nNi 1.5", 5, MATERIAL_BLINN_PHONG,
     "newmtl a at x.mtl:1"},
    // Earlier rules win.
    {"glass", "mirror", "Pr .2\nillum 3\nKs 1 1 1", 2, MATERIAL_METAL_ROUGH,
     "Pr 0.2 at x.mtl:2"},
    {"glass", "a", "illum 3\nKs 1 1 1", 3, MATERIAL_MIRROR,
     "illum 3 at x.mtl:2, Ks at x.mtl:3"},
    // The object's name goes before the material's.
    {"Window_glass", "a", "illum 2", 4, MATERIAL_GLASS,
     "object name Window_glass holds the word glass"},
    {"Mirror.001", "glass", "illum 2", 4, MATERIAL_MIRROR,
     "object name Mirror.001 holds the word mirror"},
    {"Sphere", "my glass", "illum 2", 4, MATERIAL_GLASS,
     "material name my glass holds the word glass"},
    {"Eyeglasses", "glassy", "illum 2", 5, MATERIAL_BLINN_PHONG,
     "newmtl glassy at x.mtl:1"},
};

static void first_matching_rule_wins(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    const row *r = &ROWS[i];
    arena mem = {0};
    mtl_material w = written(r->name, r->text, &mem);
    material_use use = {.object = r->object,
                        .name = r->name,
                        .written = &w,
                        .name_rules = true};
    material m = material_decide(&use, &mem);
    char why[200];
    snprintf(why, sizeof why, "rule %d: %s", r->rule, r->why);
    assert_string_equal(m.why, why);
    assert_int_equal(m.rule, r->rule);
    assert_int_equal(m.kind, r->kind);
    assert_string_equal(m.name, r->name);
    assert_ptr_equal(m.source, &w);
    arena_free(&mem);
  }
}

// Words are whole and case does not matter; blanks, _ . - and digits split.
static void words_are_whole(void **state) {
  (void)state;
  const char *yes[] = {"glass",     "Glass",    "GLASS.001",       "wine_glass",
                       "glass-top", "my glass", "a.glass2b",       "2glass3",
                       "-glass",    "Glass_",   "glassglass glass"};
  const char *no[] = {"",       "glas",       "glasses",       "eyeglass",
                      "gla ss", "fibreglass", "glass\xc3\xa9", "gglass"};
  for (size_t i = 0; i < sizeof yes / sizeof *yes; i++)
    if (!material_has_word(yes[i], "glass")) fail_msg("%s", yes[i]);
  for (size_t i = 0; i < sizeof no / sizeof *no; i++)
    if (material_has_word(no[i], "glass")) fail_msg("%s", no[i]);
}

// The decision for statements alone, no names.
static material of_text(const char *object, const char *text, arena *mem) {
  mtl_material *w = ARENA_NEW(mem, mtl_material, 1);
  *w = written("m", text, mem);
  material_use use = {
      .object = object, .name = "m", .written = w, .name_rules = true};
  return material_decide(&use, mem);
}

// What a mirror reflects and how a glass refracts.
static void mirrors_and_glasses_have_their_numbers(void **state) {
  (void)state;
  arena mem = {0};
  assert_true(of_text(NULL, "illum 3\nKs .5 .6 .7", &mem).ks.z == 0.7f);
  assert_true(of_text("mirror", "Kd .2 .3 .4", &mem).ks.y == 0.3f);
  assert_true(of_text("mirror", "Kd .2 .3 .4\nKs 0 0 0", &mem).ks.y == 0.3f);
  assert_true(of_text("mirror", "Kd .2 .3 .4\nKs 1 .9 0", &mem).ks.y == 0.9f);
  assert_true(of_text("glass", "Ni 1.33", &mem).ni == 1.33f);
  assert_true(of_text("glass", "Ni 1", &mem).ni == 1.5f);
  assert_true(of_text("glass", "Ni 0.2", &mem).ni == 1.5f);
  assert_true(of_text("glass", "Kd 1 1 1", &mem).ni == 1.5f);
  assert_true(of_text(NULL, "illum 7\nNi 2.4", &mem).ni == 2.4f);
  arena_free(&mem);
}

// Tf counts under rule 2 alone; Pr and Pm have their defaults.
static void metal_rough_has_its_numbers(void **state) {
  (void)state;
  arena mem = {0};
  material m = of_text(NULL, "Kd .1 .2 .3\nPm 1\nTf .5 .6 .7", &mem);
  assert_true(m.roughness == 0.5f && m.metallic == 1 && m.kd.y == 0.2f);
  assert_true(m.tf.x == 0.5f && m.tf.z == 0.7f);
  assert_true(of_text(NULL, "Pr 1", &mem).tf.x == 0);
  assert_true(of_text(NULL, "Tf .5 .6 .7", &mem).tf.x == 0);
  assert_true(of_text(NULL, "Pr 0.25", &mem).metallic == 0);
  arena_free(&mem);
}

// d below 1 or an alpha map lets light pass, but not through glass.
static void opacity_lets_light_pass(void **state) {
  (void)state;
  arena mem = {0};
  assert_true(of_text(NULL, "d 0.5", &mem).passes);
  assert_true(of_text(NULL, "Tr 0.5", &mem).passes);
  assert_true(of_text(NULL, "illum 9\nd 0.99", &mem).passes);
  assert_true(of_text(NULL, "map_d a.png", &mem).passes);
  assert_true(of_text(NULL, "Pr 1\nd 0", &mem).passes);
  assert_false(of_text(NULL, "d 1", &mem).passes);
  assert_false(of_text(NULL, "illum 9", &mem).passes);
  assert_false(of_text("glass", "d 0.5", &mem).passes);
  assert_false(of_text(NULL, "illum 7\nNi 1.5\nd 0.1", &mem).passes);
  arena_free(&mem);
}

// A map stands for the number that is not given, and scales one that is.
static void maps_stand_for_numbers(void **state) {
  (void)state;
  arena mem = {0};
  material m = of_text(NULL,
                       "map_Kd a.png\nmap_Ks b.png\nmap_Ke c.png\n"
                       "map_Ns d.png\nmap_Pr -imfchan g e.png\nmap_Pm f.png",
                       &mem);
  assert_true(m.kd.x == 1 && m.ks.x == 1 && m.ke.x == 1);
  assert_true(m.ns == 1000 && m.roughness == 1 && m.metallic == 1);
  assert_true(m.map_kd.is_color && m.map_ks.is_color && m.map_ke.is_color);
  assert_false(m.map_ns.is_color || m.map_pr.is_color || m.map_pm.is_color);
  assert_true(m.map_pr.options.channel == 'g' && m.map_pr.image == NULL);
  assert_string_equal(m.map_pr.options.path, "e.png");
  m = of_text(NULL, "Ke 2 2 2\nmap_Ke c.png\nPr 0.5\nmap_Pr e.png", &mem);
  assert_true(m.ke.x == 2 && m.roughness == 0.5f);
  arena_free(&mem);
}

// An assigned material decides by its own statements and its own name, not by
// those of the face; both places are told.
static void assigned_materials_win(void **state) {
  (void)state;
  arena mem = {0};
  mtl_material w = written("w", "Pr 0.3", &mem);
  mtl_material mine = written("chrome", "illum 3\nKs 1 1 1", &mem);
  material_use use = {.object = "glass",
                      .name = "w",
                      .assigned = &mine,
                      .assigned_at = "x.scene:9",
                      .written = &w,
                      .name_rules = true};
  material m = material_decide(&use, &mem);
  assert_int_equal(m.kind, MATERIAL_MIRROR);
  assert_int_equal(m.rule, 1);
  assert_string_equal(m.why, "rule 1: assign at x.scene:9, then illum 3 at "
                             "x.mtl:2, Ks at x.mtl:3");
  mtl_material plain = written("plain", "Kd 1 1 1", &mem);
  use.assigned = &plain;
  assert_int_equal(material_decide(&use, &mem).kind, MATERIAL_BLINN_PHONG);
  mtl_material clear = written("clear glass", "Kd 1 1 1", &mem);
  use.assigned = &clear;
  assert_int_equal(material_decide(&use, &mem).kind, MATERIAL_GLASS);
  arena_free(&mem);
}

// Without any material the face is grey; names still count, unless the rule
// is off.
static void no_material_is_grey(void **state) {
  (void)state;
  arena mem = {0};
  material_use use = {.name_rules = true};
  material m = material_decide(&use, &mem);
  assert_string_equal(m.why, "rule 5: no material");
  assert_true(m.kd.x == 0.8f && m.ks.x == 0 && m.d == 1 && m.source == NULL);
  use.object = "Glass";
  assert_int_equal(material_decide(&use, &mem).kind, MATERIAL_GLASS);
  use.name_rules = false;
  assert_int_equal(material_decide(&use, &mem).kind, MATERIAL_BLINN_PHONG);
  use.object = NULL;
  use.name = "mirror";
  assert_int_equal(material_decide(&use, &mem).kind, MATERIAL_BLINN_PHONG);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(first_matching_rule_wins),
      cmocka_unit_test(words_are_whole),
      cmocka_unit_test(mirrors_and_glasses_have_their_numbers),
      cmocka_unit_test(metal_rough_has_its_numbers),
      cmocka_unit_test(opacity_lets_light_pass),
      cmocka_unit_test(maps_stand_for_numbers),
      cmocka_unit_test(assigned_materials_win),
      cmocka_unit_test(no_material_is_grey),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

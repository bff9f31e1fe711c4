// Contexts and shaders.

#include "gl_worlds.h"

#include "gl_make.h"
#include "glsl.h"

#include <string.h>

// A context of either library opens, clears a framebuffer of floats, also a
// multisampled one, and gives back what it was cleared to.
static void either_backend_draws(void **state) {
  (void)state;
  const gl_backend backends[2] = {GL_BACKEND_OSMESA, GL_BACKEND_EGL};
  const char *const names[2] = {"OSMesa", "EGL"};
  int opened = 0;
  for (int i = 0; i < 2; i++) {
    arena mem = {0};
    error err;
    gl *g;
    if (!gl_open(&g, backends[i], &mem, &err)) {
      print_message("# %s\n", err.text);
      assert_non_null(strstr(err.text, i ? "libegl1" : "libosmesa6"));
      continue;
    }
    opened++;
    assert_string_equal(gl_backend_name(g), names[i]);
    assert_non_null(gl_renderer(g));
    const gl_api *f = gl_functions(g);
    for (int samples = 1; samples <= 4; samples += 3) {
      gl_target t;
      assert_true(gl_target_new(&t, g, 7, 5, samples, &err));
      f->BindFramebuffer(GL_FRAMEBUFFER, t.draw);
      f->ClearColor(0.125f, 1000, -3, 0.5f);
      f->Clear(GL_COLOR_BUFFER_BIT);
      gl_target_resolve(g, &t);
      float alpha[35];
      image im = gl_target_image(g, &t, alpha, &mem);
      assert_int_equal(im.width, 7);
      assert_int_equal(im.height, 5);
      for (int k = 0; k < 35; k++) {
        assert_true(im.pixels[k].x == 0.125f && im.pixels[k].y == 1000);
        assert_true(im.pixels[k].z == -3 && alpha[k] == 0.5f);
      }
      gl_target_free(g, &t);
    }
    assert_int_equal(f->GetError(), GL_NO_ERROR);
    gl_close(g);
    arena_free(&mem);
  }
  if (opened == 0) skip();
}

// A library that is not there is an error that names its package, and a window
// without a function is an error that names it.
static void missing_is_said(void **state) {
  (void)state;
  const gl_library none = {"Nonesuch",
                           {"libnonesuch.so.8", "libnonesuch.so", NULL, NULL},
                           "libnonesuch6"};
  error err;
  assert_null(gl_library_load(&none, &err));
  assert_non_null(strstr(err.text, "libnonesuch.so.8"));
  assert_non_null(strstr(err.text, "apt-get install libnonesuch6"));
}

static gl_function no_function(const char *name) {
  (void)name;
  return NULL;
}

static void window_without_functions(void **state) {
  (void)state;
  arena mem = {0};
  gl *g = NULL;
  error err;
  assert_false(gl_adopt(&g, no_function, &mem, &err));
  assert_null(g);
  assert_non_null(strstr(err.text, "glActiveTexture"));
  arena_free(&mem);
}

// The names of the command line, and no others.
static void backend_names(void **state) {
  (void)state;
  gl_backend b = GL_BACKEND_EGL;
  assert_true(gl_backend_of(&b, "auto") && b == GL_BACKEND_AUTO);
  assert_true(gl_backend_of(&b, "osmesa") && b == GL_BACKEND_OSMESA);
  assert_true(gl_backend_of(&b, "egl") && b == GL_BACKEND_EGL);
  assert_false(gl_backend_of(&b, "EGL2"));
}

// Row 0 of what is read back is the top, column 0 the left.
static void rows_from_the_top(void **state) {
  (void)state;
  arena mem = {0};
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  const gl_api *f = gl_functions(g);
  gl_target t;
  error err;
  assert_true(gl_target_new(&t, g, 4, 3, 1, &err));
  f->BindFramebuffer(GL_FRAMEBUFFER, t.draw);
  f->ClearColor(0, 0, 0, 0);
  f->Clear(GL_COLOR_BUFFER_BIT);
  f->Enable(GL_SCISSOR_TEST);
  f->Scissor(1, 2, 1, 1);
  f->ClearColor(1, 1, 1, 1);
  f->Clear(GL_COLOR_BUFFER_BIT);
  f->Disable(GL_SCISSOR_TEST);
  image im = gl_target_image(g, &t, NULL, &mem);
  for (int i = 0; i < 12; i++)
    assert_true(im.pixels[i].x == (i == 1 ? 1.0f : 0.0f));
  gl_target_free(g, &t);
  gl_close(g);
  arena_free(&mem);
}

// Messages of Mesa and of other compilers name the file and the line.
static void compiler_messages(void **state) {
  (void)state;
  arena mem = {0};
  const char *const parts[] = {"num.glsl", "sky.frag", NULL};
  const char *log = "0:1(2): a\n0:200017(3): error: b 1:2(3)\n"
                    "0(100009) : error c\n0:700001(1): d\n12 e\n";
  const char *want = "defines:1: a\nshaders/sky.frag:17: error: b 1:2(3)\n"
                     "shaders/num.glsl:9 : error c\n0:700001(1): d\n12 e\n";
  assert_string_equal(glsl_explain(log, parts, &mem), want);
  assert_string_equal(glsl_explain("", parts, &mem), "");
  arena_free(&mem);
}

// What does not compile is an error at its file and line; so is a file that is
// not there.
static void compile_errors(void **state) {
  (void)state;
  arena mem = {0};
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  GLuint program = 77;
  error err;
  // Line 1 of sky.frag's body uses env_seen, which is not there.
  glsl_spec lacking = {.vertex = {"shadow.vert"}, .fragment = {"sky.frag"}};
  assert_false(glsl_program(&program, g, &lacking, &err));
  print_message("# %s\n", err.text);
  assert_non_null(strstr(err.text, "shaders/sky.frag:8: "));
  assert_int_equal(program, 77);
  glsl_spec absent = {.vertex = {"shadow.vert"}, .fragment = {"none.frag"}};
  assert_false(glsl_program(&program, g, &absent, &err));
  assert_non_null(strstr(err.text, "shaders/none.frag"));
  glsl_spec sound = {.vertex = {"shadow.vert"}, .fragment = {"shadow.frag"}};
  assert_true(glsl_program(&program, g, &sound, &err));
  gl_close(g);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(either_backend_draws),
      cmocka_unit_test(missing_is_said),
      cmocka_unit_test(window_without_functions),
      cmocka_unit_test(backend_names),
      cmocka_unit_test(rows_from_the_top),
      cmocka_unit_test(compiler_messages),
      cmocka_unit_test(compile_errors),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

// bare_osmesa.c — the least that a program pays that draws one triangle by
// OSMesa: open the library, a context of OpenGL 3.3, one program, one draw,
// one picture read back.
//
//   cc -O2 tests/bench/bare_osmesa.c -ldl -o build/bare_osmesa
//   build/bare_osmesa WIDTH HEIGHT
//
// Prints how many pixels the triangle covers.

#include <GL/glcorearb.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef void (*gl_function)(void);

static void *library;
static gl_function (*load)(const char *name);

// Put a function of the library, or of OpenGL, into a pointer.
static void find(void *to, const char *name) {
  void *symbol = dlsym(library, name);
  if (symbol == NULL) exit(2);
  memcpy(to, &symbol, sizeof symbol);
}

static void find_gl(void *to, const char *name) {
  gl_function f = load(name);
  if (f == NULL) exit(2);
  memcpy(to, &f, sizeof f);
}

#define GL(type, name) \
  type name; \
  find_gl(&name, #name)

// As attributes of OSMesaCreateContextAttribs: RGBA, core profile, 3.3.
static const int attributes[] = {0x22, GL_RGBA, 0x33, 0x34, 0x36, 3,
                                 0x37, 3,       0};

static const char *const vertex =
    "#version 330 core\n"
    "void main() {\n"
    "  vec2 p = vec2(gl_VertexID == 1 ? 0.8 : -0.8,\n"
    "                gl_VertexID == 2 ? 0.8 : -0.8);\n"
    "  gl_Position = vec4(p, 0.0, 1.0);\n"
    "}\n";
static const char *const fragment =
    "#version 330 core\n"
    "out vec4 color;\n"
    "void main() { color = vec4(1.0, 0.5, 0.25, 1.0); }\n";

static GLuint make_program(void) {
  GL(PFNGLCREATESHADERPROC, glCreateShader);
  GL(PFNGLSHADERSOURCEPROC, glShaderSource);
  GL(PFNGLCOMPILESHADERPROC, glCompileShader);
  GL(PFNGLCREATEPROGRAMPROC, glCreateProgram);
  GL(PFNGLATTACHSHADERPROC, glAttachShader);
  GL(PFNGLLINKPROGRAMPROC, glLinkProgram);
  GLuint program = glCreateProgram();
  const char *const text[2] = {vertex, fragment};
  for (int i = 0; i < 2; i++) {
    GLuint shader =
        glCreateShader(i == 0 ? GL_VERTEX_SHADER : GL_FRAGMENT_SHADER);
    glShaderSource(shader, 1, &text[i], NULL);
    glCompileShader(shader);
    glAttachShader(program, shader);
  }
  glLinkProgram(program);
  return program;
}

int main(int argc, char **argv) {
  int width = argc > 1 ? atoi(argv[1]) : 64;
  int height = argc > 2 ? atoi(argv[2]) : 64;
  library = dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
  if (library == NULL) return fprintf(stderr, "no libOSMesa.so.8\n"), 2;
  void *(*create)(const int *, void *);
  GLboolean (*current)(void *, void *, GLenum, GLsizei, GLsizei);
  void (*destroy)(void *);
  find(&create, "OSMesaCreateContextAttribs");
  find(&current, "OSMesaMakeCurrent");
  find(&destroy, "OSMesaDestroyContext");
  find(&load, "OSMesaGetProcAddress");
  size_t bytes = 4 * (size_t)width * (size_t)height;
  unsigned char *frame = calloc(2, bytes);
  void *context = create(attributes, NULL);
  if (context == NULL || frame == NULL ||
      !current(context, frame, GL_UNSIGNED_BYTE, width, height))
    return fprintf(stderr, "no context\n"), 2;
  GL(PFNGLUSEPROGRAMPROC, glUseProgram);
  GL(PFNGLGENVERTEXARRAYSPROC, glGenVertexArrays);
  GL(PFNGLBINDVERTEXARRAYPROC, glBindVertexArray);
  GL(PFNGLCLEARPROC, glClear);
  GL(PFNGLDRAWARRAYSPROC, glDrawArrays);
  GL(PFNGLREADPIXELSPROC, glReadPixels);
  GLuint none;
  glGenVertexArrays(1, &none);
  glBindVertexArray(none);
  glUseProgram(make_program());
  glClear(GL_COLOR_BUFFER_BIT);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  unsigned char *read = frame + bytes;
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, read);
  size_t covered = 0;
  for (size_t i = 0; i < bytes; i += 4)
    covered += read[i] > 0;
  printf("%zu pixels\n", covered);
  destroy(context);
  return covered > 0 ? 0 : 1;
}

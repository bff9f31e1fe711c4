// glsl.h — programs put together from the files of shaders/, which the build
// puts into the binary.

#ifndef GLSL_H
#define GLSL_H

#include "gl.h"
#include "gl_api.h"

// A file of shaders/: "sky.frag" and its text.
typedef struct glsl_file {
  const char *name, *text;
} glsl_file;

// All of them; the last has no name.  Generated: see the Makefile.
extern const glsl_file GLSL_FILES[];

// The most files in one stage.
enum { GLSL_MAX_PARTS = 16 };

// What a program is made of.  Each stage is the files in this order, with
// NULL at the end, after "#version 330 core" and the defines.
typedef struct glsl_spec {
  const char *vertex[GLSL_MAX_PARTS], *fragment[GLSL_MAX_PARTS];
  const char *defines;     // whole lines, "#define LIGHTS 2\n"; NULL: none
  const char *attributes;  // names of the vertex attributes 0, 1, ... with a
                           // blank between; NULL: none
} glsl_spec;

// Compile and link.  An error says "shaders/sky.frag:12: ...".
bool glsl_program(GLuint *out, const gl *g, const glsl_spec *spec, error *err);

// The text of a file; NULL when there is none of that name.
const char *glsl_text(const char *name);

// A compiler's message with its line numbers replaced by files and theirs.
char *glsl_explain(const char *log, const char *const *parts, arena *mem);

#endif

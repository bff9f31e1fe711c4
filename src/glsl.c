// glsl.c

#include "glsl.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

// Each stage begins with this line.
#define GLSL_VERSION "#version 330 core\n"

const char *glsl_text(const char *name) {
  for (const glsl_file *f = GLSL_FILES; f->name != NULL; f++)
    if (strcmp(f->name, name) == 0) return f->text;
  return NULL;
}

static bool has_digit(const char *c) {
  return isdigit((unsigned char)*c) != 0;
}

// A file's lines are numbered from this times its place in the stage, plus 1:
// OpenGL can number the sources too, but Mesa forgets that number on the way to
// its messages.
enum { LINES_EACH = 100000 };

// The end of "0:12(5)" (Mesa) or "0(12)" (others) at c, and the number of the
// line; NULL where there is none.
static const char *line_at(const char *c, unsigned long *line) {
  char *end;
  if (!has_digit(c)) return NULL;
  strtoul(c, &end, 10);
  if ((*end != ':' && *end != '(') || !has_digit(end + 1)) return NULL;
  bool mesa = *end == ':';
  *line = strtoul(end + 1, &end, 10);
  if (!mesa) return *end == ')' ? end + 1 : NULL;
  if (*end != '(' || !has_digit(end + 1)) return NULL;
  strtoul(end + 1, &end, 10);
  return *end == ')' ? end + 1 : NULL;
}

// The number of files before the NULL.
static unsigned long part_count(const char *const *parts) {
  unsigned long n = 0;
  while (n < GLSL_MAX_PARTS && parts[n] != NULL)
    n++;
  return n;
}

char *glsl_explain(const char *log, const char *const *parts, arena *mem) {
  char *out = arena_format(mem, "%s", "");
  unsigned long count = part_count(parts);
  for (const char *c = log; *c != '\0';) {
    unsigned long line = 0;
    const char *end = line_at(c, &line);
    unsigned long part = line / LINES_EACH;
    if (end != NULL && part <= count) {
      const char *name = part == 0 ? "defines" : parts[part - 1];
      out = arena_format(mem, "%s%s%s:%lu", out, part ? "shaders/" : "", name,
                         line % LINES_EACH);
      c = end;
    }
    size_t n = strcspn(c, "\n");
    if (c[n] == '\n') n++;
    out = arena_format(mem, "%s%.*s", out, (int)n, c);
    c += n;
  }
  return out;
}

// The text of a stage.
static char *assemble(const char *const *parts, const char *defines, arena *mem,
                      error *err) {
  char *text = arena_format(mem, GLSL_VERSION "%s", defines ? defines : "");
  unsigned long count = part_count(parts);
  for (unsigned long i = 0; i < count; i++) {
    const char *part = glsl_text(parts[i]);
    if (part == NULL) {
      fail(err, "shaders/%s: there is no such file", parts[i]);
      return NULL;
    }
    text = arena_format(mem, "%s#line %lu\n%s", text, (i + 1) * LINES_EACH + 1,
                        part);
  }
  return text;
}

static bool compile_stage(GLuint *out, const gl *g, GLenum kind,
                          const glsl_spec *spec, error *err) {
  const gl_api *f = gl_functions(g);
  const char *const *parts =
      kind == GL_VERTEX_SHADER ? spec->vertex : spec->fragment;
  arena scratch = {0};
  const char *text = assemble(parts, spec->defines, &scratch, err);
  GLint ok = text != NULL;
  if (ok) {
    *out = f->CreateShader(kind);
    f->ShaderSource(*out, 1, &text, NULL);
    f->CompileShader(*out);
    f->GetShaderiv(*out, GL_COMPILE_STATUS, &ok);
    char log[2048] = "";
    if (!ok) f->GetShaderInfoLog(*out, sizeof log, NULL, log);
    if (!ok) fail(err, "%.600s", glsl_explain(log, parts, &scratch));
  }
  arena_free(&scratch);
  return ok != 0;
}

// Number the vertex attributes in the order of their names.
static void bind_attributes(const gl_api *f, GLuint program,
                            const char *names) {
  GLuint number = 0;
  for (const char *c = names; c != NULL && *c != '\0'; number++) {
    char name[32];
    size_t n = strcspn(c, " ");
    if (n >= sizeof name) return;
    memcpy(name, c, n);
    name[n] = '\0';
    f->BindAttribLocation(program, number, name);
    c += n + (c[n] == ' ');
  }
}

static bool link_stages(GLuint program, const gl *g, const glsl_spec *spec,
                        error *err) {
  const gl_api *f = gl_functions(g);
  bind_attributes(f, program, spec->attributes);
  f->LinkProgram(program);
  GLint ok;
  f->GetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok) return true;
  char log[600] = "";
  f->GetProgramInfoLog(program, sizeof log, NULL, log);
  return fail(err, "shaders: cannot link: %s", log);
}

bool glsl_program(GLuint *out, const gl *g, const glsl_spec *spec, error *err) {
  const gl_api *f = gl_functions(g);
  GLuint vertex = 0, fragment = 0, program = f->CreateProgram();
  bool ok = compile_stage(&vertex, g, GL_VERTEX_SHADER, spec, err) &&
            compile_stage(&fragment, g, GL_FRAGMENT_SHADER, spec, err);
  if (ok) {
    f->AttachShader(program, vertex);
    f->AttachShader(program, fragment);
    ok = link_stages(program, g, spec, err);
  }
  f->DeleteShader(vertex);
  f->DeleteShader(fragment);
  if (ok)
    *out = program;
  else
    f->DeleteProgram(program);
  return ok;
}

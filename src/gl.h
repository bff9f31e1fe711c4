// gl.h — an OpenGL 3.3 core context that needs no screen, from whichever
// library is there when the program runs.
//
// No GL header here: what draws includes gl_api.h as well.

#ifndef GL_H
#define GL_H

#include "arena.h"
#include "error.h"

// Where a context comes from.  AUTO tries OSMesa, then EGL.
typedef enum gl_backend {
  GL_BACKEND_AUTO,
  GL_BACKEND_OSMESA,  // libOSMesa: draws into memory, by the CPU
  GL_BACKEND_EGL      // libEGL without a surface: GPU where there is one
} gl_backend;

// A context and its functions.  It is current on the thread that opened it,
// and only one may be open at a time in a process.
typedef struct gl gl;

// Open a context without a window.  On failure *out is untouched and err names
// the Debian package that brings the library (exit status 5).
bool gl_open(gl **out, gl_backend b, arena *mem, error *err);

// Use the context that is current already, a window's: `load` finds functions
// by name, such as glfwGetProcAddress.  Fails when one is missing.
typedef void (*gl_function)(void);
bool gl_adopt(gl **out, gl_function (*load)(const char *name), arena *mem,
              error *err);

// Release the context; the library stays loaded.  NULL is fine.
void gl_close(gl *g);

// The functions of the context, of gl_api.h.
const struct gl_api *gl_functions(const gl *g);

// "OSMesa", "EGL" or "window"; and what draws, as the driver names itself.
const char *gl_backend_name(const gl *g);
const char *gl_renderer(const gl *g);

// AUTO, OSMESA or EGL from auto, osmesa or egl; false for no such name.
bool gl_backend_of(gl_backend *out, const char *name);

// A library that may be loaded: shared objects to try in this order, NULL at
// the end, and the Debian packages that bring it.
typedef struct gl_library {
  const char *name;      // "OSMesa"
  const char *files[4];  // the last is NULL
  const char *packages;  // "libosmesa6"
} gl_library;

// The handle of dlopen, or NULL with a message that names the packages.
void *gl_library_load(const gl_library *l, error *err);

#endif

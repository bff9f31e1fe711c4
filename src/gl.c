// gl.c — the trick: nothing is linked.  The libraries are opened when a
// picture is asked for, and what is missing is said by name.

#include "gl.h"

#include "gl_api.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>
#include <string.h>

typedef struct osmesa_context osmesa_context;

// The attributes of an OSMesa context, as in GL/osmesa.h, a header that goes
// when OSMesa does.
enum osmesa_attribute {
  OSMESA_FORMAT = 0x22,
  OSMESA_PROFILE = 0x33,
  OSMESA_CORE_PROFILE = 0x34,
  OSMESA_MAJOR = 0x36,
  OSMESA_MINOR = 0x37
};

struct gl {
  gl_api api;
  const char *name;
  osmesa_context *osmesa;  // NULL when it is not OSMesa's
  void (*osmesa_destroy)(osmesa_context *);
  unsigned char *pixels;  // OSMesa wants a frame, even if nobody draws there
  EGLDisplay display;
  EGLContext egl;  // NULL when it is not EGL's
  EGLBoolean (*egl_destroy)(EGLDisplay, EGLContext);
  EGLBoolean (*egl_current)(EGLDisplay, EGLSurface, EGLSurface, EGLContext);
};

// Mesa 25.1 no longer has it, but the systems of today do.
static const gl_library OSMESA_LIBRARY = {
    "OSMesa",
    {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so", NULL},
    "libosmesa6",
};
static const gl_library EGL_LIBRARY = {
    "EGL",
    {"libEGL.so.1", "libEGL.so", NULL, NULL},
    "libegl1 libgl1-mesa-dri",
};

// OpenGL 3.3 core: the last version that wants nothing a decade old computer
// or a CPU lacks.
enum { GL_MAJOR = 3, GL_MINOR = 3 };

void *gl_library_load(const gl_library *l, error *err) {
  for (int i = 0; l->files[i] != NULL; i++) {
    void *handle = dlopen(l->files[i], RTLD_NOW | RTLD_LOCAL);
    if (handle != NULL) return handle;
  }
  fail(err, "%s: cannot load %s; on Debian: apt-get install %s", l->name,
       l->files[0], l->packages);
  return NULL;
}

// A function of a library.  ISO C has no conversion from the void pointer of
// dlsym to a function; POSIX promises that the bytes are the same.
static bool find_symbol(void *function, void *library, const char *name,
                        error *err) {
  void *symbol = dlsym(library, name);
  if (symbol == NULL) return fail(err, "the library has no %s", name);
  memcpy(function, &symbol, sizeof symbol);
  return true;
}

// Load one function into a member of the table, whatever its type.
#define FIND_FUNCTION(type, member) \
  if (!put_function(&g->api.member, load("gl" #member))) \
    return fail(err, "OpenGL: no function gl" #member \
                     ", expected OpenGL 3.3 or later");

static bool put_function(void *member, gl_function f) {
  memcpy(member, &f, sizeof f);
  return f != NULL;
}

static bool load_functions(gl *g, gl_function (*load)(const char *name),
                           error *err) {
  GL_FUNCTIONS(FIND_FUNCTION)
  put_function(&g->api.ClipControl, load("glClipControl"));
  return true;
}

static bool open_osmesa(gl *g, arena *mem, error *err) {
  void *library = gl_library_load(&OSMESA_LIBRARY, err);
  if (library == NULL) return false;
  osmesa_context *(*create)(const int *, osmesa_context *) = NULL;
  GLboolean (*current)(osmesa_context *, void *, GLenum, GLsizei, GLsizei) =
      NULL;
  gl_function (*load)(const char *) = NULL;
  if (!find_symbol(&create, library, "OSMesaCreateContextAttribs", err) ||
      !find_symbol(&current, library, "OSMesaMakeCurrent", err) ||
      !find_symbol(&load, library, "OSMesaGetProcAddress", err) ||
      !find_symbol(&g->osmesa_destroy, library, "OSMesaDestroyContext", err))
    return false;
  const int attributes[] = {OSMESA_FORMAT,       GL_RGBA,      OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE, OSMESA_MAJOR, GL_MAJOR,
                            OSMESA_MINOR,        GL_MINOR,     0};
  osmesa_context *context = create(attributes, NULL);
  if (context == NULL)
    return fail(err, "OSMesa: no OpenGL %d.%d core context", GL_MAJOR,
                GL_MINOR);
  g->osmesa = context;
  g->pixels = ARENA_NEW(mem, unsigned char, 4);
  if (!current(context, g->pixels, GL_UNSIGNED_BYTE, 1, 1))
    return fail(err, "OSMesa: cannot make its context current");
  g->name = "OSMesa";
  return load_functions(g, load, err);
}

// What opening EGL calls.
typedef struct egl_api {
  EGLBoolean (*initialize)(EGLDisplay, EGLint *, EGLint *);
  EGLBoolean (*bind)(EGLenum);
  EGLContext (*create)(EGLDisplay, EGLConfig, EGLContext, const EGLint *);
  gl_function (*load)(const char *);
} egl_api;

static bool find_egl(gl *g, egl_api *egl, void *library, error *err) {
  return find_symbol(&egl->initialize, library, "eglInitialize", err) &&
         find_symbol(&egl->bind, library, "eglBindAPI", err) &&
         find_symbol(&egl->create, library, "eglCreateContext", err) &&
         find_symbol(&egl->load, library, "eglGetProcAddress", err) &&
         find_symbol(&g->egl_current, library, "eglMakeCurrent", err) &&
         find_symbol(&g->egl_destroy, library, "eglDestroyContext", err);
}

// A display without any screen.
static EGLDisplay surfaceless_display(const egl_api *egl) {
  PFNEGLGETPLATFORMDISPLAYEXTPROC get;
  if (!put_function(&get, egl->load("eglGetPlatformDisplayEXT")))
    return EGL_NO_DISPLAY;
  return get(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
}

static bool open_egl(gl *g, error *err) {
  void *library = gl_library_load(&EGL_LIBRARY, err);
  egl_api egl = {0};
  if (library == NULL || !find_egl(g, &egl, library, err)) return false;
  g->display = surfaceless_display(&egl);
  if (g->display == EGL_NO_DISPLAY || !egl.initialize(g->display, NULL, NULL))
    return fail(err, "EGL: no display without a surface, expected a driver; "
                     "on Debian: apt-get install libgl1-mesa-dri");
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                               GL_MAJOR,
                               EGL_CONTEXT_MINOR_VERSION,
                               GL_MINOR,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_NONE};
  if (!egl.bind(EGL_OPENGL_API))
    return fail(err, "EGL: it knows no desktop OpenGL");
  g->egl =
      egl.create(g->display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
  if (g->egl == EGL_NO_CONTEXT)
    return fail(err, "EGL: no OpenGL %d.%d core context", GL_MAJOR, GL_MINOR);
  if (!g->egl_current(g->display, EGL_NO_SURFACE, EGL_NO_SURFACE, g->egl))
    return fail(err, "EGL: cannot make its context current");
  g->name = "EGL";
  return load_functions(g, egl.load, err);
}

bool gl_open(gl **out, gl_backend b, arena *mem, error *err) {
  gl *g = ARENA_NEW(mem, gl, 1);
  bool ok = b != GL_BACKEND_EGL && open_osmesa(g, mem, err);
  if (!ok && b == GL_BACKEND_AUTO) {
    error first = *err;
    gl_close(g);
    *g = (gl){0};
    ok = open_egl(g, err);
    error second = *err;
    if (!ok) fail(err, "%.300s; %.300s", first.text, second.text);
  } else if (b == GL_BACKEND_EGL) {
    ok = open_egl(g, err);
  }
  if (ok)
    *out = g;
  else
    gl_close(g);
  return ok;
}

bool gl_adopt(gl **out, gl_function (*load)(const char *name), arena *mem,
              error *err) {
  gl *g = ARENA_NEW(mem, gl, 1);
  g->name = "window";
  if (!load_functions(g, load, err)) return false;
  *out = g;
  return true;
}

// The display stays initialised: the next context of the process uses it.
void gl_close(gl *g) {
  if (g == NULL) return;
  if (g->osmesa != NULL) g->osmesa_destroy(g->osmesa);
  if (g->egl != NULL) {
    g->egl_current(g->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    g->egl_destroy(g->display, g->egl);
  }
  g->osmesa = NULL;
  g->egl = NULL;
}

const gl_api *gl_functions(const gl *g) {
  return &g->api;
}

const char *gl_backend_name(const gl *g) {
  return g->name;
}

const char *gl_renderer(const gl *g) {
  return (const char *)g->api.GetString(GL_RENDERER);
}

bool gl_backend_of(gl_backend *out, const char *name) {
  static const char *const names[] = {"auto", "osmesa", "egl"};
  for (int i = 0; i < 3; i++) {
    if (strcmp(names[i], name) != 0) continue;
    *out = (gl_backend)i;
    return true;
  }
  return false;
}

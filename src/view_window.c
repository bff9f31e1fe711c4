// view_window.c

#include "view_window.h"

#include "gl_api.h"
#include "gl_make.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <dlfcn.h>
#include <string.h>

static const gl_library GLFW_LIBRARY = {
    "GLFW",
    {"libglfw.so.3", "libglfw.so", NULL, NULL},
    "libglfw3",
};

// X(result, name without glfw, parameters), for each function that is called.
#define GLFW_FUNCTIONS(X) \
  X(int, Init, (void)) \
  X(void, Terminate, (void)) \
  X(int, GetError, (const char **)) \
  X(void, WindowHint, (int, int)) \
  X(GLFWwindow *, CreateWindow, \
    (int, int, const char *, GLFWmonitor *, GLFWwindow *)) \
  X(void, DestroyWindow, (GLFWwindow *)) \
  X(int, WindowShouldClose, (GLFWwindow *)) \
  X(void, MakeContextCurrent, (GLFWwindow *)) \
  X(gl_function, GetProcAddress, (const char *)) \
  X(void, SwapInterval, (int)) \
  X(void, SwapBuffers, (GLFWwindow *)) \
  X(void, PollEvents, (void)) \
  X(void, WaitEventsTimeout, (double)) \
  X(void, SetInputMode, (GLFWwindow *, int, int)) \
  X(int, GetWindowAttrib, (GLFWwindow *, int)) \
  X(int, GetKey, (GLFWwindow *, int)) \
  X(void, GetCursorPos, (GLFWwindow *, double *, double *)) \
  X(void, SetWindowTitle, (GLFWwindow *, const char *)) \
  X(void, GetFramebufferSize, (GLFWwindow *, int *, int *))

// A pointer to a function, as a member of that name.
#define GLFW_MEMBER(result, name, parameters) result(*name) parameters;

typedef struct glfw_api {
  GLFW_FUNCTIONS(GLFW_MEMBER)
} glfw_api;

struct view_window {
  glfw_api glfw;
  GLFWwindow *window;
  gl *g;
  int width, height;              // of the pictures
  GLuint texture, framebuffer;    // where a picture lies before it is shown
  int shown_width, shown_height;  // of the window when it was
  bool down[VIEW_KEY_COUNT];      // when somebody last asked
  double x, y;                    // of the mouse at that time
  bool caught;                    // the pointer has jumped to its cage
};

// A key by its number in GLFW.
typedef struct key_code {
  int code;
  view_key key;
} key_code;

static const key_code KEY_CODES[] = {
    {GLFW_KEY_W, VIEW_W},
    {GLFW_KEY_S, VIEW_S},
    {GLFW_KEY_A, VIEW_A},
    {GLFW_KEY_D, VIEW_D},
    {GLFW_KEY_Q, VIEW_Q},
    {GLFW_KEY_Z, VIEW_Z},
    {GLFW_KEY_UP, VIEW_UP},
    {GLFW_KEY_DOWN, VIEW_DOWN},
    {GLFW_KEY_LEFT, VIEW_LEFT},
    {GLFW_KEY_RIGHT, VIEW_RIGHT},
    {GLFW_KEY_LEFT_SHIFT, VIEW_SHIFT},
    {GLFW_KEY_RIGHT_SHIFT, VIEW_SHIFT},
    {GLFW_KEY_1, VIEW_1},
    {GLFW_KEY_2, VIEW_2},
    {GLFW_KEY_3, VIEW_3},
    {GLFW_KEY_4, VIEW_4},
    {GLFW_KEY_0, VIEW_0},
    {GLFW_KEY_SPACE, VIEW_SPACE},
    {GLFW_KEY_P, VIEW_P},
    {GLFW_KEY_F12, VIEW_F12},
    {GLFW_KEY_H, VIEW_H},
    {GLFW_KEY_ESCAPE, VIEW_ESC},
};

// Find one function, whatever its type: see put_function of chapter 5.
#define GLFW_FIND(result, name, parameters) \
  symbol = dlsym(library, "glfw" #name); \
  if (symbol == NULL) return fail(err, "GLFW: it has no glfw" #name); \
  memcpy(&api->name, &symbol, sizeof symbol);

static bool load_glfw(glfw_api *api, error *err) {
  void *library = gl_library_load(&GLFW_LIBRARY, err), *symbol;
  if (library == NULL) return false;
  GLFW_FUNCTIONS(GLFW_FIND)
  return true;
}

// Say what GLFW says.
static bool fail_glfw(const glfw_api *api, const char *what, error *err) {
  const char *why = NULL;
  api->GetError(&why);
  return fail(err, "%s: %s", what, why != NULL ? why : "GLFW does not say why");
}

static bool make_window(view_window *w, const char *title, error *err) {
  const glfw_api *api = &w->glfw;
  api->WindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  api->WindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  api->WindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  w->window = api->CreateWindow(w->width, w->height, title, NULL, NULL);
  if (w->window == NULL)
    return fail_glfw(api,
                     "no window with OpenGL 3.3 (on Debian: apt-get install "
                     "libgl1-mesa-dri)",
                     err);
  api->MakeContextCurrent(w->window);
  api->SwapInterval(1);
  // The pointer is caught, so that it can move for ever; a key that went down
  // and up between two questions still counts.
  api->SetInputMode(w->window, GLFW_CURSOR, GLFW_CURSOR_DISABLED);
  api->SetInputMode(w->window, GLFW_STICKY_KEYS, GLFW_TRUE);
  api->GetCursorPos(w->window, &w->x, &w->y);
  return true;
}

// The texture that takes the pictures, and a framebuffer to copy it from.
static void make_canvas(view_window *w) {
  const gl_api *api = gl_functions(w->g);
  w->texture =
      gl_texture_new(w->g, &(gl_texture_spec){.width = w->width,
                                              .height = w->height,
                                              .internal = GL_RGBA8,
                                              .format = GL_RGB,
                                              .type = GL_UNSIGNED_BYTE,
                                              .wrap_s = GL_CLAMP_TO_EDGE,
                                              .wrap_t = GL_CLAMP_TO_EDGE});
  api->GenFramebuffers(1, &w->framebuffer);
  api->BindFramebuffer(GL_READ_FRAMEBUFFER, w->framebuffer);
  api->FramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0,
                            GL_TEXTURE_2D, w->texture, 0);
  api->BindFramebuffer(GL_READ_FRAMEBUFFER, 0);
}

bool view_window_open(view_window **out, int width, int height,
                      const char *title, arena *mem, error *err) {
  view_window *w = ARENA_NEW(mem, view_window, 1);
  w->width = width;
  w->height = height;
  if (!load_glfw(&w->glfw, err)) return false;
  if (!w->glfw.Init())
    return fail_glfw(&w->glfw,
                     "no display to open a window on; --script FILE needs none",
                     err);
  if (!make_window(w, title, err) ||
      !gl_adopt(&w->g, w->glfw.GetProcAddress, mem, err)) {
    w->glfw.Terminate();
    return false;
  }
  make_canvas(w);
  *out = w;
  return true;
}

gl *view_window_gl(const view_window *w) {
  return w->g;
}

// The keys that are down now.
static void look_at_keys(const view_window *w, bool down[VIEW_KEY_COUNT]) {
  for (size_t i = 0; i < sizeof KEY_CODES / sizeof *KEY_CODES; i++)
    if (w->glfw.GetKey(w->window, KEY_CODES[i].code) == GLFW_PRESS)
      down[KEY_CODES[i].key] = true;
  if (w->glfw.WindowShouldClose(w->window)) down[VIEW_ESC] = true;
}

// How the mouse has moved.  The first motion after the window got the focus
// is none of the hand's: the pointer is put into the middle.
static view_event mouse_event(view_window *w) {
  double x, y;
  w->glfw.GetCursorPos(w->window, &x, &y);
  view_event e = {.kind = VIEW_EVENT_MOUSE,
                  .dx = (float)(x - w->x),
                  .dy = (float)(y - w->y)};
  w->x = x;
  w->y = y;
  bool moved = e.dx != 0 || e.dy != 0;
  if (moved && !w->caught) e.dx = e.dy = 0;
  bool focused = w->glfw.GetWindowAttrib(w->window, GLFW_FOCUSED);
  w->caught = focused && (w->caught || moved);
  return e;
}

// The picture in the texture, as large as fits into the window, in its middle.
static void present(view_window *w) {
  const gl_api *api = gl_functions(w->g);
  int width, height;
  w->glfw.GetFramebufferSize(w->window, &width, &height);
  w->shown_width = width, w->shown_height = height;
  long long across = (long long)width * w->height;
  long long down = (long long)height * w->width;
  int wide = across <= down ? width : (int)(down / w->height);
  int high = across <= down ? (int)(across / w->width) : height;
  int x = (width - wide) / 2, y = (height - high) / 2;
  api->BindFramebuffer(GL_READ_FRAMEBUFFER, w->framebuffer);
  api->BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  api->ClearColor(0, 0, 0, 1);
  api->Clear(GL_COLOR_BUFFER_BIT);
  // Row 0 is on top here and at the bottom there.
  api->BlitFramebuffer(0, 0, w->width, w->height, x, y + high, x + wide, y,
                       GL_COLOR_BUFFER_BIT, GL_LINEAR);
  w->glfw.SwapBuffers(w->window);
}

// A window of another size shows the last picture anew.
static void present_again(view_window *w) {
  int width, height;
  w->glfw.GetFramebufferSize(w->window, &width, &height);
  if (w->shown_width == 0) return;  // nothing was shown yet
  if (width != w->shown_width || height != w->shown_height) present(w);
}

size_t view_window_poll(view_window *w, double seconds,
                        view_event events[VIEW_WINDOW_EVENTS]) {
  if (seconds > 0)
    w->glfw.WaitEventsTimeout(seconds);
  else
    w->glfw.PollEvents();
  size_t n = 0;
  bool down[VIEW_KEY_COUNT] = {false};
  look_at_keys(w, down);
  for (int key = 0; key < VIEW_KEY_COUNT; key++) {
    if (down[key] != w->down[key])
      events[n++] = (view_event){
          .kind = VIEW_EVENT_KEY, .key = (view_key)key, .down = down[key]};
    w->down[key] = down[key];
  }
  present_again(w);
  view_event moved = mouse_event(w);
  if (moved.dx != 0 || moved.dy != 0) events[n++] = moved;
  return n;
}

void view_window_show(view_window *w, const unsigned char *rgb) {
  const gl_api *api = gl_functions(w->g);
  api->Disable(GL_SCISSOR_TEST);
  api->BindTexture(GL_TEXTURE_2D, w->texture);
  api->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  api->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, w->width, w->height, GL_RGB,
                     GL_UNSIGNED_BYTE, rgb);
  present(w);
}

void view_window_title(view_window *w, const char *title) {
  w->glfw.SetWindowTitle(w->window, title);
}

void view_window_close(view_window *w) {
  if (w == NULL) return;
  w->glfw.DestroyWindow(w->window);
  w->glfw.Terminate();
}

// view_state.h — what the viewer knows: where the camera flies, which keys are
// down, what is switched on.  No window, no clock, no OpenGL.

#ifndef VIEW_STATE_H
#define VIEW_STATE_H

#include "camera.h"
#include "material.h"

// The keys that mean something.
typedef enum view_key {
  VIEW_W,
  VIEW_S,
  VIEW_A,
  VIEW_D,
  VIEW_Q,
  VIEW_Z,
  VIEW_UP,
  VIEW_DOWN,
  VIEW_LEFT,
  VIEW_RIGHT,
  VIEW_SHIFT,
  VIEW_1,
  VIEW_2,
  VIEW_3,
  VIEW_4,
  VIEW_0,
  VIEW_SPACE,
  VIEW_P,
  VIEW_F12,
  VIEW_H,
  VIEW_ESC,
  VIEW_KEY_COUNT
} view_key;

// A key as scripts and people call it.
typedef struct view_key_name {
  const char *name;     // "w"
  const char *meaning;  // "forward"
} view_key_name;

extern const view_key_name VIEW_KEYS[VIEW_KEY_COUNT];

// What a picture depends on, beside scene and film.
typedef struct view_look {
  camera camera;
  int metallic, roughness;  // steps of VIEW_STEP, on metal-rough materials
  bool only_rough;          // the others are hidden
} view_look;

// What a step of key 1 to 4 adds or takes.
#define VIEW_STEP 0.1f

typedef struct view_state {
  view_look look;
  bool frosted;  // behind a pane of frosted glass
  bool paths;    // by the path tracer
  bool leaving;
  bool print, save, help;  // asked for; whoever does it sets them to false
  bool has_rough;          // some material is metal-rough
  bool held[VIEW_KEY_COUNT];
  vec3 up, ahead, side;  // the frame of flight; ahead and side are level
  float heading, tilt;   // in turns: to the right of ahead, and up
  float tilt_limit;
  float distance;  // from eye to target
  float speed;     // world units a second
} view_state;

// Start at a valid camera in a scene of these bounds.
view_state view_start(const camera *c, vec3 lo, vec3 hi, bool has_rough);

// A key goes down or up.  A key that repeats goes down again.
void view_press(view_state *s, view_key key, bool down);

// The mouse moves by so many pixels to the right and down: the camera turns.
void view_turn(view_state *s, float dx, float dy);

// Fly for so many seconds as the keys are held.
void view_fly(view_state *s, double seconds);

bool view_same_look(const view_look *a, const view_look *b);

// The materials as they look: n of base, changed into out.
void view_materials(material *out, const material *base, size_t n,
                    const view_look *look);

#endif

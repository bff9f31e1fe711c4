// view_state.c

#include "view_state.h"

#include "num.h"

#include <string.h>

const view_key_name VIEW_KEYS[VIEW_KEY_COUNT] = {
    [VIEW_W] = {"w", "forward"},
    [VIEW_S] = {"s", "back"},
    [VIEW_A] = {"a", "left"},
    [VIEW_D] = {"d", "right"},
    [VIEW_Q] = {"q", "up"},
    [VIEW_Z] = {"z", "down"},
    [VIEW_UP] = {"up", "forward"},
    [VIEW_DOWN] = {"down", "back"},
    [VIEW_LEFT] = {"left", "left"},
    [VIEW_RIGHT] = {"right", "right"},
    [VIEW_SHIFT] = {"shift", "frosted glass on and off"},
    [VIEW_1] = {"1", "less metallic"},
    [VIEW_2] = {"2", "more metallic"},
    [VIEW_3] = {"3", "less rough"},
    [VIEW_4] = {"4", "rougher"},
    [VIEW_0] = {"0", "only what is metal-rough, and all again"},
    [VIEW_SPACE] = {"space", "path tracer on and off"},
    [VIEW_P] = {"p", "print the command that renders this view"},
    [VIEW_F12] = {"f12", "save a PNG"},
    [VIEW_H] = {"h", "print the keys"},
    [VIEW_ESC] = {"esc", "leave"},
};

// Seconds to fly along the diagonal of the scene's box, or to the camera's
// target where that is nearer: a ground that goes on for ever says little.
#define CROSSING_SECONDS 5.0f

// Turns of the camera for a pixel of the mouse: 0.15 degrees.
#define TURNS_PER_PIXEL (0.15f / 360)

// The camera stays this far, in turns, from looking straight up: there a
// heading means nothing.
#define TILT_LIMIT 0.24f

// The most steps that make a difference: from 0 to 1.
enum { MAX_STEPS = 10 };

// A unit vector at right angles to unit u.
static vec3 level_to(vec3 u) {
  vec3 other = fabsf(u.x) < 0.6f ? (vec3){1, 0, 0} : (vec3){0, 1, 0};
  return vec3_unit(vec3_cross(u, other));
}

view_state view_start(const camera *c, vec3 lo, vec3 hi, bool has_rough) {
  view_state s = {.look.camera = *c, .has_rough = has_rough};
  vec3 to_target = vec3_sub(c->target, c->eye);
  vec3 forward = vec3_unit(to_target);
  s.distance = vec3_length(to_target);
  s.up = vec3_unit(c->up);
  float sine = vec3_dot(forward, s.up);
  vec3 level = vec3_mad(forward, -sine, s.up);
  s.ahead = vec3_length(level) > 0 ? vec3_unit(level) : level_to(s.up);
  s.side = vec3_cross(s.ahead, s.up);
  s.tilt = num_turns(sine, vec3_length(level));
  if (s.tilt > 0.5f) s.tilt -= 1;
  s.tilt_limit = fmaxf(TILT_LIMIT, fabsf(s.tilt));
  float size = vec3_length(vec3_sub(hi, lo));
  bool sized = hi.x >= lo.x && size > 0 && isfinite(size);
  s.speed = (sized ? fminf(size, s.distance) : s.distance) / CROSSING_SECONDS;
  return s;
}

// The unit vector along which the camera looks.
static vec3 view_forward(const view_state *s) {
  vec2 h = num_circle(s->heading);
  vec2 t = num_circle(s->tilt < 0 ? s->tilt + 1 : s->tilt);
  vec3 level = vec3_mad(vec3_scale(s->ahead, h.x), h.y, s->side);
  return vec3_mad(vec3_scale(level, t.x), t.y, s->up);
}

// The camera looks along the angles again from where it is.
static void aim(view_state *s) {
  camera *c = &s->look.camera;
  c->target = vec3_mad(c->eye, s->distance, view_forward(s));
}

static float limited(float x, float low, float high) {
  return fminf(fmaxf(x, low), high);
}

void view_turn(view_state *s, float dx, float dy) {
  if (dx == 0 && dy == 0) return;
  float h = s->heading + dx * TURNS_PER_PIXEL;
  h -= floorf(h);
  s->heading = h < 1 ? h : 0;
  s->tilt =
      limited(s->tilt - dy * TURNS_PER_PIXEL, -s->tilt_limit, s->tilt_limit);
  aim(s);
}

// 1, 0 or -1: which of two opposite ways the keys say, each of two keys.
static float way_of(const view_state *s, view_key to, view_key to_also,
                    view_key fro, view_key fro_also) {
  bool a = s->held[to] || s->held[to_also];
  bool b = s->held[fro] || s->held[fro_also];
  return (float)a - (float)b;
}

void view_fly(view_state *s, double seconds) {
  float ahead = way_of(s, VIEW_W, VIEW_UP, VIEW_S, VIEW_DOWN);
  float right = way_of(s, VIEW_D, VIEW_RIGHT, VIEW_A, VIEW_LEFT);
  float rise = way_of(s, VIEW_Q, VIEW_Q, VIEW_Z, VIEW_Z);
  if (ahead == 0 && right == 0 && rise == 0) return;
  vec3 forward = view_forward(s);
  vec3 side = vec3_unit(vec3_cross(forward, s->up));
  vec3 way = vec3_scale(forward, ahead);
  way = vec3_mad(vec3_mad(way, right, side), rise, s->up);
  float length = s->speed * (float)seconds;
  vec3 step = vec3_scale(vec3_unit(way), length);
  camera *c = &s->look.camera;
  c->eye = vec3_add(c->eye, step);
  c->target = vec3_add(c->target, step);
}

// One step more or less, within what makes a difference.
static int stepped(int steps, int by) {
  steps += by;
  return steps > MAX_STEPS    ? MAX_STEPS
         : steps < -MAX_STEPS ? -MAX_STEPS
                              : steps;
}

void view_press(view_state *s, view_key key, bool down) {
  bool again = down && s->held[key];
  s->held[key] = down;
  if (!down) return;
  switch (key) {
  case VIEW_1: s->look.metallic = stepped(s->look.metallic, -1); return;
  case VIEW_2: s->look.metallic = stepped(s->look.metallic, 1); return;
  case VIEW_3: s->look.roughness = stepped(s->look.roughness, -1); return;
  case VIEW_4: s->look.roughness = stepped(s->look.roughness, 1); return;
  default: break;
  }
  if (again) return;  // a switch that is held down does not flicker
  switch (key) {
  case VIEW_SHIFT: s->frosted = !s->frosted; return;
  case VIEW_SPACE: s->paths = !s->paths; return;
  case VIEW_0: s->look.only_rough = s->has_rough && !s->look.only_rough; return;
  case VIEW_P: s->print = true; return;
  case VIEW_F12: s->save = true; return;
  case VIEW_H: s->help = true; return;
  case VIEW_ESC: s->leaving = true; return;
  default: return;
  }
}

static bool same_point(vec3 a, vec3 b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

bool view_same_look(const view_look *a, const view_look *b) {
  const camera *c = &a->camera, *d = &b->camera;
  return same_point(c->eye, d->eye) && same_point(c->target, d->target) &&
         same_point(c->up, d->up) && c->fov_deg == d->fov_deg &&
         a->metallic == b->metallic && a->roughness == b->roughness &&
         a->only_rough == b->only_rough;
}

void view_materials(material *out, const material *base, size_t n,
                    const view_look *look) {
  memcpy(out, base, n * sizeof *out);
  for (size_t i = 0; i < n; i++) {
    if (out[i].kind != MATERIAL_METAL_ROUGH) continue;
    float metallic = out[i].metallic + VIEW_STEP * (float)look->metallic;
    float roughness = out[i].roughness + VIEW_STEP * (float)look->roughness;
    out[i].metallic = limited(metallic, 0, 1);
    out[i].roughness = limited(roughness, 0, 1);
  }
}

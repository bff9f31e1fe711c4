// cmd_shot.c

#include "cmd_shot.h"

#include "plan.h"
#include "text.h"

#include <math.h>
#include <string.h>

// Specular exponent to roughness: the exponent whose lobe is as wide as that
// of a microfacet distribution with alpha = roughness^2.  Source: Walter et
// al., "Microfacet Models for Refraction", 2007: Ns = 2 / alpha^2 - 2.
static float roughness_of_exponent(float ns) {
  return sqrtf(sqrtf(2 / (fmaxf(ns, 0) + 2)));
}

// --shading blinn-phong or pbr: every material by that one model.
static void force_model(shot *s) {
  unsigned shading = s->o->value[OPT_SHADING].words;
  if (shading != 1 && shading != 2) return;
  for (size_t i = 0; i < s->scene.material_count; i++) {
    material *m = &s->scene.materials[i];
    bool rough = m->kind == MATERIAL_METAL_ROUGH;
    if (shading == 2 && !rough) {
      bool mirror = m->kind == MATERIAL_MIRROR;
      m->roughness = mirror ? 0 : roughness_of_exponent(m->ns);
      m->metallic = mirror ? 1 : 0;
      if (mirror) m->kd = m->ks;
    }
    m->kind = shading == 1 ? MATERIAL_BLINN_PHONG : MATERIAL_METAL_ROUGH;
  }
}

// Say what is wrong with the input, and what was noticed before.
static int refuse_input(const shot *s, const error *err) {
  cmd_remarks(s->o, &s->remarks);
  return cmd_fail(s->o, EXIT_INPUT, "%s", err->text);
}

// Normals as they are asked for; none where no pixel shows them.
static normals_mode choose_normals(const option_value *v) {
  static const render_shading shadings[] = {RENDER_RADIANCE, RENDER_RADIANCE,
                                            RENDER_RADIANCE, RENDER_NORMAL,
                                            RENDER_DEPTH,    RENDER_ALBEDO};
  render_shading shown = shadings[v[OPT_SHADING].words];
  if (v[OPT_NO_SKIP].given || plan_shows_normals(shown, v[OPT_AOV].words))
    return (normals_mode)v[OPT_NORMALS].words;
  return NORMALS_FLAT;
}

int shot_open(shot *s) {
  const option_value *v = s->o->value;
  const char *path = s->o->operands[0];
  scene_options so = {
      .normals = choose_normals(v),
      .crease_deg = v[OPT_CREASE].number[0],
      .no_name_rules = v[OPT_NO_NAME_RULES].given,
      .allow_outside = v[OPT_ALLOW_OUTSIDE].given,
      .up_z = v[OPT_UP_AXIS].words == 1,
      .skip_textures = true,
      .env = v[OPT_ENV].text,
  };
  if (v[OPT_ENV_ROTATE].given) so.env_rotate_deg = v[OPT_ENV_ROTATE].number;
  if (v[OPT_ENV_SCALE].given) so.env_scale = v[OPT_ENV_SCALE].number;
  error err;
  bool ok =
      scene_load(&s->scene, path, &so, s->mem, s->threads, &s->remarks, &err);
  if (ok && s->scene.mesh.triangle_count == 0 &&
      !cmd_has_suffix(path, ".scene"))
    ok = fail(&err, "%s: nothing to render, it has no faces", path);
  if (!ok) return refuse_input(s, &err);
  force_model(s);
  return EXIT_DONE;
}

int shot_decode(shot *s, const unsigned *wanted, bool environment) {
  error err;
  bool ok =
      scene_decode(&s->scene, wanted, environment, s->mem, &s->remarks, &err);
  return ok ? EXIT_DONE : refuse_input(s, &err);
}

int shot_read(shot *s) {
  int code = shot_open(s);
  return code == EXIT_DONE ? shot_decode(s, NULL, true) : code;
}

int shot_remark(const shot *s) {
  cmd_remarks(s->o, &s->remarks);
  if (!s->o->value[OPT_STRICT].given || s->remarks.warnings == 0)
    return EXIT_DONE;
  return cmd_fail(s->o, EXIT_NO, "%d warnings, and --strict",
                  s->remarks.warnings);
}

// Width and height: the flag, the scene's film line, the default.
static void choose_size(shot *s) {
  const option_value *v = &s->o->value[OPT_RESOLUTION];
  bool given = !v->given && s->scene.film_width > 0;
  s->width = given ? s->scene.film_width : (int)v->whole[0];
  s->height = given ? s->scene.film_height : (int)v->whole[1];
}

// --crop, checked against the size; an exit code.
static int choose_crop(shot *s) {
  const option_value *v = &s->o->value[OPT_CROP];
  if (!v->given) return EXIT_DONE;
  const long long *box = v->whole;
  if (box[0] >= box[2] || box[1] >= box[3] || box[2] > s->width ||
      box[3] > s->height)
    return cmd_fail(s->o, EXIT_USAGE,
                    "--crop %s: needs X0 < X1 <= %d and Y0 < Y1 <= %d", v->text,
                    s->width, s->height);
  s->x0 = (int)box[0], s->y0 = (int)box[1];
  s->x1 = (int)box[2], s->y1 = (int)box[3];
  return EXIT_DONE;
}

// There is no camera of that name: name the nearest.
static int unknown_camera(const shot *s, const char *name) {
  const scene *sc = &s->scene;
  const char **list = ARENA_NEW(s->mem, const char *, sc->camera_count + 1);
  size_t n = 0;
  for (size_t i = 0; i < sc->camera_count; i++)
    if (sc->cameras[i].name != NULL) list[n++] = sc->cameras[i].name;
  const char *near = text_nearest((span){name, strlen(name)}, list);
  return cmd_fail(s->o, EXIT_USAGE,
                  "--camera %s: the scene has none of that "
                  "name%s%s",
                  name, near ? "; the nearest is " : "", near ? near : "");
}

// The three numbers of an option, if it is given.
static void take_triple(vec3 *out, const shot *s, option_id id) {
  const option_value *v = &s->o->value[id];
  if (v->given) *out = (vec3){v->number[0], v->number[1], v->number[2]};
}

// No camera can see all of it from a place that is a float.
static int too_far(const shot *s) {
  error err;
  vec3 lo = s->scene.lo, hi = s->scene.hi;
  fail(&err,
       "%s: too large to be seen whole, from %g %g %g to %g %g %g; expected "
       "coordinates well below 1e37, or a camera",
       s->o->operands[0], (double)lo.x, (double)lo.y, (double)lo.z,
       (double)hi.x, (double)hi.y, (double)hi.z);
  return refuse_input(s, &err);
}

// The camera: named, first or framed, then changed by the flags.
static int choose_camera(shot *s) {
  const option_value *v = s->o->value;
  const char *name = v[OPT_CAMERA].text;
  const camera *found = scene_camera(&s->scene, name);
  if (name != NULL && found == NULL) return unknown_camera(s, name);
  float aspect = (float)s->width / (float)s->height;
  s->camera = found ? *found : camera_framing(s->scene.lo, s->scene.hi, aspect);
  take_triple(&s->camera.eye, s, OPT_EYE);
  take_triple(&s->camera.target, s, OPT_TARGET);
  take_triple(&s->camera.up, s, OPT_UP);
  if (v[OPT_FOV].given) s->camera.fov_deg = v[OPT_FOV].number[0];
  error err;
  if (camera_view_of(&s->view, &s->camera, s->width, s->height, &err))
    return EXIT_DONE;
  bool by_flag = v[OPT_EYE].given || v[OPT_TARGET].given || v[OPT_UP].given ||
                 v[OPT_FOV].given;
  if (!found && !vec3_finite(s->camera.eye) && !v[OPT_EYE].given)
    return too_far(s);
  return cmd_fail(s->o, by_flag ? EXIT_USAGE : EXIT_INPUT, "%s", err.text);
}

int shot_frame(shot *s) {
  choose_size(s);
  int code = choose_crop(s);
  return code == EXIT_DONE ? choose_camera(s) : code;
}

int shot_resize(shot *s, int width, int height) {
  s->width = width;
  s->height = height;
  s->x0 = s->y0 = s->x1 = s->y1 = 0;
  return choose_camera(s);
}

// plan.c — the plan of a picture: a line for each stage, in the order of work.

#include "plan.h"

#include "raster_env.h"
#include "vertex.h"

#include <string.h>

// The shadow maps of a point light, and of a directional one.
enum { POINT_LAYERS = 6, DIR_LAYERS = 1 };

bool plan_needs(const plan *p, plan_stage stage) {
  return p->line[stage].need > 0;
}

void plan_note(plan *p, plan_stage stage, uint64_t did, double seconds,
               double bytes) {
  plan_line *l = &p->line[stage];
  if (!l->told) return;
  l->counted = true;
  l->did = did;
  l->seconds = seconds;
  l->bytes = bytes;
}

// A line that --no-skip does not touch.
static void tell_as_is(plan *p, plan_stage stage, uint64_t need, uint64_t all,
                       const char *why) {
  p->line[stage] = (plan_line){
      .told = true, .need = need, .all = all, .why = why, .seconds = -1};
}

static void tell(plan *p, plan_stage stage, uint64_t need, uint64_t all,
                 const char *why) {
  bool forced = p->of.no_skip && need < all;
  tell_as_is(p, stage, forced ? all : need, all, forced ? "--no-skip" : why);
}

bool plan_shows_normals(render_shading shading, unsigned aovs) {
  return shading == RENDER_RADIANCE || shading == RENDER_NORMAL ||
         (aovs & RENDER_AOV_NORMAL) != 0;
}

static bool shows_light(const plan *p) {
  return p->of.shading == RENDER_RADIANCE;
}

// Whether a material has a say in the picture.
static bool in_view(const plan *p, size_t i) {
  return p->of.path || !p->sight.unseen[i];
}

// Whether some material with a say is of that kind.
static bool has_kind(const plan *p, material_kind kind) {
  const scene *s = p->of.scene;
  for (size_t i = 0; i < s->material_count; i++)
    if (s->materials[i].kind == kind && in_view(p, i)) return true;
  return false;
}

// Whether a material scatters the light of a lamp: what is not black and is
// neither a mirror nor glass.  A scene without materials is grey.
static bool answers(const plan *p) {
  const scene *s = p->of.scene;
  for (size_t i = 0; i < s->material_count; i++) {
    const material *m = &s->materials[i];
    if (!in_view(p, i)) continue;
    if (m->kind == MATERIAL_METAL_ROUGH) return true;
    bool black = !(vec3_peak(m->kd) > 0 || vec3_peak(m->ks) > 0);
    if (m->kind == MATERIAL_BLINN_PHONG && !black) return true;
  }
  return s->material_count == 0;
}

static bool glows(const plan *p) {
  const scene *s = p->of.scene;
  for (size_t i = 0; i < s->material_count; i++)
    if (vec3_peak(s->materials[i].ke) > 0) return true;
  return false;
}

// The textures of material i that are looked at.
static unsigned maps_of(const plan *p, size_t i) {
  enum { KD = 1, KS = 2, D = 16, NORMALS = 128 | 256 };
  const material *m = &p->of.scene->materials[i];
  unsigned reads = material_reads(m, m->kind);
  bool casts = shows_light(p) && plan_needs(p, PLAN_SHADOW_MAPS);
  if (!in_view(p, i)) return casts ? reads & D : 0;
  if (shows_light(p)) return reads;
  unsigned wanted = 0;
  if (plan_shows_normals(p->of.shading, p->of.aovs)) wanted |= NORMALS;
  bool color =
      p->of.shading == RENDER_ALBEDO || (p->of.aovs & RENDER_AOV_ALBEDO) != 0;
  if (color) wanted |= KD | KS;
  return reads & wanted;
}

// Whether some material looks at the texture at that path.
static bool is_wanted(const plan *p, const char *path) {
  const scene *s = p->of.scene;
  for (size_t i = 0; i < s->material_count; i++)
    for (int k = 0; k < MATERIAL_MAPS; k++) {
      const char *found = material_map(&s->materials[i], k)->found;
      if ((p->maps[i] >> k & 1) != 0 && found != NULL &&
          strcmp(found, path) == 0)
        return true;
    }
  return false;
}

static void plan_textures(plan *p, arena *mem) {
  const scene *s = p->of.scene;
  p->maps = ARENA_NEW(mem, unsigned, s->material_count);
  for (size_t i = 0; i < s->material_count; i++)
    p->maps[i] = p->of.no_skip ? ~0u : maps_of(p, i);
  uint64_t need = 0, all = 0;
  for (size_t i = 0; i < s->textures.count; i++) {
    const texture *t = s->textures.textures[i];
    if (t->problem != NULL) continue;
    all++;
    need += is_wanted(p, t->path);
  }
  tell(p, PLAN_TEXTURES, need, all,
       all == 0      ? "the scene has none"
       : need == all ? "surfaces look at all of them"
       : need == 0   ? "no surface in the picture looks at one"
                     : "what surfaces in the picture look at");
}

static void plan_env_map(plan *p) {
  const env *e = &p->of.scene->env;
  bool constant = e->kind == ENV_CONSTANT && !(vec3_peak(e->constant) > 0);
  p->black = e->kind == ENV_NONE || constant || !(e->scale > 0);
  bool map = e->kind == ENV_MAP, seen = shows_light(p) && !p->black;
  tell(p, PLAN_ENV_MAP, map && seen, map,
       !map              ? "it is no file"
       : !shows_light(p) ? "the picture shows no light"
       : p->black        ? "scaled to nothing"
                         : "it lights the scene");
}

// Statements that name a texture, and those of them that are looked at.
static uint64_t count_maps(const plan *p, uint64_t *all) {
  uint64_t need = 0;
  *all = 0;
  for (size_t i = 0; i < p->of.scene->material_count; i++)
    for (int k = 0; k < MATERIAL_MAPS; k++) {
      bool found = material_map(&p->of.scene->materials[i], k)->found != NULL;
      *all += found;
      need += found && (p->maps[i] >> k & 1) != 0;
    }
  return need;
}

static void plan_geometry(plan *p) {
  const mesh *m = &p->of.scene->mesh;
  uint64_t all, read = count_maps(p, &all);
  if (!p->of.path) {
    tell(p, PLAN_MAPS, read, all, "each that is looked at, once");
    p->line[PLAN_MAPS].at_most = true;
  }
  uint64_t uv = m->texcoord_index != NULL ? m->texcoord_count : 0;
  tell(p, PLAN_TEXCOORDS, read > 0 ? uv : 0, uv,
       uv == 0    ? "the mesh has none"
       : read > 0 ? "for the textures"
                  : "no texture is looked at");
  uint64_t kept = m->normal_index != NULL ? m->normal_count : 0;
  bool reads = plan_shows_normals(p->of.shading, p->of.aovs);
  tell_as_is(p, PLAN_NORMALS, kept, m->normal_count,
             kept > 0 ? "surfaces are smooth"
             : reads  ? "the mesh is flat"
                      : "the picture shows no normal");
}

static void plan_lamps(plan *p, arena *mem) {
  const scene *s = p->of.scene;
  bool on = p->of.lights && shows_light(p), lit = answers(p);
  uint64_t layers = 0, all_layers = 0;
  p->lamps = ARENA_NEW(mem, light, s->light_count);
  for (size_t i = 0; i < s->light_count && on; i++) {
    light l = s->lights[i];
    uint64_t own = l.kind == LIGHT_POINT ? POINT_LAYERS : DIR_LAYERS;
    bool dark = l.power.x == 0 && l.power.y == 0 && l.power.z == 0;
    all_layers += own;
    if (!p->of.no_skip && (dark || !lit)) continue;
    layers += own;
    p->lamps[p->lamp_count++] = l;
  }
  bool some = p->lamp_count < s->light_count;
  const char *why = s->light_count == 0 ? "the scene has none"
                    : !shows_light(p)   ? "the picture shows no light"
                    : !on               ? "--lights off"
                    : !lit ? "no surface in the picture scatters their light"
                    : some ? "the others give no light"
                           : "surfaces scatter their light";
  tell_as_is(p, PLAN_LAMPS, p->lamp_count, s->light_count,
             p->of.no_skip && on ? "--no-skip" : why);
  if (p->of.path) return;
  bool cast = p->of.shadows;
  tell_as_is(p, PLAN_SHADOW_MAPS, cast ? layers : 0, cast ? all_layers : 0,
             !cast        ? "--shadows off"
             : layers > 0 ? "those with something that casts a shadow"
                          : why);
  p->line[PLAN_SHADOW_MAPS].at_most = !p->of.no_skip;
}

static void plan_seen(plan *p, arena *mem) {
  const plan_request *r = &p->of;
  p->sight = plan_sight_of(r->scene, &r->view, r->window, r->no_skip, mem);
  const plan_sight *v = &p->sight;
  tell_as_is(p, PLAN_TRIANGLES, v->triangles, r->scene->mesh.triangle_count,
             v->edges > 0 ? "two corners of the others are one"
                          : "all of them");
  tell_as_is(p, PLAN_DRAW_LIST, v->in_view, v->triangles,
             r->no_skip                  ? "--no-skip"
             : v->in_view < v->triangles ? "the others lie outside the view"
                                         : "all may be in view");
}

// Whether pixels can be shaded once: no textures and nothing to look through.
static void plan_visibility(plan *p) {
  const scene *s = p->of.scene;
  bool maps = false, shown = shows_light(p);
  for (size_t i = 0; i < s->material_count; i++)
    for (int k = 0; k < MATERIAL_MAPS; k++) {
      material *m = &s->materials[i];
      const texture_map *map = material_map(m, k);
      maps |= (material_reads(m, m->kind) >> k & 1) != 0 &&
              (map->found != NULL || map->image != NULL);
    }
  bool sheets = scene_has_sheets(p->of.scene);
  bool once = shown && !p->of.each && !maps && !sheets;
  tell_as_is(p, PLAN_VISIBILITY, once, 1,
             once         ? "each pixel is shaded once for what it sees"
             : !shown     ? "there is nothing to shade"
             : p->of.each ? "--shade triangles"
             : maps       ? "textures want neighbouring pixels"
                          : "light passes some surfaces");
  p->line[PLAN_VISIBILITY].at_most = true;
  bool many = p->of.msaa > 1;
  tell_as_is(p, PLAN_RESOLVE, many && !once, many,
             !many  ? "one sample a pixel"
             : once ? "samples are added as they are shaded"
                    : "samples become pixels");
}

static void plan_kinds(plan *p) {
  uint64_t kinds = p->of.scene->material_count == 0;
  for (int k = MATERIAL_BLINN_PHONG; k <= MATERIAL_GLASS; k++)
    kinds += has_kind(p, (material_kind)k);
  tell(p, PLAN_KINDS, kinds, 4, "what surfaces in view are");
  const scene *s = p->of.scene;
  bool sky = shows_light(p) && s->env.kind != ENV_NONE;
  tell(p, PLAN_SKY, sky && !p->black, sky,
       !shows_light(p) ? "the picture shows no light"
       : p->black      ? "it is black"
                       : "behind everything");
  vec3 e = p->of.view.eye;
  bool inside = vec3_min(e, s->lo).x == s->lo.x &&
                vec3_max(e, s->hi).x == s->hi.x && e.y >= s->lo.y &&
                e.y <= s->hi.y && e.z >= s->lo.z && e.z <= s->hi.z;
  // To ask costs as much as a sky that is a formula.
  if (!inside || s->env.kind != ENV_MAP) return;
  if (p->of.no_skip || !plan_needs(p, PLAN_SKY)) return;
  p->line[PLAN_SKY].at_most = true;
  p->line[PLAN_SKY].why = "unless surfaces cover it";
}

// Light from the environment, and the tables of metallic-roughness.
static void plan_sums(plan *p, arena *mem) {
  const plan_request *r = &p->of;
  env_kind kind = r->scene->env.kind;
  bool varies = (kind == ENV_SKY || kind == ENV_MAP) && !p->black;
  bool rough = has_kind(p, MATERIAL_METAL_ROUGH), shown = shows_light(p);
  bool dull = rough || has_kind(p, MATERIAL_BLINN_PHONG) ||
              r->scene->material_count == 0;
  tell(p, PLAN_TABLE, rough && shown, 1,
       !rough  ? "nothing metal-rough is in the picture"
       : shown ? "for the roughness of metal-rough surfaces"
               : "the picture shows no light");
  if (r->path) return;
  ibl_need every = {.all = true};
  ibl_need need =
      raster_env_need(r->scene, r->model, false, p->sight.unseen, mem);
  uint64_t all = 1 + (uint64_t)ibl_levels_of(&every), some = 0;
  if (varies && dull && shown) some = 1 + (uint64_t)ibl_levels_of(&need);
  tell(p, PLAN_IBL, some, kind == ENV_NONE ? 0 : all,
       !shown     ? "the picture shows no light"
       : !varies  ? "the same from everywhere: no sum is needed"
       : !dull    ? "mirrors and glass see the sky itself"
       : need.all ? "irradiance, and every level: roughness is a texture"
                  : "irradiance, and the roughness levels in use");
  bool lean = rough && shown && varies && r->model == PBR_GGX && !r->split;
  tell(p, PLAN_LEAN, lean, 1,
       lean ? "metal-rough under an environment" : "no rough lobe meets a sky");
}

static void plan_lights_of_paths(plan *p) {
  const plan_request *r = &p->of;
  env_kind kind = r->scene->env.kind;
  bool shown = shows_light(p), glow = glows(p);
  bool varies = (kind == ENV_SKY || kind == ENV_MAP) && !p->black && shown;
  uint64_t tables = varies && !r->naive ? 1 + r->learns : 0;
  tell(p, PLAN_ENV_TABLE, tables, tables > 1 ? tables : kind != ENV_NONE,
       !shown     ? "the picture shows no light"
       : r->naive ? "--integrator naive looks for no light"
       : varies   ? "bright directions; and all, where paths remember"
                  : "nothing is brighter than the mean");
  p->line[PLAN_ENV_TABLE].at_most = true;
  bool any = shown && (glow || p->lamp_count > 0 || varies);
  bool asks = any && !r->naive;
  tell(p, PLAN_ASK, asks ? PLAN_ANY : 0, PLAN_ANY,
       r->naive ? "--integrator naive asks for none"
       : asks   ? "at every surface that is no mirror"
                : "there is no light to ask for");
  tell(p, PLAN_SHADOW_RAY, asks ? PLAN_ANY : 0, PLAN_ANY,
       asks ? "for light samples that bring something" : "nothing was asked");
  bool glass = has_kind(p, MATERIAL_MIRROR) || has_kind(p, MATERIAL_GLASS);
  bool ends = asks && (glow || varies), sheets = scene_has_sheets(r->scene);
  tell(p, PLAN_AIM, glass && ends ? PLAN_ANY : 0, PLAN_ANY,
       !glass ? "no surface is a mirror or glass"
       : ends ? "where that takes noise away"
              : "no lamp is looked for in mirrors and glass");
  tell(p, PLAN_ALPHA, sheets && any ? PLAN_ANY : 0, PLAN_ANY,
       sheets ? "some surfaces let light through" : "every surface is opaque");
}

static void plan_walks(plan *p) {
  const plan_request *r = &p->of;
  bool shown = shows_light(p), found = !p->black || glows(p);
  bool dark = !found && p->lamp_count == 0;
  uint64_t all = !shown ? 0 : r->samples > 0 ? r->samples : PLAN_ANY;
  tell(p, PLAN_PATHS, shown && !dark ? all : 0, all,
       !shown ? "the picture shows no light"
       : dark ? "nothing gives light"
              : "every sample");
  p->lamps_only = !found && r->max_depth > 1 && !r->no_skip;
  uint64_t most = (uint64_t)r->max_depth;
  tell_as_is(p, PLAN_SEGMENTS, most - p->lamps_only, most,
             most == 0       ? "paths end by roulette"
             : p->lamps_only ? "the last one would find no light"
             : r->no_skip    ? "--no-skip"
                             : "the last one may find light");
  bool chains = shown && !dark && (most == 0 || (most > 2 && found));
  tell_as_is(p, PLAN_SHARE, chains ? PLAN_ANY : 0, PLAN_ANY,
             chains ? "where that takes noise away" : "paths are too short");
}

static uint64_t bits_of(unsigned word) {
  return (uint64_t)__builtin_popcount(word);
}

static void plan_output(plan *p) {
  const plan_request *r = &p->of;
  unsigned firsts = RENDER_AOV_NORMAL | RENDER_AOV_DEPTH | RENDER_AOV_ALBEDO;
  uint64_t films = bits_of(r->aovs & firsts);
  tell(p, PLAN_FILMS, films, 3, films > 0 ? "--aov" : "nobody asked for one");
  uint64_t area = (uint64_t)(r->window[2] - r->window[0]) *
                  (uint64_t)(r->window[3] - r->window[1]);
  uint64_t whole = (uint64_t)r->width * (uint64_t)r->height;
  tell_as_is(p, PLAN_PIXELS, area, whole,
             area < whole ? "--crop" : "the whole film");
  tell(p, PLAN_POST, r->frosted, 1, r->frosted ? "--post" : "no --post");
  if (!r->path) return;
  bool variance = (r->aovs & RENDER_AOV_VARIANCE) != 0;
  tell(p, PLAN_SQUARES, variance || r->kept, 1,
       variance  ? "--aov variance"
       : r->kept ? "kept for another run"
                 : "nobody asked for the variance");
  tell(p, PLAN_ESTIMATE, r->estimate || r->kept, 1,
       r->estimate ? "somebody hears of it"
       : r->kept   ? "perhaps by another run"
                   : "nobody hears of it");
  p->line[PLAN_ESTIMATE].at_most = r->kept;
}

plan plan_make(const plan_request *r, arena *mem) {
  plan p = {.of = *r};
  if (!r->path) plan_seen(&p, mem);
  plan_env_map(&p);
  plan_lamps(&p, mem);
  plan_textures(&p, mem);
  plan_geometry(&p);
  plan_sums(&p, mem);
  if (r->path) {
    uint64_t n = r->scene->mesh.triangle_count;
    tell_as_is(&p, PLAN_TRIANGLES, n, n, "but for those without area");
    p.line[PLAN_TRIANGLES].at_most = true;
    tell_as_is(&p, PLAN_TREE, 1, 1, "rays ask it");
    plan_lights_of_paths(&p);
    plan_walks(&p);
  } else {
    plan_visibility(&p);
    plan_kinds(&p);
    tell(&p, PLAN_TREE, 0, 1, "no rays");
  }
  plan_output(&p);
  return p;
}

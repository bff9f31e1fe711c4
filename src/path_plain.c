// path_plain.c

#include "path_plain.h"

static plain_kind kind_of(const material *m) {
  if (m->map_kd.image != NULL || m->map_ks.image != NULL ||
      m->map_bump.image != NULL || m->map_norm.image != NULL)
    return PLAIN_NOT;
  if (m->passes || vec3_peak(m->ke) > 0) return PLAIN_NOT;
  if (m->kind == MATERIAL_MIRROR) return PLAIN_MIRROR;
  if (m->kind == MATERIAL_GLASS) return PLAIN_GLASS;
  surface any = {.material = m};
  return matter_matt(&any) ? PLAIN_MATT : PLAIN_NOT;
}

const path_plain *path_plains(const scene *s, arena *mem) {
  if (s->material_of == NULL || s->mesh.colors != NULL) return NULL;
  path_plain *all = ARENA_NEW(mem, path_plain, s->material_count);
  for (size_t i = 0; i < s->material_count; i++) {
    surface any = {.color = vec3_all(1), .material = &s->materials[i]};
    all[i] = (path_plain){vec3_all(0), 1, kind_of(any.material)};
    if (all[i].kind == PLAIN_NOT) continue;
    bsdf b = matter_choose(NULL, &any, 1, 0).bsdf;
    all[i].albedo = b.kind == BSDF_MIRROR ? b.ks : b.kd;
    if (b.kind == BSDF_GLASS) all[i].eta = b.eta;
  }
  return all;
}

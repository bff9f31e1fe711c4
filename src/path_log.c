// path_log.c

#include "path_log.h"

#include "light_emission.h"

// The irradiance over its density in the part.
static float found(const light_set *l, const light_sample *s, float cosine) {
  if (!(cosine > 0)) return 0;
  float x = light_mean(s->radiance) * s->chosen / s->pdf;
  if (l->sky.count > 0) x = light_sky_worth(&l->sky, s->part);
  return float_min(x * cosine, 1e18f);  // whose square is a float
}

size_t path_log_note(path_log *log, const light_set *l, const vertex *v,
                     const light_sample *s, const meeting *m) {
  if (log == NULL || s->part == LIGHT_NO_PART) return PATH_NO_RECORD;
  float weight = s->delta || !(m->pdf > 0) ? 1 : s->pdf / (s->pdf + m->pdf);
  log->items =
      array_grow(log->items, &log->room, log->count + 1, sizeof *log->items);
  log->items[log->count++] =
      (light_record){light_memory_key(l->memory, v->at.p, v->n), s->part,
                     found(l, s, m->cosine), weight};
  return log->count - 1;
}

size_t path_log_forget(path_log *log, size_t record) {
  if (record != PATH_NO_RECORD) log->count = record;
  return PATH_NO_RECORD;
}

// path_log.c

#include "path_log.h"

#include "light_emission.h"

size_t path_log_note(path_log *log, const light_memory *m, const vertex *v,
                     const light_sample *s, float cosine) {
  if (log == NULL || s->part == LIGHT_NO_PART) return PATH_NO_RECORD;
  float x = 0;
  if (cosine > 0) x = light_mean(s->radiance) * cosine * s->chosen / s->pdf;
  x = float_min(x, 1e18f);  // whose square is a float
  log->items =
      array_grow(log->items, &log->room, log->count + 1, sizeof *log->items);
  log->items[log->count++] =
      (light_record){light_memory_key(m, v->at.p, v->n), s->part, x * x};
  return log->count - 1;
}

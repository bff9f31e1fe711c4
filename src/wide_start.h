// wide_start.h — rays of a stream take off.

#ifndef WIDE_START_H
#define WIDE_START_H

#include "wide_steps.h"

static inline uint32_t patch_of(const stream *s, uint32_t i) {
  return s->left[i] != HIT_NONE ? s->t->patch[s->left[i]] : 0;
}

// Make the next rays of the stream ready.
SIMD void stream_ready(stream *s, bool any) {
  ready_rows *q = &s->ready;
  ready_rays r;
  f8 v[8];
  const char *row[8];
  uint32_t left = s->count - s->taken;
  q->count = left < 8 ? left : 8;
  q->next = 0;
  for (uint32_t i = 0; i < 8; i++) {
    uint32_t k = s->taken + (i < q->count ? i : q->count - 1);
    if (any && s->alone != NULL) {
      q->index[i] = s->alone->ray[k];
      q->from[i] = s->alone->child[k];
    } else {
      q->index[i] = s->groups[k / PACKET] * PACKET + k % PACKET;
      q->from[i] = 0;
    }
    row[i] = (const char *)&s->rays[q->index[i]];
    q->patch[i] = s->left != NULL ? patch_of(s, q->index[i]) : 0;
  }
  s->taken += q->count;
  f8_columns(v, row, 0);
  ready_columns(&r, s->t, v);
  q->can = s->t->nodes != NULL ? r.can : 0;
  f8_store_rows(q->row[0], r.column[0]);
  f8_store_rows(q->row[1], r.column[1]);
  f8_store_rows(q->row[2], r.column[2]);
  f8_store_rows(q->row[3], r.column[3]);
}

// Give a flight the next ray of the stream that can hit something; false when
// there is none.
SIMD bool flight_start(stream *s, flight *f, bool any) {
  ready_rows *q = &s->ready;
  while (true) {
    if (q->next == q->count) {
      if (s->taken == s->count) return false;
      stream_ready(s, any);
    }
    uint32_t k = q->next++, i = q->index[k];
    if (any && s->blocked[i]) continue;
    if ((q->can >> k & 1) == 0) {
      if (!any) s->hits[i] = (hit){.t = s->rays[i].tmax, .triangle = HIT_NONE};
      continue;
    }
    walk_row(&f->w, 0, q->row[0][k]);
    walk_row(&f->w, 1, q->row[1][k]);
    walk_row(&f->w, 2, q->row[2][k]);
    walk_row(&f->w, 3, q->row[3][k]);
    f->w.r = &s->rays[i];
    f->index = i;
    f->patch = q->patch[k];
    f->child[0] = FLIGHT_END;
    f->next = q->from[k];
    f->top = 1;
    return true;
  }
}

// Rays that have ended make room for others, which begin at the root.
SIMD void stream_refill(stream *s, const flight_list *ended, flight_list *nodes,
                        bool any) {
  for (uint32_t i = 0; i < ended->count; i++) {
    flight *f = ended->at[i];
    if (!any) s->hits[f->index] = f->w.best;
    nodes->at[nodes->count] = f;
    nodes->count += flight_start(s, f, any);
  }
}

#endif

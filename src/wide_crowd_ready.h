// wide_crowd_ready.h — a crowd gets ready.

#ifndef WIDE_CROWD_READY_H
#define WIDE_CROWD_READY_H

#include "wide_crowd.h"

// What eight rays need at nodes, column by column.
typedef struct crowd_columns {
  f8 v[2][8];
} crowd_columns;

// Of the three axes from number i on.
SIMD f8 crowd_peak(const f8 v[8], int i) {
  return f8_max(f8_max(f8_abs(v[i]), f8_abs(v[i + 1])), f8_abs(v[i + 2]));
}

// Which rays have only finite numbers, so that no box gives NaN.
SIMD uint32_t crowd_plain(const crowd_columns *c) {
  f8 most = f8_all(FLT_MAX);
  return f8_le(crowd_peak(c->v[0], 0), most) &
         f8_le(crowd_peak(c->v[0], 4), most) &
         f8_le(crowd_peak(c->v[1], 0), most);
}

// Rays that were made ready, as eight of the crowd; those that go along.
SIMD uint32_t crowd_rows(crowd *q, ready_rays *r, uint32_t i) {
  crowd_columns c;
  const f8 *a = r->column[1], *b = r->column[2];
  memcpy(c.v[0], a, sizeof c.v[0]);
  memcpy(c.v[1], b, sizeof c.v[1]);
  c.v[0][4] = f8_max(a[4], b[0]);
  c.v[0][5] = f8_max(a[5], b[1]);
  c.v[0][6] = f8_max(a[6], b[2]);
  c.v[1][0] = f8_min(a[4], b[0]);
  c.v[1][1] = f8_min(a[5], b[1]);
  c.v[1][2] = f8_min(a[6], b[2]);
  c.v[1][5] = r->column[3][6];
  r->column[0][7] = r->column[3][5];
  uint32_t plain = crowd_plain(&c);
  f8_transpose(c.v[0]);
  f8_transpose(c.v[1]);
  f8_transpose(r->column[0]);
  for (uint32_t k = 0; k < 8; k++) {
    memcpy(q->at_node[i + k].inv, &c.v[0][k], sizeof(f8));
    memcpy(q->at_node[i + k].down, &c.v[1][k], sizeof(f8));
    memcpy(&q->at_leaf[i + k], &r->column[0][k], sizeof(f8));
  }
  return plain;
}

// Make the rays of a crowd ready and put those that can hit anything in a list
// at the root; those along a plane of the axes go alone.
SIMD void crowd_start(crowd *q) {
  stream *s = q->s;
  crowd_lists *l = &q->nodes;
  memset(s->blocked + q->first, 0, q->count * sizeof(bool));
  l->used = l->count = 0;
  for (uint32_t i = 0; i < q->count; i += 8) {
    uint32_t left = q->count - i, all = left < 8 ? (1u << left) - 1 : 0xff;
    ready_rays r;
    f8 v[8];
    const char *row[8];
    for (uint32_t k = 0; k < 8; k++) {
      uint32_t at = q->first + i + (k < left ? k : left - 1);
      row[k] = (const char *)&s->rays[at];
    }
    f8_columns(v, row, 0);
    ready_columns(&r, s->t, v);
    all &= r.can;
    uint32_t plain = crowd_rows(q, &r, i);
    for (uint32_t k = 0; k < 8; k++) {
      l->ray[l->used] = i + k;
      l->used += (all & plain) >> k & 1;
    }
    for (all &= ~plain; all != 0; all &= all - 1)
      crowd_leave(q, i + (uint32_t)__builtin_ctz(all), 0);
  }
  l->part[0] = (crowd_part){0, 0, l->used};
  l->count = l->used > 0;
}

#endif

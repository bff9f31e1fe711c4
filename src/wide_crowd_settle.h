// wide_crowd_settle.h — candidates of a crowd, looked at closely.

#ifndef WIDE_CROWD_SETTLE_H
#define WIDE_CROWD_SETTLE_H

#include "wide_crowd.h"

// Eight rays of the crowd and a triangle of each, the candidates from number i
// on.
SIMD void crowd_tests(leaf_tests *of, const crowd *q, uint32_t i) {
  const char *node[8], *leaf[8];
  const pending *p = &q->pending;
  f8 v[8], w[8], zero = f8_all(0);
  for (int k = 0; k < 8; k++) {
    node[k] = (const char *)&q->at_node[p->flight[i + (uint32_t)k]];
    leaf[k] = (const char *)&q->at_leaf[p->flight[i + (uint32_t)k]];
  }
  f8_columns(v, leaf, 0);
  of->rays = (leaf_rays){{v[0], v[1], v[2]}, v[3], v[4]};
  of->sz = v[5];
  of->tmin = v[6];
  f8_columns(v, node, 0);
  f8_columns(w, node, sizeof(f8));
  of->reach = v[3];
  of->tmax = of->best = w[4];
  turn_axes(of->inv, v, v[7], w[3]);
  f8 up[3], down[3];
  turn_axes(up, v + 4, v[7], w[3]);
  turn_axes(down, w, v[7], w[3]);
  for (int k = 0; k < 3; k++) {
    of->enter[k] = f8_where_lt(of->inv[k], zero, down[k], up[k]);
    of->leave[k] = f8_where_lt(of->inv[k], zero, up[k], down[k]);
  }
  of->large = q->s->t->large;
  pending_corners(&of->at, p, i);
}

// The axes, turned so that axis kz comes last.
static const uint32_t turned_axes[3][3] = {{1, 2, 0}, {2, 0, 1}, {0, 1, 2}};

// Candidate number i, which single precision does not decide.
SIMD bool crowd_unsure(const crowd *q, uint32_t i, bool close) {
  const pending *p = &q->pending;
  const crowd_ray *n = &q->at_node[p->flight[i]];
  const crowd_shear *s = &q->at_leaf[p->flight[i]];
  wide_walk w = {.sx = s->sx, .sy = s->sy, .sz = s->sz};
  for (int k = 0; k < 3; k++) {
    bool back = n->inv[k] < 0;
    w.inv[k] = n->inv[k];
    w.enter[k] = back ? n->down[k] : n->up[k];
    w.leave[k] = back ? n->up[k] : n->down[k];
    w.side[k] = back ? WIDE : 0;
    w.axis[k] = turned_axes[s->kz][k];
  }
  w.large = q->s->t->large;
  w.r = &q->s->rays[q->first + p->flight[i]];
  hit h;
  return leaf_one(&w, &(leaf_triangle){&p->corner[0][i], PENDING}, close, &h);
}

// Look closely at all candidates.
SIMD void crowd_settle(crowd *q) {
  pending *p = &q->pending;
  for (uint32_t i = 0; i < p->count; i += 8) {
    leaf_tests of;
    leaf_shear c;
    leaf_found f;
    uint32_t left = p->count - i, m = left < 8 ? (1u << left) - 1 : 0xff;
    crowd_tests(&of, q, i);
    leaf_edges(&c, &of.rays, &of.at);
    leaf_distances(&f, &c, &of, m);
    for (m = f.hits | f.unsure; m != 0; m &= m - 1) {
      uint32_t k = (uint32_t)__builtin_ctz(m), who = p->flight[i + k];
      bool unsure = (f.unsure >> k & 1) != 0;
      if (unsure && !crowd_unsure(q, i + k, f.close >> k & 1)) continue;
      q->s->blocked[q->first + who] = true;
      q->at_node[who].until = -1;
    }
  }
  p->count = 0;
}

#endif

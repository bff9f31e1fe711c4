// bvh_bundle.c

#include "bvh_bundle.h"

#include "bvh_split_clip.h"
#include "sah.h"

#include <string.h>

// Into so many parts a bundle is cut to see what cutting it gives.
enum { PROBE = 4 };

// Halving so many parts leaves one, whatever their number.
enum { HALVINGS = 32 };

// Some of a bundle on its way: the boxes of the triangles that are there, the
// box of all of them, and how many parts are to be made of it.
typedef struct piece {
  uint32_t mask, parts;
  sah_box all, box[BVH_BUNDLE];
} piece;

// A bundle being cut: its triangles, and which of them may be cut.
typedef struct cutting {
  uint32_t count, large;
  bvh_outline outline[BVH_BUNDLE];
} cutting;

bool bvh_bundle_large(const sah_box *box, float least) {
  for (int k = 0; k < 3; k++)
    if (box->hi[k] - box->lo[k] > least) return true;
  return false;
}

static void piece_add(piece *p, uint32_t i, const sah_box *box) {
  p->mask |= 1u << i;
  p->box[i] = *box;
  sah_box_join(&p->all, box);
}

// A piece that has nothing yet.
static void piece_begin(piece *p, uint32_t parts) {
  p->mask = 0;
  p->parts = parts;
  p->all = sah_box_empty();
}

// What is said of the first n triangles.
static void piece_copy(piece *to, const piece *from, uint32_t n) {
  to->mask = from->mask;
  to->parts = from->parts;
  to->all = from->all;
  memcpy(to->box, from->box, n * sizeof *from->box);
}

// All of a bundle.
static void begin_cutting(cutting *c, piece *p, const bvh *b,
                          const bvh_bundle *u, float least) {
  piece_begin(p, 1);
  c->count = u->count;
  c->large = 0;
  for (uint32_t i = 0; i < u->count; i++) {
    const uint32_t *v = b->index + 3 * (size_t)b->order[u->first + i];
    vec3 at[3];
    for (int k = 0; k < 3; k++)
      at[k] = b->positions[v[k]];
    vec3 lo = vec3_min(at[0], vec3_min(at[1], at[2]));
    vec3 hi = vec3_max(at[0], vec3_max(at[1], at[2]));
    sah_box box = {{lo.x, lo.y, lo.z, 0}, {hi.x, hi.y, hi.z, 0}};
    piece_add(p, i, &box);
    if (!bvh_bundle_large(&box, least)) continue;
    c->large |= 1u << i;
    c->outline[i] = bvh_outline_of(at);
  }
}

// Where to cut a piece: across its longest side, in proportion to the parts
// that either side is to have; axis -1 where no float lies between its ends.
static bvh_slice plane_of(const piece *p) {
  bvh_slice s = {.axis = 0};
  for (int k = 1; k < 3; k++)
    if (p->all.hi[k] - p->all.lo[k] > p->all.hi[s.axis] - p->all.lo[s.axis])
      s.axis = k;
  float lo = p->all.lo[s.axis], hi = p->all.hi[s.axis];
  float share = (float)(p->parts / 2) / (float)p->parts;
  s.lo = s.hi = lo + (hi - lo) * share;
  if (!(s.lo > lo && s.lo < hi)) s.axis = -1;
  return s;
}

// What of triangle i of a piece goes to either side of a plane.
static void part_triangle(const cutting *c, const piece *p, uint32_t i,
                          bvh_slice at, piece side[2]) {
  const sah_box *box = &p->box[i];
  float lo = box->lo[at.axis], hi = box->hi[at.axis];
  if (hi <= at.lo || lo >= at.lo || !(c->large >> i & 1)) {
    bool right = hi > at.lo && 0.5f * lo + 0.5f * hi >= at.lo;
    piece_add(&side[right], i, box);
    return;
  }
  bvh_slice half[2] = {{at.axis, -INFINITY, at.lo}, {at.axis, at.lo, INFINITY}};
  for (int k = 0; k < 2; k++) {
    sah_box part;
    if (bvh_split_clip(&part, box, &c->outline[i], half[k]))
      piece_add(&side[k], i, &part);
  }
}

// The boxes of the parts of what is at the bottom of a stack; their number.
static uint32_t cut_all(const cutting *c, piece stack[HALVINGS + 2],
                        sah_ref *out) {
  int top = 1;
  uint32_t n = 0;
  while (top > 0) {
    const piece *p = &stack[--top];
    bvh_slice at = {.axis = -1};
    if (p->parts > 1 && c->large != 0) at = plane_of(p);
    if (at.axis < 0) {
      out[n++].box = p->all;
      continue;
    }
    piece side[2];
    piece_begin(&side[0], p->parts / 2);
    piece_begin(&side[1], p->parts - p->parts / 2);
    for (uint32_t i = 0; i < c->count; i++)
      if (p->mask >> i & 1) part_triangle(c, p, i, at, side);
    for (int k = 0; k < 2; k++)
      if (side[k].mask != 0) piece_copy(&stack[top++], &side[k], c->count);
  }
  return n;
}

uint32_t bvh_bundle_cut(const bvh *b, const bvh_bundle *u, float least,
                        uint32_t parts, sah_ref *out) {
  cutting c;
  piece stack[HALVINGS + 2];
  begin_cutting(&c, &stack[0], b, u, least);
  stack[0].parts = parts;
  return cut_all(&c, stack, out);
}

void bvh_bundle_measure(const bvh *b, bvh_bundle *u, float least, double all) {
  cutting c;
  piece stack[HALVINGS + 2];
  sah_ref part[PROBE];
  begin_cutting(&c, &stack[0], b, u, least);
  stack[0].parts = PROBE;
  double whole = sah_half_area(&stack[0].all), sum = 0;
  uint32_t n = cut_all(&c, stack, part);
  for (uint32_t i = 0; i < n; i++)
    sum += sah_half_area(&part[i].box);
  u->excess = fmin(fmax(whole - sum, 0) * PROBE / (PROBE - 1), whole) / all;
  u->flat = whole / all - u->excess;
}

// polygon.c

#include "polygon.h"

#include <float.h>
#include <stdbool.h>
#include <string.h>

// Point-in-triangle tests that a polygon may cost per corner, above what any
// small one may; what is left then is cut anyhow.  Ordinary outlines need a few
// dozen at any size.
enum { CLIP_BUDGET = 1000, CLIP_BUDGET_LEAST = 1 << 20 };

// No corner.
#define NO_CORNER UINT32_MAX

// How picky the search for ears is.  Strict: a corner that does not turn right,
// and no other reflex corner in or on its triangle.  Any: whatever does not
// turn right.  Last: the next corner, whatever it is.
typedef enum ear_rule { EAR_STRICT, EAR_ANY, EAR_LAST } ear_rule;

// A corner seen along the axis nearest to the polygon's normal.
typedef struct flat {
  double x, y;
} flat;

// A polygon being clipped.  The corners left form a ring; those that turn
// right or go straight on also hang in the lists of a grid, where the ear test
// finds the ones near a triangle.
typedef struct clipper {
  const flat *p;
  uint32_t *next, *prev;       // the ring
  uint32_t left;               // corners in it
  uint32_t *queue;             // corners to look at, a circular buffer
  uint32_t queue_at, queue_n;  // its first, its length
  bool *queued, *gone;
  uint32_t n;
  flat lo;          // corner of the grid
  double cell;      // cells per unit
  uint32_t side;    // cells along an edge of the grid
  uint32_t *head;   // first corner of each cell
  uint32_t *below;  // next corner in the same cell
  uint32_t *above;  // the one before
  bool *listed;     // whether it hangs in its cell
  uint64_t budget;  // tests left
  uint32_t *out;    // where the next triangle goes
} clipper;

void polygon_newell(const vec3 *p, size_t n, double out[3]) {
  double x = 0, y = 0, z = 0;
  // Relative to the first corner, so that far from the origin no digits go.
  double ox = (double)p[0].x, oy = (double)p[0].y, oz = (double)p[0].z;
  for (size_t i = 0, j = n - 1; i < n; j = i++) {
    double ax = (double)p[j].x - ox, bx = (double)p[i].x - ox;
    double ay = (double)p[j].y - oy, by = (double)p[i].y - oy;
    double az = (double)p[j].z - oz, bz = (double)p[i].z - oz;
    x += ay * bz - az * by;
    y += az * bx - ax * bz;
    z += ax * by - ay * bx;
  }
  out[0] = x;
  out[1] = y;
  out[2] = z;
}

// The corner moved along the normal into the coordinate plane that faces it
// most, seen from the side where the polygon runs counter-clockwise.  Triangles
// there and on the Newell plane differ by an affine map, which changes neither
// turns nor ratios of areas; and where the normal is an axis, nothing is
// rounded.
static flat flatten(vec3 p, const double normal[3], int axis) {
  double q[3] = {(double)p.x, (double)p.y, (double)p.z};
  int i = (axis + 1) % 3, j = (axis + 2) % 3;
  double up = q[axis] / normal[axis];
  double x = q[i] - normal[i] * up, y = q[j] - normal[j] * up;
  return normal[axis] < 0 ? (flat){y, x} : (flat){x, y};
}

// Twice the signed area of a b c: positive when they turn left.
static double turn(flat a, flat b, flat c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// What the rounding of the corners to float can do to turn(a, b, c): an outline
// that was straight there may seem to turn by this much.
static double turn_noise(flat a, flat b, flat c) {
  double size = fmax(fmax(fabs(a.x), fabs(a.y)), fmax(fabs(b.x), fabs(b.y)));
  size = fmax(size, fmax(fabs(c.x), fabs(c.y)));
  double length =
      fabs(b.x - a.x) + fabs(b.y - a.y) + fabs(c.x - b.x) + fabs(c.y - b.y);
  return (double)FLT_EPSILON * size * length;
}

// Whether the outline never turns right and goes round once: a convex outline
// changes its direction along x just twice.
static bool is_convex(const flat *p, size_t n) {
  int changes = 0;
  double direction = 0;
  for (size_t i = n; i-- > 0 && direction == 0;)
    direction = p[(i + 1) % n].x - p[i].x;
  for (size_t i = 0; i < n; i++) {
    flat a = p[i], b = p[(i + 1) % n], c = p[(i + 2) % n];
    if (!(turn(a, b, c) >= -turn_noise(a, b, c))) return false;
    double step = b.x - a.x;
    if (step != 0 && (step > 0) != (direction > 0)) {
      changes++;
      direction = step;
    }
  }
  return changes <= 2;
}

// The triangles (0, i, i + 1).
static void fan(uint32_t *out, size_t n) {
  for (size_t i = 1; i + 1 < n; i++) {
    *out++ = 0;
    *out++ = (uint32_t)i;
    *out++ = (uint32_t)i + 1;
  }
}

// The grid's column or row of a coordinate.
static uint32_t grid_index(const clipper *c, double x, double lo) {
  double i = (x - lo) * c->cell;
  if (!(i > 0)) return 0;
  return i >= c->side ? c->side - 1 : (uint32_t)i;
}

static uint32_t *grid_head(clipper *c, flat p) {
  uint32_t column = grid_index(c, p.x, c->lo.x);
  uint32_t row = grid_index(c, p.y, c->lo.y);
  return &c->head[(size_t)row * c->side + column];
}

static void grid_add(clipper *c, uint32_t i) {
  uint32_t *head = grid_head(c, c->p[i]);
  c->above[i] = NO_CORNER;
  c->below[i] = *head;
  if (*head != NO_CORNER) c->above[*head] = i;
  *head = i;
  c->listed[i] = true;
}

static void grid_remove(clipper *c, uint32_t i) {
  if (!c->listed[i]) return;
  uint32_t above = c->above[i], below = c->below[i];
  if (above != NO_CORNER) c->below[above] = below;
  if (above == NO_CORNER) *grid_head(c, c->p[i]) = below;
  if (below != NO_CORNER) c->above[below] = above;
  c->listed[i] = false;
}

static void queue_push(clipper *c, uint32_t i) {
  if (c->queued[i]) return;
  c->queued[i] = true;
  c->queue[(c->queue_at + c->queue_n++) % c->n] = i;
}

static uint32_t queue_pop(clipper *c) {
  uint32_t i = c->queue[c->queue_at];
  c->queue_at = (c->queue_at + 1) % c->n;
  c->queue_n--;
  c->queued[i] = false;
  return i;
}

static double turn_at(const clipper *c, uint32_t i) {
  return turn(c->p[c->prev[i]], c->p[i], c->p[c->next[i]]);
}

static bool same_place(flat a, flat b) {
  return a.x == b.x && a.y == b.y;
}

// Whether q lies in the triangle or on its edge.  A corner in the place of one
// of the triangle's own does not count: outlines with holes are sewn up by
// edges that run twice.
static bool blocks(flat q, const flat t[3]) {
  if (same_place(q, t[0]) || same_place(q, t[1]) || same_place(q, t[2]))
    return false;
  return turn(t[0], t[1], q) >= 0 && turn(t[1], t[2], q) >= 0 &&
         turn(t[2], t[0], q) >= 0;
}

// Whether any reflex corner blocks the triangle around i.
static bool is_blocked(clipper *c, uint32_t i) {
  uint32_t own[3] = {c->prev[i], i, c->next[i]};
  flat t[3] = {c->p[own[0]], c->p[i], c->p[own[2]]};
  double lo_x = fmin(fmin(t[0].x, t[1].x), t[2].x);
  double hi_x = fmax(fmax(t[0].x, t[1].x), t[2].x);
  double lo_y = fmin(fmin(t[0].y, t[1].y), t[2].y);
  double hi_y = fmax(fmax(t[0].y, t[1].y), t[2].y);
  uint32_t column_1 = grid_index(c, hi_x, c->lo.x);
  uint32_t row_1 = grid_index(c, hi_y, c->lo.y);
  uint64_t tests = 0;
  bool blocked = false;
  for (uint32_t r = grid_index(c, lo_y, c->lo.y); r <= row_1 && !blocked; r++)
    for (uint32_t k = grid_index(c, lo_x, c->lo.x); k <= column_1 && !blocked;
         k++) {
      uint32_t q = c->head[(size_t)r * c->side + k];
      for (tests++; q != NO_CORNER && !blocked; q = c->below[q], tests++)
        blocked = q != own[0] && q != i && q != own[2] && blocks(c->p[q], t);
    }
  c->budget -= tests < c->budget ? tests : c->budget;
  return blocked;
}

static bool is_ear(clipper *c, uint32_t i, ear_rule rule) {
  if (c->budget > 0) c->budget--;
  if (rule == EAR_LAST) return true;
  if (turn_at(c, i) < 0) return false;
  return rule == EAR_ANY || !is_blocked(c, i);
}

// A neighbour of a corner that went: it may be no longer reflex, and it may
// have become an ear.
static void look_again(clipper *c, uint32_t i) {
  if (turn_at(c, i) > 0) grid_remove(c, i);
  queue_push(c, i);
}

// Write the triangle around i and take i out of the ring.
static void clip(clipper *c, uint32_t i) {
  uint32_t a = c->prev[i], b = c->next[i];
  *c->out++ = a;
  *c->out++ = i;
  *c->out++ = b;
  c->next[a] = b;
  c->prev[b] = a;
  c->gone[i] = true;
  c->left--;
  grid_remove(c, i);
  look_again(c, a);
  look_again(c, b);
}

static void queue_all(clipper *c, uint32_t any) {
  uint32_t i = any;
  do {
    queue_push(c, i);
    i = c->next[i];
  } while (i != any);
}

// Clip until three corners are left.  A clipped ear changes its neighbours, so
// they come into the queue again; where an outline touches itself it may free
// others too, so a dry queue is filled with all that are left.  Only when that
// gave nothing is the rule relaxed.
static void clip_all(clipper *c) {
  ear_rule rule = EAR_STRICT;
  bool clipped = true;
  uint32_t some = 0;  // a corner that is left
  while (c->left > 3) {
    if (c->budget == 0) rule = EAR_LAST;
    if (c->queue_n == 0) {
      if (!clipped && rule != EAR_LAST) rule++;
      queue_all(c, some);
      clipped = false;
    }
    uint32_t i = queue_pop(c);
    if (c->gone[i] || !is_ear(c, i, rule)) continue;
    some = c->next[i];
    clip(c, i);
    clipped = true;
    rule = EAR_STRICT;
  }
  *c->out++ = c->prev[some];
  *c->out++ = some;
  *c->out++ = c->next[some];
}

// About one cell per corner; one cell for all when they are few.
static void grid_fit(clipper *c, arena *scratch) {
  flat lo = c->p[0], hi = c->p[0];
  for (uint32_t i = 1; i < c->n; i++) {
    lo = (flat){fmin(lo.x, c->p[i].x), fmin(lo.y, c->p[i].y)};
    hi = (flat){fmax(hi.x, c->p[i].x), fmax(hi.y, c->p[i].y)};
  }
  double extent = fmax(hi.x - lo.x, hi.y - lo.y);
  c->lo = lo;
  c->side = c->n < 64 ? 1 : (uint32_t)sqrt((double)c->n);
  c->cell = extent > 0 ? c->side / extent : 0;
  size_t cells = (size_t)c->side * c->side;
  c->head = ARENA_NEW(scratch, uint32_t, cells);
  memset(c->head, 0xff, cells * sizeof *c->head);
}

static void clip_ears(const flat *p, size_t n, uint32_t *out, arena *scratch) {
  clipper c = {.p = p, .n = (uint32_t)n, .left = (uint32_t)n, .out = out};
  c.next = ARENA_NEW(scratch, uint32_t, n);
  c.prev = ARENA_NEW(scratch, uint32_t, n);
  c.queue = ARENA_NEW(scratch, uint32_t, n);
  c.below = ARENA_NEW(scratch, uint32_t, n);
  c.above = ARENA_NEW(scratch, uint32_t, n);
  c.queued = ARENA_NEW(scratch, bool, n);
  c.gone = ARENA_NEW(scratch, bool, n);
  c.listed = ARENA_NEW(scratch, bool, n);
  c.budget = (uint64_t)n * CLIP_BUDGET + CLIP_BUDGET_LEAST;
  grid_fit(&c, scratch);
  for (uint32_t i = 0; i < c.n; i++) {
    c.next[i] = i + 1 < c.n ? i + 1 : 0;
    c.prev[i] = i > 0 ? i - 1 : c.n - 1;
  }
  for (uint32_t i = 0; i < c.n; i++)
    if (!(turn_at(&c, i) > 0)) grid_add(&c, i);
  clip_all(&c);
}

// Whether the triangles cover what the outline encloses: no triangle turns
// right, and the sum of the areas is the outline's.
static bool is_cover(const flat *p, size_t n, const uint32_t *triangles,
                     double twice_area) {
  double sum = 0;
  for (size_t t = 0; t < n - 2; t++, triangles += 3)
    sum += fabs(turn(p[triangles[0]], p[triangles[1]], p[triangles[2]]));
  return fabs(sum - twice_area) <= 1e-5 * twice_area;
}

bool polygon_triangulate(const vec3 *p, size_t n, uint32_t *out,
                         arena *scratch) {
  if (n == 3) {
    fan(out, n);
    return true;
  }
  double normal[3];
  polygon_newell(p, n, normal);
  int axis = 0;
  for (int i = 1; i < 3; i++)
    if (fabs(normal[i]) > fabs(normal[axis])) axis = i;
  flat few[8];
  flat *q = n <= 8 ? few : ARENA_NEW(scratch, flat, n);
  double square =
      normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
  double area = square / fabs(normal[axis]);  // of the outline as flattened
  bool solid = area > 0 && isfinite(area);
  for (size_t i = 0; i < n; i++)
    q[i] = flatten(p[i], normal, axis);
  if (!solid || is_convex(q, n)) {
    fan(out, n);
    return n == 4 || solid;
  }
  clip_ears(q, n, out, scratch);
  return n == 4 || is_cover(q, n, out, area);
}

// plot.c

#include "plot.h"

#include <math.h>

// Sizes in pixels: capitals, the pen for them, and the room beside the axes.
static const sketch_type SMALL_TYPE = {8, 0, false};

#define TEXT_PEN 1.3f
#define MARGIN 10.0f
#define TICK_ROOM 6.0f
#define LEGEND_LINE 17.0f

// The place on paper of what an axis shows: value v is at a + b * scale(v).
typedef struct axis_map {
  bool log;
  double from, to;
  float low, high;  // pixels
} axis_map;

// The paper while it is drawn on.
typedef struct drawing {
  const plot *p;
  sketch s;
  axis_map x, y;
  float legend;  // its left edge
} drawing;

vec3 plot_color(size_t i) {
  static const unsigned char code[8][3] = {
      {0, 0, 0},      {230, 159, 0}, {86, 180, 233}, {0, 158, 115},
      {240, 228, 66}, {0, 114, 178}, {213, 94, 0},   {204, 121, 167}};
  // In this order neighbours differ most; yellow, faint on white, is the last.
  static const unsigned char order[8] = {5, 6, 3, 7, 1, 0, 2, 4};
  const unsigned char *c = code[order[i % 8]];
  return (vec3){(float)srgb_decode(c[0] / 255.0),
                (float)srgb_decode(c[1] / 255.0),
                (float)srgb_decode(c[2] / 255.0)};
}

static double scaled(const axis_map *a, double v) {
  return a->log ? log10(v) : v;
}

static float place(const axis_map *a, double v) {
  double from = scaled(a, a->from), to = scaled(a, a->to);
  double t = (scaled(a, v) - from) / (to - from);
  return a->low + (float)t * (a->high - a->low);
}

// Whether the axis can show the value at all.
static bool shows(const axis_map *a, double v) {
  return isfinite(v) && (!a->log || v > 0);
}

static bool inside(const axis_map *a, double v) {
  double slack = a->log ? a->to * 1e-9 : (a->to - a->from) * 1e-9;
  return shows(a, v) && v >= a->from - slack && v <= a->to + slack;
}

// Widen [from, to] to hold n values; NULL holds none.
static void hold(axis_map *a, const double *v, size_t n) {
  for (size_t i = 0; v != NULL && i < n; i++) {
    if (!shows(a, v[i])) continue;
    a->from = fmin(a->from, v[i]);
    a->to = fmax(a->to, v[i]);
  }
}

// The step of a linear axis: 1, 2 or 5 times a power of ten, for about six.
static double nice_step(double range) {
  double step = range / 6, ten = pow(10, floor(log10(step)));
  double lead = step / ten;
  return ten * (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10);
}

// Ends for the values at hand: on a logarithmic axis 1, 2 or 5 times a power of
// ten, on a linear one multiples of the step.
static void round_ends(axis_map *a) {
  static const double lead[] = {1, 2, 5, 10};
  if (!(a->from <= a->to)) a->from = a->log ? 1 : 0, a->to = a->log ? 10 : 1;
  if (!a->log) {
    if (a->from == a->to) a->to = a->from + fmax(fabs(a->from), 1);
    double step = nice_step(a->to - a->from);
    a->from = step * floor(a->from / step + 1e-9);
    a->to = step * ceil(a->to / step - 1e-9);
    return;
  }
  double low = pow(10, floor(log10(a->from))),
         high = pow(10, floor(log10(a->to)));
  int i = 3, k = 0;
  while (i > 0 && low * lead[i] > a->from * 1.000001)
    i--;
  while (k < 3 && high * lead[k] < a->to * 0.999999)
    k++;
  a->from = low * lead[i];
  a->to = high * lead[k];
  if (a->from == a->to) a->to *= 10;
}

static axis_map map_of(const plot *p, const plot_axis *axis, bool vertical) {
  axis_map a = {.log = axis->log, .from = axis->from, .to = axis->to};
  if (axis->from != 0 || axis->to != 0) return a;
  a.from = (double)INFINITY, a.to = -(double)INFINITY;
  for (size_t i = 0; i < p->count; i++) {
    const plot_series *s = &p->series[i];
    hold(&a, vertical ? s->y : s->x, s->n);
    if (!vertical) continue;
    hold(&a, s->low, s->n);
    hold(&a, s->high, s->n);
  }
  round_ends(&a);
  return a;
}

// One of the marks of an axis: where, and whether it has a number.
typedef struct tick {
  double at;
  bool numbered;
} tick;

enum { MAX_TICKS = 200 };

// Decades with their 2 and 5 numbered when there are few of them.
static size_t log_ticks(const axis_map *a, tick *out) {
  size_t n = 0;
  double decades = log10(a->to / a->from);
  for (double ten = pow(10, floor(log10(a->from)));
       ten <= a->to * 1.000001 && n + 10 < MAX_TICKS; ten *= 10)
    for (int i = 1; i < 10; i++)
      if (inside(a, ten * i))
        out[n++] =
            (tick){ten * i, i == 1 || (decades < 2.5 && (i == 2 || i == 5))};
  return n;
}

static size_t linear_ticks(const axis_map *a, tick *out) {
  double step = nice_step(a->to - a->from);
  size_t n = 0;
  for (double k = ceil(a->from / step - 1e-9);
       k * step <= a->to + step * 1e-6 && n < MAX_TICKS; k++)
    out[n++] = (tick){k * step, true};
  return n;
}

static size_t ticks_of(const axis_map *a, tick *out) {
  return a->log ? log_ticks(a, out) : linear_ticks(a, out);
}

static const char *tick_text(arena *mem, double v) {
  return arena_format(mem, fabs(v) < 1e-12 ? "0" : "%.6g", v);
}

// How wide the numbers of an axis get.
static float widest_tick(const axis_map *a, arena *mem) {
  tick t[MAX_TICKS];
  size_t n = ticks_of(a, t);
  float widest = 0;
  for (size_t i = 0; i < n; i++)
    if (t[i].numbered)
      widest = fmaxf(
          widest, sketch_text_length(SMALL_TYPE.size, tick_text(mem, t[i].at)));
  return widest;
}

static float legend_width(const plot *p) {
  float widest = 0;
  for (size_t i = 0; i < p->count; i++)
    if (p->series[i].name != NULL)
      widest =
          fmaxf(widest, sketch_text_length(SMALL_TYPE.size, p->series[i].name));
  return widest > 0 ? widest + 38 : 0;
}

// Divide the paper: legend on the right, numbers and labels outside the axes.
static void lay_out(drawing *d) {
  const plot *p = d->p;
  float line = SMALL_TYPE.size + 8;
  d->legend = (float)p->width - legend_width(p) - MARGIN / 2;
  d->y.high = MARGIN + (p->title != NULL ? line : 0);
  d->y.low = (float)p->height - MARGIN - line - (p->x.label != NULL ? line : 0);
  d->x.low = MARGIN + TICK_ROOM + widest_tick(&d->y, d->s.mem) +
             (p->y.label != NULL ? line : 0);
  d->x.high = d->legend - MARGIN / 2 - (legend_width(p) > 0 ? 0 : MARGIN);
}

static void text_at(drawing *d, float align, bool up, vec2 at,
                    const char *text) {
  if (text == NULL) return;
  sketch_type type = {SMALL_TYPE.size, align, up};
  sketch_text(&d->s, (sketch_pen){vec3_all(0.02f), TEXT_PEN}, &type, at, text);
}

// The lines of the paper along one axis, and its numbers.
static void rule(drawing *d, bool vertical) {
  const axis_map *a = vertical ? &d->y : &d->x, *b = vertical ? &d->x : &d->y;
  tick t[MAX_TICKS];
  size_t n = ticks_of(a, t);
  for (size_t i = 0; i < n; i++) {
    float at = place(a, t[i].at);
    vec2 ends[2] = {{at, b->low}, {at, b->high}};
    if (vertical) ends[0] = (vec2){b->low, at}, ends[1] = (vec2){b->high, at};
    vec3 grey = vec3_all(t[i].numbered ? 0.62f : 0.83f);
    sketch_line(&d->s, (sketch_pen){grey, 1}, ends, 2);
    if (!t[i].numbered) continue;
    vec2 below = {at, b->low + TICK_ROOM + SMALL_TYPE.size};
    vec2 beside = {b->low - TICK_ROOM, at + SMALL_TYPE.size / 2};
    text_at(d, vertical ? 1 : 0.5f, false, vertical ? beside : below,
            tick_text(d->s.mem, t[i].at));
  }
}

static void draw_axes(drawing *d) {
  rule(d, false);
  rule(d, true);
  vec2 frame[5] = {{d->x.low, d->y.low},
                   {d->x.high, d->y.low},
                   {d->x.high, d->y.high},
                   {d->x.low, d->y.high},
                   {d->x.low, d->y.low}};
  sketch_line(&d->s, (sketch_pen){vec3_all(0.05f), 1.2f}, frame, 5);
  float mid_x = (d->x.low + d->x.high) / 2, mid_y = (d->y.low + d->y.high) / 2;
  text_at(d, 0.5f, false, (vec2){mid_x, MARGIN + SMALL_TYPE.size}, d->p->title);
  text_at(d, 0.5f, false, (vec2){mid_x, (float)d->p->height - MARGIN},
          d->p->x.label);
  text_at(d, 0.5f, true, (vec2){MARGIN + SMALL_TYPE.size, mid_y},
          d->p->y.label);
}

// A mark as an outline around (0, 0), in units of its radius; 0 points: a dot.
static size_t outline(plot_mark mark, vec2 *out) {
  static const vec2 square[] = {
      {-.9f, -.9f}, {.9f, -.9f}, {.9f, .9f}, {-.9f, .9f}, {-.9f, -.9f}};
  static const vec2 diamond[] = {
      {0, -1.2f}, {1.2f, 0}, {0, 1.2f}, {-1.2f, 0}, {0, -1.2f}};
  static const vec2 triangle[] = {
      {0, -1.2f}, {1.1f, .8f}, {-1.1f, .8f}, {0, -1.2f}};
  static const vec2 cross[] = {{-1, -1}, {1, 1}, {0, 0}, {1, -1}, {-1, 1}};
  const vec2 *from = mark == PLOT_SQUARE    ? square
                     : mark == PLOT_DIAMOND ? diamond
                     : mark == PLOT_CROSS   ? cross
                                            : triangle;
  size_t n = mark == PLOT_TRIANGLE ? 4 : 5;
  if (mark == PLOT_DISC || mark == PLOT_RING || mark == PLOT_NO_MARK) return 0;
  for (size_t i = 0; i < n; i++)
    out[i] = from[i];
  return n;
}

static void draw_mark(drawing *d, const plot_series *s, vec2 at) {
  const float r = 3;
  vec2 points[5];
  size_t n = outline(s->mark, points);
  for (size_t i = 0; i < n; i++)
    points[i] = (vec2){at.x + r * points[i].x, at.y + r * points[i].y};
  if (n > 0) sketch_line(&d->s, (sketch_pen){s->color, 1.5f}, points, n);
  if (n > 0 || s->mark == PLOT_NO_MARK) return;
  sketch_dot(&d->s, (sketch_pen){s->color, 2 * r + 1}, at);
  if (s->mark == PLOT_RING)
    sketch_dot(&d->s, (sketch_pen){vec3_all(1), 2 * r - 2}, at);
}

static void draw_line(drawing *d, const plot_series *s, const vec2 *points,
                      size_t n) {
  sketch_pen pen = {s->color, 1.7f};
  if (s->line == PLOT_SOLID) sketch_line(&d->s, pen, points, n);
  if (s->line == PLOT_DASHED) sketch_dashes(&d->s, pen, points, n, 5);
}

static void draw_bar(drawing *d, const plot_series *s, size_t i, float x) {
  if (!inside(&d->y, s->low[i]) || !inside(&d->y, s->high[i])) return;
  vec2 ends[2] = {{x, place(&d->y, s->low[i])}, {x, place(&d->y, s->high[i])}};
  sketch_line(&d->s, (sketch_pen){s->color, 1.2f}, ends, 2);
  for (int k = 0; k < 2; k++) {
    vec2 cap[2] = {{x - 2.5f, ends[k].y}, {x + 2.5f, ends[k].y}};
    sketch_line(&d->s, (sketch_pen){s->color, 1.2f}, cap, 2);
  }
}

// Lines between neighbours that are both on the paper, then bars and marks.
static void draw_series(drawing *d, const plot_series *s) {
  vec2 *points = ARENA_NEW(d->s.mem, vec2, s->n);
  size_t n = 0;
  for (size_t i = 0; i <= s->n; i++) {
    bool on = i < s->n && inside(&d->x, s->x[i]) && inside(&d->y, s->y[i]);
    if (on) points[n++] = (vec2){place(&d->x, s->x[i]), place(&d->y, s->y[i])};
    if (on && i < s->n) continue;
    if (n > 1) draw_line(d, s, points, n);
    n = 0;
  }
  for (size_t i = 0; i < s->n; i++) {
    if (!inside(&d->x, s->x[i]) || !inside(&d->y, s->y[i])) continue;
    vec2 at = {place(&d->x, s->x[i]), place(&d->y, s->y[i])};
    if (s->low != NULL && s->high != NULL) draw_bar(d, s, i, at.x);
    draw_mark(d, s, at);
  }
}

static void draw_legend(drawing *d) {
  float y = d->y.high + LEGEND_LINE / 2;
  for (size_t i = 0; i < d->p->count; i++) {
    const plot_series *s = &d->p->series[i];
    if (s->name == NULL) continue;
    vec2 sample[2] = {{d->legend + 4, y}, {d->legend + 28, y}};
    draw_line(d, s, sample, 2);
    draw_mark(d, s, (vec2){d->legend + 16, y});
    text_at(d, 0, false, (vec2){d->legend + 34, y + SMALL_TYPE.size / 2},
            s->name);
    y += LEGEND_LINE;
  }
}

sketch plot_sketch(const plot *p, arena *mem) {
  drawing d = {.p = p, .s = sketch_new(mem, p->width, p->height)};
  d.x = map_of(p, &p->x, false);
  d.y = map_of(p, &p->y, true);
  lay_out(&d);
  draw_axes(&d);
  for (size_t i = 0; i < p->count; i++)
    draw_series(&d, &p->series[i]);
  draw_legend(&d);
  return d.s;
}

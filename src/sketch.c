// sketch.c

#include "sketch.h"

#include "glyph.h"

#include <string.h>

sketch sketch_new(arena *mem, int width, int height) {
  return (sketch){.mem = mem, .width = width, .height = height};
}

void sketch_line(sketch *s, sketch_pen pen, const vec2 *points, size_t n) {
  sketch_stroke *k = ARENA_NEW(s->mem, sketch_stroke, 1);
  *k = (sketch_stroke){pen.color, pen.width, n, NULL, NULL};
  k->points = ARENA_NEW(s->mem, vec2, n);
  memcpy(k->points, points, n * sizeof *points);
  if (s->last != NULL)
    s->last->next = k;
  else
    s->first = k;
  s->last = k;
}

void sketch_dot(sketch *s, sketch_pen pen, vec2 at) {
  sketch_line(s, pen, &at, 1);
}

static float distance(vec2 a, vec2 b) {
  return hypotf(b.x - a.x, b.y - a.y);
}

static vec2 between(vec2 a, vec2 b, float t) {
  return (vec2){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
}

// Dashes run on around corners: `gone` is how far the line has come within the
// dash or gap that began before this segment.
void sketch_dashes(sketch *s, sketch_pen pen, const vec2 *points, size_t n,
                   float length) {
  float gone = 0;
  bool down = true;
  for (size_t i = 0; i + 1 < n; i++) {
    float all = distance(points[i], points[i + 1]), at = 0;
    while (at < all) {
      float end = fminf(at + length - gone, all);
      vec2 piece[2] = {between(points[i], points[i + 1], at / all),
                       between(points[i], points[i + 1], end / all)};
      if (down) sketch_line(s, pen, piece, 2);
      gone += end - at;
      at = end;
      if (gone < length * 0.999f) continue;
      gone = 0;
      down = !down;
    }
  }
}

float sketch_text_length(float size, const char *text) {
  int units = 0;
  for (; *text != 0; text++)
    units += glyph_advance(*text);
  return (float)units * size / (GLYPH_CAPITAL - GLYPH_BASE);
}

// One letter whose lower left is at, as far as the grid goes.
static void draw_letter(sketch *s, sketch_pen pen, const sketch_type *type,
                        vec2 at, char c) {
  float unit = type->size / (GLYPH_CAPITAL - GLYPH_BASE);
  vec2 points[32];
  size_t n = 0;
  for (const char *g = glyph_strokes(c);; g += 2) {
    if (*g == 0 || *g == ' ') {
      if (n > 0) sketch_line(s, pen, points, n);
      n = 0;
      if (*g++ == 0) return;
    }
    float x = unit * (float)glyph_digit(g[0]);
    float y = unit * (float)(glyph_digit(g[1]) - GLYPH_BASE);
    points[n++] =
        type->up ? (vec2){at.x - y, at.y - x} : (vec2){at.x + x, at.y - y};
  }
}

void sketch_text(sketch *s, sketch_pen pen, const sketch_type *type, vec2 at,
                 const char *text) {
  float before = type->align * sketch_text_length(type->size, text);
  for (; *text != 0; text++) {
    vec2 p =
        type->up ? (vec2){at.x, at.y + before} : (vec2){at.x - before, at.y};
    draw_letter(s, pen, type, p, *text);
    char one[2] = {*text, 0};
    before -= sketch_text_length(type->size, one);
  }
}

// From p to the nearest point of a segment.
static float segment_distance(vec2 p, vec2 a, vec2 b) {
  vec2 d = {b.x - a.x, b.y - a.y}, to = {p.x - a.x, p.y - a.y};
  float square = d.x * d.x + d.y * d.y;
  float t = square > 0 ? (to.x * d.x + to.y * d.y) / square : 0;
  return distance(p, between(a, b, fminf(fmaxf(t, 0), 1)));
}

// Let the pixels near a segment know what share of them a pen along it covers.
// A pen's edge is taken for straight within a pixel, and for facing it.
static void cover(image *share, vec2 a, vec2 b, float width) {
  float r = width / 2, reach = r + 1;
  int x0 = (int)fmaxf(fminf(a.x, b.x) - reach, 0);
  int y0 = (int)fmaxf(fminf(a.y, b.y) - reach, 0);
  int x1 = (int)fminf(fmaxf(a.x, b.x) + reach, (float)share->width - 1);
  int y1 = (int)fminf(fmaxf(a.y, b.y) + reach, (float)share->height - 1);
  for (int y = y0; y <= y1; y++)
    for (int x = x0; x <= x1; x++) {
      vec3 *p = &share->pixels[y * share->width + x];
      vec2 center = {(float)x + 0.5f, (float)y + 0.5f};
      float inside = r + 0.5f - segment_distance(center, a, b);
      p->x = fmaxf(p->x, fminf(fmaxf(inside, 0), fminf(width, 1)));
    }
}

// The stroke as a whole, before it is mixed in: where two of its segments meet,
// the pen has been once, not twice.
static void draw_stroke(image *out, image *share, const sketch_stroke *k) {
  size_t pixels = (size_t)out->width * (size_t)out->height;
  for (size_t i = 0; i < k->count; i++)
    cover(share, k->points[i > 0 ? i - 1 : 0], k->points[i], k->width);
  for (size_t i = 0; i < pixels; i++) {
    float t = share->pixels[i].x;
    if (t > 0) out->pixels[i] = vec3_lerp(out->pixels[i], k->color, t);
    share->pixels[i].x = 0;
  }
}

image sketch_image(const sketch *s, arena *mem) {
  arena scratch = {0};
  image out = image_new(mem, s->width, s->height);
  image share = image_new(&scratch, s->width, s->height);
  for (int i = 0; i < s->width * s->height; i++)
    out.pixels[i] = vec3_all(1);
  for (const sketch_stroke *k = s->first; k != NULL; k = k->next)
    draw_stroke(&out, &share, k);
  arena_free(&scratch);
  return out;
}

void sketch_svg(const sketch *s, FILE *out) {
  srgb_table codes = srgb_table_new();
  fprintf(out,
          "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" "
          "height=\"%d\" viewBox=\"0 0 %d %d\">\n"
          "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n"
          "<g fill=\"none\" stroke-linecap=\"round\" "
          "stroke-linejoin=\"round\">\n",
          s->width, s->height, s->width, s->height);
  for (const sketch_stroke *k = s->first; k != NULL; k = k->next) {
    fprintf(out, "<path stroke=\"#%02x%02x%02x\" stroke-width=\"%.3g\" d=\"",
            srgb_code(&codes, k->color.x), srgb_code(&codes, k->color.y),
            srgb_code(&codes, k->color.z), (double)k->width);
    for (size_t i = 0; i < k->count || i < 2; i++) {
      vec2 p = k->points[i < k->count ? i : 0];
      fprintf(out, "%c%.2f %.2f", i == 0 ? 'M' : 'L', (double)p.x, (double)p.y);
    }
    fputs("\"/>\n", out);
  }
  fputs("</g>\n</svg>\n", out);
}

// figures.c — the pictures of chapter 6, and the numbers that its text quotes.

#include "../easel.h"
#include "bsdf_rough.h"
#include "clock.h"
#include "num.h"

#include <stdio.h>
#include <stdlib.h>

// Where the pictures go, and the tables of both sets of formulas.
typedef struct output {
  const char *folder;
  arena mem;
  dfg of[2];
} output;

// A surface as the exercises and mistakes need it: which of them is made.
typedef enum mistake {
  NO_MISTAKE,
  USUAL_D,  // (n.h)^2 (alpha^2 - 1) + 1, in float
  PLUS_D,   // the same, and no less than 0.0001 below the fraction
  NO_METAL  // kd = 1 - F, without (1 - m)
} mistake;

typedef struct look {
  const dfg *table;
  vec3 c;
  float metallic, roughness;
  mistake wrong;
} look;

// D as it is usually written.
static float usual_d(float nh, float alpha, float least) {
  float a2 = alpha * alpha, s = nh * nh * (a2 - 1) + 1;
  return a2 / fmaxf(PI * s * s, least);
}

// f(wo, wi) times the cosine of wi, for light from a point.
static vec3 lit(const look *k, vec3 n, vec3 wo, vec3 wi) {
  half_angles a = half_angles_of(n, wo, wi);
  if (!(a.nl > 0 && a.nv > 0)) return vec3_all(0);
  bsdf_rough b = bsdf_rough_of(k->table, k->c, k->metallic, k->roughness);
  b = bsdf_rough_under_point(&b);
  if (k->wrong == NO_METAL) b.terms.kd = k->c;
  dfg_pair l = dfg_lookup(k->table, a.nl, k->roughness);
  dfg_pair v = dfg_lookup(k->table, a.nv, k->roughness);
  float e_l = DIELECTRIC_F0 * l.c1 + l.c2, e_v = DIELECTRIC_F0 * v.c1 + v.c2;
  vec3 f = rough_specular(&b.terms, a);
  if (k->wrong == USUAL_D || k->wrong == PLUS_D) {
    float d = usual_d(a.nh, b.terms.alpha, k->wrong == PLUS_D ? 1e-4f : 0);
    f = vec3_scale(fresnel_schlick(b.terms.f0, a.oh), d * rough_v(&b.terms, a));
  }
  f = vec3_add(f, rough_diffuse(&b.terms, a, e_l, e_v));
  return vec3_scale(f, a.nl);
}

// A lamp of this chapter: a point in the frame of a unit ball, in W/sr.
typedef struct lamp {
  vec3 at, power;
} lamp;

static const lamp LAMPS[2] = {{{-2.2f, 2.6f, 2.4f}, {34, 32, 28}},
                              {{2.8f, -0.4f, 1.6f}, {4, 6, 10}}};

// The light that the point n of a unit ball sends along +z.
static vec3 ball_radiance(const look *k, vec3 n) {
  vec3 sum = {0.02f * k->c.x, 0.02f * k->c.y, 0.02f * k->c.z};
  for (int i = 0; i < 2; i++) {
    vec3 d = vec3_sub(LAMPS[i].at, n);
    float r2 = vec3_dot(d, d);
    vec3 f = lit(k, n, (vec3){0, 0, 1}, vec3_unit(d));
    sum = vec3_add(sum, vec3_scale(vec3_mul(f, LAMPS[i].power), 1 / r2));
  }
  return sum;
}

// The square x0..x1, y0..y1 in front of a ball, seen from +z, 5 x 5 points a
// pixel; each is clamped to white before the mean, so that a highlight's edge
// is smooth.
typedef struct frame {
  int side;
  float x0, y0, x1, y1;
  float gain;
} frame;

static image ball_picture(output *o, const look *k, frame f) {
  enum { FINE = 5 };
  image im = image_new(&o->mem, f.side, f.side);
  for (int i = 0; i < f.side * f.side; i++) {
    vec3 sum = {0, 0, 0};
    for (int j = 0; j < FINE * FINE; j++) {
      float u = (float)(i % f.side) + ((float)(j % FINE) + 0.5f) / FINE;
      float v = (float)(i / f.side) + ((float)(j / FINE) + 0.5f) / FINE;
      float x = f.x0 + (f.x1 - f.x0) * u / (float)f.side;
      float y = f.y1 - (f.y1 - f.y0) * v / (float)f.side, r2 = x * x + y * y;
      vec3 c = vec3_all(0.03f);
      if (r2 < 1) c = ball_radiance(k, (vec3){x, y, sqrtf(1 - r2)});
      sum = vec3_add(sum, vec3_min(vec3_scale(c, f.gain), vec3_all(1)));
    }
    im.pixels[i] = vec3_scale(sum, 1.0f / (FINE * FINE));
  }
  return im;
}

static const vec3 COPPER = {0.95f, 0.55f, 0.35f};
static const frame WHOLE = {64, -1.05f, -1.05f, 1.05f, 1.05f, 1};

// Roughness to the right, metallic downwards.
static void draw_grid(output *o) {
  enum { COLUMNS = 7, ROWS = 4 };
  const float rough[COLUMNS] = {0.08f, 0.2f, 0.35f, 0.5f, 0.65f, 0.8f, 1};
  image all = image_new(&o->mem, COLUMNS * WHOLE.side, ROWS * WHOLE.side);
  for (int i = 0; i < COLUMNS * ROWS; i++) {
    int x = i % COLUMNS, y = i / COLUMNS;
    look k = {&o->of[PBR_GGX], COPPER, (float)y / (ROWS - 1), rough[x], 0};
    image ball = ball_picture(o, &k, WHOLE);
    paste(all, ball, x * WHOLE.side, y * WHOLE.side);
  }
  publish(o->folder, "grid", all);
}

// A white sheet with grey lines: columns x rows of equal fields.
static image graph_paper(output *o, int side, int columns, int rows) {
  image im = paper(&o->mem, side, side);
  float w = (float)side - 1;
  for (int i = 0; i <= columns; i++) {
    float x = w * (float)i / (float)columns;
    draw_thin_line(im, (vec2){x, 0}, (vec2){x, w}, vec3_all(0.75f));
  }
  for (int i = 0; i <= rows; i++) {
    float y = w * (float)i / (float)rows;
    draw_thin_line(im, (vec2){0, y}, (vec2){w, y}, vec3_all(0.75f));
  }
  return im;
}

// A curve over the angle from 0 to 90 degrees; y in [0, 1] of the sheet.
typedef float curve(float turns, float parameter);

static void plot(image *im, curve *y, float parameter, vec3 color) {
  vec2 last = {0, 0};
  float w = (float)im->width - 1;
  for (int i = 0; i <= 2 * im->width; i++) {
    float t = (float)i / (float)(2 * im->width);
    vec2 at = {t * w, (1 - y(0.2499f * t, parameter)) * w};
    if (i > 0) draw_thin_line(*im, last, at, color);
    last.y++;
    if (i > 0) draw_thin_line(*im, last, (vec2){at.x, at.y + 1}, color);
    last = at;
  }
}

// D, four decades from 0.01 to 100.
static float d_curve(float turns, float roughness) {
  vec2 c = num_circle(turns);
  float d = ggx_d(c.y * c.y, c.x, roughness * roughness);
  return fmaxf(num_log2(d) / 3.3219281f + 2, 0) / 4;
}

// What is not shadowed or masked where light and viewer are at one angle.
static float g_curve(float turns, float roughness) {
  float c = num_circle(turns).x;
  return 4 * c * c * ggx_v(c, c, roughness * roughness);
}

static float g_report_curve(float turns, float roughness) {
  float c = num_circle(turns).x;
  return 4 * c * c * schlick_v(c, c, schlick_k_point(roughness));
}

static float f_curve(float turns, float f0) {
  return fresnel_schlick(vec3_all(f0), num_circle(turns).x).x;
}

static void draw_terms(output *o) {
  const float rough[4] = {0.25f, 0.5f, 0.75f, 1};
  const vec3 ink[4] = {
      {0.7f, 0, 0}, {0.6f, 0.25f, 0}, {0.05f, 0.35f, 0.1f}, {0, 0.1f, 0.6f}};
  const vec3 pale[4] = {
      {1, 0.6f, 0.6f}, {1, 0.7f, 0.4f}, {0.5f, 0.8f, 0.5f}, {0.55f, 0.6f, 1}};
  image p[3];
  for (int i = 0; i < 3; i++)
    p[i] = graph_paper(o, 155, 9, i == 0 ? 4 : 5);
  for (int i = 0; i < 4; i++) {
    plot(&p[0], d_curve, rough[i], ink[i]);
    plot(&p[1], g_report_curve, rough[i], pale[i]);
  }
  for (int i = 0; i < 4; i++)
    plot(&p[1], g_curve, rough[i], ink[i]);
  plot(&p[2], f_curve, DIELECTRIC_F0, vec3_all(0));
  plot(&p[2], f_curve, COPPER.x, (vec3){0.8f, 0, 0});
  plot(&p[2], f_curve, COPPER.y, (vec3){0, 0.4f, 0});
  plot(&p[2], f_curve, COPPER.z, (vec3){0, 0, 0.8f});
  image all = row_of(&o->mem, p, 3);
  publish(o->folder, "terms", all);
}

// The albedo of a white surface: the coat's by the table, the ground's by
// quadrature over lights in rings, as the path engine sees a sky.
static float furnace_albedo(const dfg *table, float metallic, float roughness,
                            float nv) {
  enum { RINGS = 96, TURNS = 48 };
  bsdf_rough b = bsdf_rough_of(table, vec3_all(1), metallic, roughness);
  dfg_pair v = dfg_lookup(table, nv, roughness);
  float e_v = DIELECTRIC_F0 * v.c1 + v.c2, f0 = b.terms.f0.x;
  vec3 wo = {sqrtf(fmaxf(0, 1 - nv * nv)), 0, nv};
  double sum = 0;
  for (int i = 0; i < RINGS; i++) {
    float z = sqrtf(((float)i + 0.5f) / RINGS), s = sqrtf(1 - z * z);
    dfg_pair l = dfg_lookup(table, z, roughness);
    float e_l = DIELECTRIC_F0 * l.c1 + l.c2;
    for (int k = 0; k < TURNS; k++) {
      vec2 c = num_circle(((float)k + 0.5f) / TURNS);
      vec3 wi = {s * c.x, s * c.y, z};
      half_angles a = half_angles_of((vec3){0, 0, 1}, wo, wi);
      sum += (double)rough_diffuse(&b.terms, a, e_l, e_v).x;
    }
  }
  return f0 * v.c1 + v.c2 + (float)sum * PI / (RINGS * TURNS);
}

// A ball in light of brightness 0.5 from everywhere: its albedo by the cosine.
static image furnace_ball(output *o, const dfg *table, float metallic,
                          float roughness) {
  enum { SIDE = 84, STEPS = 64 };
  float albedo[STEPS + 1];
  for (int i = 0; i <= STEPS; i++) {
    float x = fmaxf((float)i, 0.5f) / STEPS;
    albedo[i] = furnace_albedo(table, metallic, roughness, x * x);
  }
  image im = tinted(&o->mem, SIDE, SIDE, vec3_all(0.5f));
  for (int i = 0; i < SIDE * SIDE; i++) {
    float x = ((float)(i % SIDE) + 0.5f) / (0.46f * SIDE) - 1 / 0.92f;
    float y = ((float)(i / SIDE) + 0.5f) / (0.46f * SIDE) - 1 / 0.92f;
    float r2 = x * x + y * y;
    if (r2 >= 1) continue;
    float at = sqrtf(sqrtf(1 - r2)) * STEPS;
    int k = (int)at < STEPS ? (int)at : STEPS - 1;
    float t = at - (float)k;
    im.pixels[i] = vec3_all(0.5f * ((1 - t) * albedo[k] + t * albedo[k + 1]));
  }
  return im;
}

static void draw_furnace(output *o) {
  enum { COLUMNS = 5, ROWS = 3 };
  const float rough[COLUMNS] = {0.05f, 0.25f, 0.5f, 0.75f, 1};
  image all = image_new(&o->mem, COLUMNS * 84, ROWS * 84);
  for (int y = 0; y < ROWS; y++)
    for (int x = 0; x < COLUMNS; x++) {
      const dfg *table = &o->of[y == 0 ? PBR_REPORT : PBR_GGX];
      image ball = furnace_ball(o, table, y == 2, rough[x]);
      paste(all, ball, x * 84, y * 84);
    }
  publish(o->folder, "furnace", all);
  for (int i = 0; i < COLUMNS; i++) {
    printf("albedo, r %.2f: report", (double)rough[i]);
    for (int model = PBR_REPORT; model >= PBR_GGX; model--)
      printf(" %.3f %.3f %.3f%s",
             (double)furnace_albedo(&o->of[model], 0, rough[i], 0.05f),
             (double)furnace_albedo(&o->of[model], 0, rough[i], 0.25f),
             (double)furnace_albedo(&o->of[model], 0, rough[i], 1),
             model == PBR_REPORT ? "; ggx" : "");
    printf("; metal %.3f\n",
           (double)furnace_albedo(&o->of[PBR_GGX], 1, rough[i], 0.25f));
  }
  printf("report at NoV 0.03, r 0.01: %.2f\n",
         (double)furnace_albedo(&o->of[PBR_REPORT], 0, 0.01f, 0.03f));
}

// The upper lamp in a smooth dark ball, close by and much darker.
static void draw_digits(output *o) {
  const mistake wrong[3] = {NO_MISTAKE, USUAL_D, PLUS_D};
  vec3 n = {0, 0, 1};
  for (int i = 0; i < 30; i++) {
    vec3 wi = vec3_unit(vec3_sub(LAMPS[0].at, n));
    n = vec3_unit((vec3){wi.x, wi.y, wi.z + 1});
  }
  frame f = {150, n.x - 1e-3f, n.y - 1e-3f, n.x + 1e-3f, n.y + 1e-3f, 4e-5f};
  image parts[3];
  for (int i = 0; i < 3; i++) {
    look k = {&o->of[PBR_GGX], vec3_all(0.05f), 0, 0.02f, wrong[i]};
    parts[i] = ball_picture(o, &k, f);
  }
  image all = row_of(&o->mem, parts, 3);
  publish(o->folder, "digits", all);
}

// The report's own two balls, and its metal with light for the ground.
static void draw_metal(output *o) {
  frame f = WHOLE;
  f.side = 130;
  const dfg *table = &o->of[PBR_REPORT];
  look looks[3] = {{table, COPPER, 0.05f, 0.25f, NO_MISTAKE},
                   {table, COPPER, 0.9f, 0.6f, NO_MISTAKE},
                   {table, COPPER, 0.9f, 0.6f, NO_METAL}};
  image parts[3];
  double mean[3] = {0, 0, 0};
  for (int i = 0; i < 3; i++) {
    parts[i] = ball_picture(o, &looks[i], f);
    for (int k = 0; k < f.side * f.side; k++)
      mean[i] += (double)parts[i].pixels[k].y;
  }
  printf("kd without (1 - m): %.0f %% brighter\n",
         100 * (mean[2] / mean[1] - 1));
  image all = row_of(&o->mem, parts, 3);
  publish(o->folder, "metal", all);
}

// The bits of i in reverse, as a fraction.
static float van_der_corput(unsigned i) {
  float x = 0, step = 0.5f;
  for (; i > 0; i >>= 1, step *= 0.5f)
    if (i & 1) x += step;
  return x;
}

// A facet normal by D alone.
static vec3 any_normal(float alpha, float u1, float u2) {
  float t2 = alpha * alpha * u1 / (1 - u1), c = 1 / sqrtf(1 + t2);
  vec2 turn = num_circle(u2);
  float s = c * sqrtf(t2);
  return (vec3){s * turn.x, s * turn.y, c};
}

// Directions of a metal of roughness 0.7 seen at 80 degrees, on the disc of
// the hemisphere from above: by all facets, and by those that are seen.  The
// size of a dot is the weight; red: below the horizon, where its way leads out.
static void draw_normals(output *o) {
  enum { SIDE = 230, DOTS = 700, MANY = 1 << 20 };
  const vec3 wo = {-0.98480775f, 0, 0.17364818f};
  rough_terms s = {.alpha = 0.49f};
  image parts[2];
  for (int seen = 0; seen < 2; seen++) {
    parts[seen] = paper(&o->mem, SIDE, SIDE);
    double largest = 0, sum = 0, sum2 = 0;
    int lost = 0;
    for (unsigned i = 0; i < MANY; i++) {
      float u1 = ((float)i + 0.5f) / MANY, u2 = van_der_corput(i);
      if (i < DOTS) u1 = ((float)i + 0.5f) / DOTS;
      vec3 h = seen ? ggx_visible_normal(wo, s.alpha, u1, u2)
                    : any_normal(s.alpha, u1, u2);
      float oh = vec3_dot(wo, h);
      vec3 wi = vec3_sub(vec3_scale(h, 2 * oh), wo);
      half_angles a = half_angles_of((vec3){0, 0, 1}, wo, wi);
      float w = 0;
      if (wi.z > 0 && oh > 0)
        w = seen ? ggx_v(a.nl, a.nv, s.alpha) * a.nl /
                       ggx_g1_over_4nv(a.nv, s.alpha)
                 : 4 * ggx_v(a.nl, a.nv, s.alpha) * a.nl * oh / h.z;
      lost += !(w > 0);
      largest = fmax(largest, (double)w);
      sum += (double)w, sum2 += (double)(w * w);
      if (i >= DOTS) continue;
      float scale = wi.z > 0 ? 1 : 1.02f / sqrtf(wi.x * wi.x + wi.y * wi.y);
      float x = SIDE * (0.5f + 0.46f * scale * wi.x);
      float y = SIDE * (0.5f - 0.46f * scale * wi.y);
      float size = fminf(1.2f * sqrtf(fmaxf(w, 0.7f)), 6);
      for (float d = -size; d <= size; d++)
        draw_thin_line(
            parts[seen], (vec2){x - size, y + d}, (vec2){x + size, y + d},
            w > 0 ? (vec3){0.1f, 0.1f, 0.4f} : (vec3){0.9f, 0.1f, 0.05f});
    }
    printf("%s: %.1f %% lost, largest weight %.2f, variance %.3f\n",
           seen ? "visible normals" : "all normals", 100.0 * lost / MANY,
           largest, sum2 / MANY - sum / MANY * sum / MANY);
  }
  image all = row_of(&o->mem, parts, 2);
  publish(o->folder, "normals", all);
}

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// The error of D about the mirror direction by its two forms: the 90th
// percentile and the largest, over half vectors up to five widths away.
static void print_errors(void) {
  enum { N = 20000 };
  static const float rough[7] = {0.003f, 0.01f, 0.03f, 0.05f, 0.1f, 0.3f, 1};
  double e[2][N];
  for (int r = 0; r < 7; r++) {
    float alpha = rough[r] * rough[r];
    for (int i = 0; i < N; i++) {
      float u = ((float)i + 0.5f) / N, v = van_der_corput((unsigned)i);
      float tilt = fminf(5 * alpha * u, 1), sine = 2 * tilt / (1 + tilt * tilt);
      vec2 turn = num_circle(v);
      float c = (1 - tilt * tilt) / (1 + tilt * tilt);
      vec3 wo = {0.6f, 0, 0.8f};
      vec3 n = {sine * turn.x, sine * turn.y, c};
      vec3 wi = vec3_sub(vec3_scale(n, 2 * vec3_dot(wo, n)), wo);
      half_angles a = half_angles_of((vec3){0, 0, 1}, wo, wi);
      double x = (double)wo.x + (double)wi.x, y = (double)wo.y + (double)wi.y;
      double z = (double)wo.z + (double)wi.z,
             a2 = (double)alpha * (double)alpha;
      double c2 = z * z / (x * x + y * y + z * z), s2 = 1 - c2;
      s2 = (x * x + y * y) / (x * x + y * y + z * z);
      double want =
          a2 / (3.14159265358979324 * (s2 + a2 * c2) * (s2 + a2 * c2));
      e[0][i] = fabs((double)usual_d(a.nh, alpha, 0) / want - 1);
      e[1][i] = fabs((double)ggx_d(a.t, a.nh, alpha) / want - 1);
    }
    for (int k = 0; k < 2; k++)
      qsort(e[k], N, sizeof e[k][0], by_size);
    printf("D, r %.3f: usual %.1e %.1e, by t %.1e %.1e\n", (double)rough[r],
           e[0][N * 9 / 10], e[0][N - 1], e[1][N * 9 / 10], e[1][N - 1]);
  }
}

// Nanoseconds for one call of each of the triple.
static void print_times(output *o) {
  enum { N = 2000000 };
  const char *names[3] = {"eval", "pdf", "sample"};
  for (int k = 0; k < 3; k++) {
    bsdf_rough b = bsdf_rough_of(&o->of[PBR_GGX], COPPER, 0, 0.4f);
    const vec3 wo = {0.6f, 0, 0.8f};
    double start = clock_seconds(), sum = 0;
    for (unsigned i = 0; i < N; i++) {
      float u = ((float)i + 0.5f) / N;
      vec3 wi = {-0.6f, 0.8f * u, sqrtf(0.64f - 0.64f * u * u)}, weight = wi;
      if (k == 0) sum += (double)bsdf_rough_eval(&b, wo, wi).x;
      if (k == 1) sum += (double)bsdf_rough_pdf(&b, wo, wi);
      if (k == 2 &&
          bsdf_rough_sample(&b, wo, (float[]){u, 0.4f, u}, &wi, &weight))
        sum += (double)weight.x;
    }
    if (!(sum > 0)) exit(4);
    printf("%s: %.0f ns\n", names[k], (clock_seconds() - start) / N * 1e9);
  }
}

int main(int argc, char **argv) {
  if (argc != 2) return 2;
  output o = {.folder = argv[1]};
  for (int model = PBR_GGX; model <= PBR_REPORT; model++)
    dfg_build(&o.of[model], (pbr_model)model, &o.mem, NULL);
  draw_grid(&o);
  draw_terms(&o);
  draw_furnace(&o);
  draw_digits(&o);
  draw_metal(&o);
  draw_normals(&o);
  print_errors();
  print_times(&o);
  arena_free(&o.mem);
  return 0;
}

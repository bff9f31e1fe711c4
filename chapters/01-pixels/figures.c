// figures.c — the pictures of chapter 1, and the numbers its text quotes.

#include "../easel.h"
#include "hdr.h"
#include "metric.h"
#include "pfm.h"
#include "png.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

// Where the pictures go.
typedef struct output {
  const char *folder;
  arena mem;
} output;

// The light of an 8-bit code.
static float light_of_code(double code) {
  return (float)srgb_decode(code / 255);
}

// Fill a rectangle.
static void fill(image im, int x0, int y0, int width, int height, vec3 c) {
  for (int y = y0; y < y0 + height; y++)
    for (int x = x0; x < x0 + width; x++)
      *pixel(im, x, y) = c;
}

// Two ramps in 24 steps and smooth: equal steps of light above, equal steps
// of code below.
static void draw_ramps(output *o) {
  image im = paper(&o->mem, 480, 200);
  for (int x = 0; x < 480; x++) {
    float u = (float)x / 479, step = (float)(x / 20) / 23;
    fill(im, x, 0, 1, 48, vec3_all(u));
    fill(im, x, 48, 1, 48, vec3_all(step));
    fill(im, x, 104, 1, 48, vec3_all(light_of_code(255 * (double)step)));
    fill(im, x, 152, 1, 48, vec3_all(light_of_code(255 * (double)u)));
  }
  publish(o->folder, "ramp", im);
  srgb_table t = srgb_table_new();
  printf("code of half the light: %d; light of code 128: %.4f\n",
         srgb_code(&t, 0.5f), (double)light_of_code(128));
  printf("codes for the darkest 1 %% of light: %d of sRGB, %d of light\n",
         srgb_code(&t, 0.01f), (int)(255 * 0.01 + 0.5));
}

// The zone plate: rings whose spacing shrinks with the radius.  Two samples a
// ring are reached at 58 pixels from the centre.
static double zone_plate(double x, double y) {
  double r2 = (x - 116) * (x - 116) + (y - 116) * (y - 116);
  return 0.5 + 0.5 * cos(3.14159265358979 / 116 * r2);
}

// The plate with a grid of n x n samples a pixel.
static image sampled_plate(arena *mem, int n) {
  image im = image_new(mem, 232, 232);
  for (int y = 0; y < 232; y++)
    for (int x = 0; x < 232; x++) {
      double sum = 0;
      for (int i = 0; i < n * n; i++)
        sum += zone_plate(x + (i % n + 0.5) / n, y + (i / n + 0.5) / n);
      *pixel(im, x, y) = vec3_all((float)(sum / (n * n)));
    }
  return im;
}

// Point samples beside area samples, and the error of each number of samples.
static void draw_zone_plates(output *o) {
  image im = paper(&o->mem, 472, 232);
  paste(im, sampled_plate(&o->mem, 1), 0, 0);
  paste(im, sampled_plate(&o->mem, 8), 240, 0);
  publish(o->folder, "zone", im);
  image exact = sampled_plate(&o->mem, 32);
  for (int n = 1; n <= 16; n *= 2) {
    image some = sampled_plate(&o->mem, n);
    metric m = metric_compare(&some, &exact, &o->mem);
    printf("zone plate, %3d samples: rmse %.5f, psnr %.1f dB\n", n * n, m.rmse,
           m.psnr);
  }
}

// A lamp, a sky and a ball, in radiance: x, y in [-1, 1].
static vec3 scene_light(float x, float y) {
  float lamp = (x - 0.55f) * (x - 0.55f) + (y + 0.62f) * (y + 0.62f);
  if (lamp < 0.02f) return (vec3){60, 52, 40};
  float d2 = x * x / 0.36f + (y - 0.25f) * (y - 0.25f) / 0.36f;
  if (d2 >= 1) {
    if (y > 0.6f) return (vec3){0.05f, 0.06f, 0.03f};
    return vec3_lerp((vec3){0.12f, 0.25f, 0.6f}, (vec3){0.5f, 0.6f, 0.7f},
                     fmaxf(0, y + 0.2f));
  }
  vec3 n = {x / 0.6f, -(y - 0.25f) / 0.6f, sqrtf(1 - d2)};
  vec3 h = vec3_unit((vec3){0.45f, 0.7f, 0.9f});
  float cosine = fmaxf(0, vec3_dot(n, vec3_unit((vec3){0.6f, 0.7f, 0.4f})));
  float shine = powf(fmaxf(0, vec3_dot(n, h)), 400) * 30;
  vec3 base = vec3_scale((vec3){0.5f, 0.08f, 0.05f}, 0.05f + 1.5f * cosine);
  return vec3_add(base, vec3_all(shine));
}

// The same radiance at five exposures, three stops apart.
static void draw_exposures(output *o) {
  image im = paper(&o->mem, 480, 112);
  for (int k = 0; k < 5; k++)
    for (int y = 0; y < 112; y++)
      for (int x = 0; x < 92; x++) {
        vec3 light =
            scene_light(((float)x - 45.5f) / 56, ((float)y - 55.5f) / 56);
        *pixel(im, 97 * k + x, y) = vec3_scale(light, ldexpf(1, 3 * k - 6));
      }
  publish(o->folder, "exposure", im);
}

// A dark ramp stored as eight bits of light, then as eight bits of code, and
// shown brighter, as a display does with a dark picture in a dark room.
static void draw_bands(output *o) {
  image im = paper(&o->mem, 480, 168);
  srgb_table t = srgb_table_new();
  for (int x = 0; x < 480; x++) {
    float light = 0.04f * (float)x / 479;
    float as_light = (float)(int)(255 * light + 0.5f) / 255;
    float as_code = light_of_code(srgb_code(&t, light));
    fill(im, x, 0, 1, 80, vec3_all(as_light * 16));
    fill(im, x, 88, 1, 80, vec3_all(as_code * 16));
  }
  publish(o->folder, "bands", im);
}

// A fan of white lines on black, eight times as large as it will be shown.
static image line_fan(arena *mem, int side) {
  image im = image_new(mem, side, side);
  for (int y = 0; y < side; y++)
    for (int x = 0; x < side; x++) {
      double dx = x + 0.5, dy = side - y - 0.5, r = sqrt(dx * dx + dy * dy);
      double angle = atan2(dy, dx) * 32 / 3.14159265358979;
      double off = (angle - floor(angle + 0.5)) * 3.14159265358979 / 32 * r;
      bool on = fabs(off) < 3 && r < 0.97 * side && r > 0.25 * side;
      *pixel(im, x, y) = vec3_all(on ? 1 : 0);
    }
  return im;
}

// Shrink by eight: the mean of the light, or the mean of the codes.
static image shrunk(arena *mem, image big, bool by_code) {
  image im = image_new(mem, big.width / 8, big.height / 8);
  for (int y = 0; y < im.height; y++)
    for (int x = 0; x < im.width; x++) {
      double sum = 0;
      for (int i = 0; i < 64; i++) {
        double light = (double)pixel(big, 8 * x + i % 8, 8 * y + i / 8)->x;
        sum += by_code ? srgb_encode(light) : light;
      }
      double mean = by_code ? srgb_decode(sum / 64) : sum / 64;
      *pixel(im, x, y) = vec3_all((float)mean);
    }
  return im;
}

// The mean light of a grey image.
static double mean_light(image im) {
  double sum = 0;
  for (int i = 0; i < im.width * im.height; i++)
    sum += (double)im.pixels[i].x;
  return sum / im.width / im.height;
}

// Mixing light against mixing codes: a gradient of two colours, and thin
// lines made small.
static void draw_mixing(output *o) {
  image im = paper(&o->mem, 480, 316);
  vec3 red = {1, 0.02f, 0.02f}, green = {0.02f, 0.8f, 0.02f};
  for (int x = 0; x < 480; x++) {
    double u = x / 479.0;
    vec3 c;
    c.x = (float)srgb_decode((1 - u) * srgb_encode((double)red.x) +
                             u * srgb_encode((double)green.x));
    c.y = (float)srgb_decode((1 - u) * srgb_encode((double)red.y) +
                             u * srgb_encode((double)green.y));
    c.z = (float)srgb_decode(srgb_encode((double)red.z));
    fill(im, x, 0, 1, 32, vec3_lerp(red, green, (float)u));
    fill(im, x, 36, 1, 32, c);
  }
  image big = line_fan(&o->mem, 236 * 8);
  image good = shrunk(&o->mem, big, false), bad = shrunk(&o->mem, big, true);
  paste(im, good, 0, 76);
  paste(im, bad, 244, 76);
  publish(o->folder, "mixing", im);
  printf("light of the lines: %.4f large, %.4f by light, %.4f by code\n",
         mean_light(big), mean_light(good), mean_light(bad));
}

// A value through a shared exponent, rounded down as older writers do.
static double cut_off(double x) {
  int e;
  frexp(x, &e);
  return ldexp(floor(ldexp(x, 8 - e)), e - 8);
}

// Plot the relative error of greys over two doublings of light into a panel of
// 460 x 101 whose middle is 0 and whose edges are 1/128: for each of 46 columns
// a bar from the least to the greatest error, and the mean.
static void plot_error(image im, int y0, const double *errors, int n) {
  fill(im, 10, y0, 460, 101, vec3_all(0.9f));
  fill(im, 10, y0 + 50, 460, 1, vec3_all(0.4f));
  fill(im, 239, y0, 2, 101, vec3_all(0.4f));
  for (int column = 0; column < 46; column++) {
    double low = 1, high = -1, sum = 0;
    for (int i = column * n / 46; i < (column + 1) * n / 46; i++) {
      low = fmin(low, errors[i]);
      high = fmax(high, errors[i]);
      sum += errors[i];
    }
    int top = y0 + 50 - (int)lround(high * 128 * 50);
    int bottom = y0 + 50 - (int)lround(low * 128 * 50);
    int mean = y0 + 50 - (int)lround(sum / (n / 46) * 128 * 50);
    vec3 red = {0.8f, 0.2f, 0.15f}, dark = {0.1f, 0, 0};
    fill(im, 11 + 10 * column, top, 8, bottom - top + 1, red);
    fill(im, 11 + 10 * column, mean, 8, 1, dark);
  }
}

// Rounding to nearest above, cutting off below.
static void draw_rgbe(output *o) {
  enum { N = 46000 };
  image im = paper(&o->mem, 480, 220), grey = image_new(&o->mem, N, 1), back;
  double *errors = ARENA_NEW(&o->mem, double, N), sums[2] = {0};
  for (int i = 0; i < N; i++)
    grey.pixels[i] = vec3_all((float)exp2(2.0 * i / N));
  FILE *f = tmpfile();
  error err;
  if (f == NULL || !hdr_save(&grey, f, "greys", &err) ||
      fseek(f, 0, SEEK_SET) != 0 || !hdr_load(&back, f, "greys", &o->mem, &err))
    exit(4);
  fclose(f);
  for (int side = 0; side < 2; side++) {
    for (int i = 0; i < N; i++) {
      double x = (double)grey.pixels[i].x;
      double y = side == 0 ? (double)back.pixels[i].x : cut_off(x);
      errors[i] = y / x - 1;
      sums[side] += errors[i] / N;
    }
    plot_error(im, 5 + 109 * side, errors, N);
  }
  publish(o->folder, "rgbe", im);
  printf("mean relative error of RGBE: %.1e rounded, %.1e cut off\n", sums[0],
         sums[1]);
}

// Uniform noise of mean 0 and variance 1.
static float noise(uint32_t *state) {
  *state = *state * 1664525u + 1013904223u;
  return ((float)(*state >> 8) / 16777216 - 0.5f) * 3.46410162f;
}

// A dark gradient with a bright disc: what the four damaged pictures should be.
static image clean_picture(arena *mem) {
  image im = image_new(mem, 117, 117);
  for (int y = 0; y < 117; y++)
    for (int x = 0; x < 117; x++) {
      bool disc = (x - 80) * (x - 80) + (y - 40) * (y - 40) < 25 * 25;
      float dark = 0.01f + 0.2f * (float)(116 - y) / 116;
      *pixel(im, x, y) = vec3_all(disc ? 0.9f : dark);
    }
  return im;
}

// Damage number `kind` to a pixel: an offset, noise everywhere, noise on the
// disc only, one pixel far too bright.
static float damage(int kind, int x, int y, uint32_t *state) {
  bool disc = (x - 80) * (x - 80) + (y - 40) * (y - 40) < 25 * 25;
  switch (kind) {
  case 0: return 1;
  case 1: return noise(state);
  case 2: return disc ? noise(state) : 0;
  default: return x == 30 && y == 70;
  }
}

// Four pictures with the same RMSE.
static void draw_damage(output *o) {
  const char *names[] = {"offset", "noise", "noise on the disc", "one pixel"};
  image im = paper(&o->mem, 480, 117), clean = clean_picture(&o->mem);
  for (int kind = 0; kind < 4; kind++) {
    image bad = clean_picture(&o->mem), unit = image_new(&o->mem, 117, 117);
    uint32_t state = 1;
    double square = 0;
    for (int i = 0; i < 117 * 117; i++) {
      unit.pixels[i] = vec3_all(damage(kind, i % 117, i / 117, &state));
      square += (double)(unit.pixels[i].x * unit.pixels[i].x);
    }
    float size = 0.05f / (float)sqrt(square / (117 * 117));
    for (int i = 0; i < 117 * 117; i++)
      bad.pixels[i] = vec3_mad(bad.pixels[i], size, unit.pixels[i]);
    paste(im, bad, 121 * kind, 0);
    metric m = metric_compare(&bad, &clean, &o->mem);
    printf("%-17s rmse %.3f  relmse %.4f  mean %+.4f  p99.9 %.3f  max %.3f\n",
           names[kind], m.rmse, m.relmse, m.mean, m.p999, m.max);
  }
  publish(o->folder, "damage", im);
}

// Seconds of processor time.
static double seconds(void) {
  return (double)clock() / CLOCKS_PER_SEC;
}

// Write and read the exposed scene in each format: bytes a pixel, error, time.
static void measure_formats(output *o) {
  const char *names[] = {"PNG 8", "PNG 16", "Radiance", "PFM"};
  image im = image_new(&o->mem, 1280, 720);
  for (int i = 0; i < 1280 * 720; i++) {
    float x = (float)(i % 1280) / 640 - 1, y = (float)(i / 1280) / 360 - 1;
    im.pixels[i] = vec3_min(scene_light(x, y), vec3_all(1));
  }
  for (int k = 0; k < 4; k++) {
    FILE *f = tmpfile();
    error err;
    pixmap map;
    image back;
    if (f == NULL) exit(4);
    double start = seconds();
    bool ok = k < 2    ? png_save(&im, 8 * (k + 1), f, "p", &err)
              : k == 2 ? hdr_save(&im, f, "p", &err)
                       : pfm_save(&im, f, "p", &err);
    double written = seconds(), size = (double)ftell(f);
    rewind(f);
    ok = ok && (k < 2    ? png_load(&map, f, "p", &o->mem, &err)
                : k == 2 ? hdr_load(&back, f, "p", &o->mem, &err)
                         : pfm_load(&back, f, "p", &o->mem, &err));
    if (!ok) exit(4);
    if (k < 2) back = image_from_pixmap(&o->mem, &map, true);
    double read = seconds();
    metric m = metric_compare(&back, &im, &o->mem);
    printf(
        "%-8s  %5.2f bytes/pixel, max error %.1e, %3.0f ms out, %3.0f ms in\n",
        names[k], size / (1280 * 720), m.max, 1e3 * (written - start),
        1e3 * (read - written));
    fclose(f);
  }
}

int main(int argc, char **argv) {
  output o = {.folder = argc > 1 ? argv[1] : "."};
  draw_ramps(&o);
  draw_zone_plates(&o);
  draw_exposures(&o);
  draw_bands(&o);
  draw_mixing(&o);
  draw_rgbe(&o);
  draw_damage(&o);
  measure_formats(&o);
  arena_free(&o.mem);
  return 0;
}

// image.c

#include "image.h"

bool image_fits(int width, int height, uint64_t file_bytes) {
  uint64_t pixels = (uint64_t)width * (uint64_t)height;
  return pixels <= IMAGE_FREE_PIXELS ||
         pixels / IMAGE_BYTE_PIXELS <= file_bytes;
}

image image_new(arena *a, int width, int height) {
  size_t n = (size_t)width * (size_t)height;
  return (image){width, height, ARENA_NEW(a, vec3, n)};
}

bool image_parse_side(const char *text, int *side) {
  int value = 0;
  const char *c = text;
  for (; *c >= '0' && *c <= '9'; c++) {
    value = 10 * value + (*c - '0');
    if (value > IMAGE_MAX_SIDE) return false;
  }
  if (*c != '\0' || value == 0) return false;
  *side = value;
  return true;
}

double srgb_encode(double x) {
  return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
}

double srgb_decode(double y) {
  return y <= 0.04045 ? y / 12.92 : pow((y + 0.055) / 1.055, 2.4);
}

// The smallest float x with srgb_encode(x) >= y: a guess by the inverse, then
// steps to the neighbouring floats.
static float srgb_threshold(double y) {
  float x = (float)srgb_decode(y);
  while (srgb_encode((double)x) >= y)
    x = nextafterf(x, 0);
  while (srgb_encode((double)x) < y)
    x = nextafterf(x, 2);
  return x;
}

srgb_table srgb_table_new(void) {
  srgb_table t;
  for (int k = 0; k < 255; k++)
    t.threshold[k] = srgb_threshold((k + 0.5) / 255);
  return t;
}

uint8_t srgb_code(const srgb_table *t, float x) {
  int code = 0;
  for (int step = 128; step > 0; step /= 2)
    if (code + step <= 255 && x >= t->threshold[code + step - 1]) code += step;
  return (uint8_t)code;
}

uint16_t srgb_code16(float x) {
  if (!(x > 0)) return 0;  // also NaN
  if (x >= 1) return 65535;
  return (uint16_t)(65535 * srgb_encode((double)x) + 0.5);
}

// The value of each of the codes 0..top, as linear light when decode.
static float *value_table(arena *a, int top, bool decode) {
  float *table = ARENA_NEW(a, float, (size_t)top + 1);
  for (int k = 0; k <= top; k++) {
    double y = (double)k / top;
    table[k] = (float)(decode ? srgb_decode(y) : y);
  }
  return table;
}

// Sample i of p, whatever its depth.
static int pixmap_sample(const pixmap *p, size_t i) {
  if (p->depth == 16) return ((const uint16_t *)p->samples)[i];
  return ((const uint8_t *)p->samples)[i];
}

image image_from_pixmap(arena *a, const pixmap *p, bool decode) {
  arena scratch = {0};
  const float *value =
      value_table(&scratch, p->depth == 16 ? 65535 : 255, decode);
  image im = image_new(a, p->width, p->height);
  size_t n = (size_t)p->width * (size_t)p->height;
  size_t channels = (size_t)p->channels;
  bool grey = channels < 3;
  for (size_t i = 0; i < n; i++) {
    float x = value[pixmap_sample(p, i * channels)];
    im.pixels[i] = vec3_all(x);
    if (grey) continue;
    im.pixels[i].y = value[pixmap_sample(p, i * channels + 1)];
    im.pixels[i].z = value[pixmap_sample(p, i * channels + 2)];
  }
  arena_free(&scratch);
  return im;
}

// num.c — Taylor series after an exact reduction of the argument: nothing but
// +, -, * and /, which IEEE 754 rounds the same way everywhere.

#include "num.h"

#include <stdint.h>
#include <string.h>

// 1 / (2 pi).

vec2 num_circle(float u) {
  // The rest in [-1/8, 1/8] turns is exact: u and quarter / 4 are within a
  // factor 2.
  float quarter = float_floor(u * 4 + 0.5f);
  vec2 r = num_octant_circle((u - quarter * 0.25f) * (2 * PI));
  switch ((int)quarter & 3) {
  case 0: return r;
  case 1: return (vec2){-r.y, r.x};
  case 2: return (vec2){-r.x, -r.y};
  default: return (vec2){r.y, -r.x};
  }
}

// log2 of a finite x > 0, to 1e-12, in double precision: a power needs its
// logarithm to 1e-9, as an error is multiplied by up to 128 ln 2.  With m in
// [sqrt(1/2), sqrt(2)) and s = (m - 1) / (m + 1), ln m = 2 (s + s^3/3 + ...).
static double log2_in_double(float x) {
  double wide = (double)x;  // also a denormal float is a normal double
  uint64_t bits;
  memcpy(&bits, &wide, sizeof bits);
  int exponent = (int)(bits >> 52) - 1023;
  bits = (bits & 0xfffffffffffff) | (UINT64_C(1023) << 52);
  double m;
  memcpy(&m, &bits, sizeof m);
  if (m >= 1.4142135623730951) {
    m *= 0.5;
    exponent++;
  }
  double s = (m - 1) / (m + 1), s2 = s * s;
  double series =
      1 +
      s2 * (1.0 / 3 +
            s2 * (1.0 / 5 +
                  s2 * (1.0 / 7 + s2 * (1.0 / 9 + s2 * (1.0 / 11 + s2 / 13)))));
  return exponent + s * series * 2.8853900817779268;  // 2 / ln 2
}

// 2^y rounded to float: 2^n by writing the exponent, 2^f for |f| <= 1/2 by the
// series of exp(f ln 2), relative error 1e-11.
static float exp2_of_double(double y) {
  if (!(y > -151)) return y <= -151 ? 0 : NAN;
  if (y >= 128) return INFINITY;
  double n = floor(y + 0.5), x = (y - n) * 0.69314718055994531;
  double term = 1, sum = 1;
  for (int k = 1; k <= 10; k++) {
    term *= x / k;
    sum += term;
  }
  uint64_t bits = (uint64_t)((int64_t)n + 1023) << 52;
  double power;
  memcpy(&power, &bits, sizeof power);
  return (float)(sum * power);
}

float num_log2(float x) {
  if (x == 0) return -INFINITY;
  if (!(x < INFINITY)) return x;
  return (float)log2_in_double(x);
}

float num_exp2(float x) {
  return exp2_of_double((double)x);
}

float num_pow(float x, float y) {
  if (y == 0) return 1;
  if (x == 0) return y > 0 ? 0 : INFINITY;
  if (!(x < INFINITY)) return y > 0 ? x : 0;
  return exp2_of_double((double)y * log2_in_double(x));
}

float num_turns(float y, float x) {
  float ax = fabsf(x), ay = fabsf(y);
  if (!(ax > 0 || ay > 0)) return 0;
  float t =
      ay <= ax ? num_octant_turns(ay, ax) : 0.25f - num_octant_turns(ax, ay);
  if (x < 0) t = 0.5f - t;
  if (y < 0) t = 1 - t;
  return t < 1 ? t : 0;
}

float num_acos_pi(float x) {
  x = float_min(float_max(x, -1), 1);
  // cos a = x gives tan(a / 2) = sqrt((1 - x) / (1 + x)), well behaved at 1.
  return 4 * num_turns(sqrtf(1 - x), sqrtf(1 + x));
}

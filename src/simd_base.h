// simd_base.h — eight floats in two registers, with what every processor of the
// architecture has: GCC's vector types.  See simd.h.

#ifndef SIMD_BASE_H
#define SIMD_BASE_H

#include <stdint.h>
#include <string.h>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

// Known to the compiler where it is used, at any optimisation.
#define SIMD static inline __attribute__((always_inline))

// Never part of its caller, which then has more registers.
#define APART static __attribute__((noinline))

// Four floats and four integers.
typedef float f4 __attribute__((vector_size(16)));
typedef int32_t i4 __attribute__((vector_size(16)));

// a where m, else b, lane by lane.
SIMD f4 f4_pick(i4 m, f4 a, f4 b) {
  return (f4)((m & (i4)a) | (~m & (i4)b));
}

SIMD f4 f4_abs(f4 a) {
  return (f4)((i4)a & INT32_MAX);
}

// Bit k: the sign of lane k.
SIMD uint32_t i4_bits(i4 m) {
#if defined(__x86_64__)
  return (uint32_t)_mm_movemask_ps((__m128)m);
#else
  uint32_t b[4];
  memcpy(b, &m, sizeof b);
  return (b[0] & 1) | (b[1] & 2) | (b[2] & 4) | (b[3] & 8);
#endif
}

#if !defined(__AVX2__)

typedef struct f8 {
  f4 a, b;
} f8;

SIMD f8 f8_load(const float *p) {
  f8 r;
  memcpy(&r.a, p, 16);
  memcpy(&r.b, p + 4, 16);
  return r;
}

SIMD f8 f8_all(float x) {
  f4 v = {x, x, x, x};
  return (f8){v, v};
}

SIMD void f8_store(float *p, f8 a) {
  memcpy(p, &a.a, 16);
  memcpy(p + 4, &a.b, 16);
}

SIMD f8 f8_of_bytes(const uint8_t *p) {
  i4 a = {p[0], p[1], p[2], p[3]}, b = {p[4], p[5], p[6], p[7]};
  return (f8){__builtin_convertvector(a, f4), __builtin_convertvector(b, f4)};
}

// a b + c; asked only where a b is exact.
SIMD f8 f8_mad(f8 a, f8 b, f8 c) {
  return (f8){a.a * b.a + c.a, a.b * b.b + c.b};
}

SIMD f8 f8_add(f8 a, f8 b) {
  return (f8){a.a + b.a, a.b + b.b};
}

SIMD f8 f8_sub(f8 a, f8 b) {
  return (f8){a.a - b.a, a.b - b.b};
}

SIMD f8 f8_mul(f8 a, f8 b) {
  return (f8){a.a * b.a, a.b * b.b};
}

SIMD f8 f8_div(f8 a, f8 b) {
  return (f8){a.a / b.a, a.b / b.b};
}

SIMD f8 f8_abs(f8 a) {
  return (f8){f4_abs(a.a), f4_abs(a.b)};
}

SIMD f8 f8_max(f8 a, f8 b) {
  return (f8){f4_pick(a.a > b.a, a.a, b.a), f4_pick(a.b > b.b, a.b, b.b)};
}

SIMD f8 f8_min(f8 a, f8 b) {
  return (f8){f4_pick(a.a < b.a, a.a, b.a), f4_pick(a.b < b.b, a.b, b.b)};
}

// x where a < b, else y, lane by lane.
SIMD f8 f8_where_lt(f8 a, f8 b, f8 x, f8 y) {
  return (f8){f4_pick(a.a < b.a, x.a, y.a), f4_pick(a.b < b.b, x.b, y.b)};
}

SIMD uint32_t f8_le(f8 a, f8 b) {
  return i4_bits(a.a <= b.a) | i4_bits(a.b <= b.b) << 4;
}

SIMD uint32_t f8_lt(f8 a, f8 b) {
  return i4_bits(a.a < b.a) | i4_bits(a.b < b.b) << 4;
}

#endif

#endif

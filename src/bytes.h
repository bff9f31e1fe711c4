// bytes.h — numbers as bytes, the least significant first, on any machine.

#ifndef BYTES_H
#define BYTES_H

#include <stdint.h>
#include <string.h>

static inline void bytes_put_u64(uint8_t **at, uint64_t x) {
  for (int i = 0; i < 8; i++)
    *(*at)++ = (uint8_t)(x >> 8 * i & 255);
}

static inline void bytes_put_u32(uint8_t **at, uint32_t x) {
  for (int i = 0; i < 4; i++)
    *(*at)++ = (uint8_t)(x >> 8 * i & 255);
}

static inline void bytes_put_f64(uint8_t **at, double x) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  bytes_put_u64(at, bits);
}

static inline void bytes_put_f32(uint8_t **at, float x) {
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  bytes_put_u32(at, bits);
}

static inline uint64_t bytes_get_u64(const uint8_t **at) {
  uint64_t x = 0;
  for (int i = 0; i < 8; i++)
    x |= (uint64_t) * (*at)++ << 8 * i;
  return x;
}

static inline uint32_t bytes_get_u32(const uint8_t **at) {
  uint32_t x = 0;
  for (int i = 0; i < 4; i++)
    x |= (uint32_t) * (*at)++ << 8 * i;
  return x;
}

static inline double bytes_get_f64(const uint8_t **at) {
  uint64_t bits = bytes_get_u64(at);
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

static inline float bytes_get_f32(const uint8_t **at) {
  uint32_t bits = bytes_get_u32(at);
  float x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

#endif

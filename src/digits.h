// digits.h — up to eight decimal digits at once.

#ifndef DIGITS_H
#define DIGITS_H

#include <stdint.h>

// Bytes that must be readable at the address given to digits_take.
enum { DIGITS_READ = 8 };

// The value of the decimal digits at p, at most eight of them, and their
// number.  Reads DIGITS_READ bytes whatever they hold.
//
// The eight bytes become one integer with the first byte lowest.  Taking '0'
// off each leaves 0..9 for digits; adding 0x76 then sets the top bit of
// everything else (a carry can only spoil bytes behind the first non-digit).
// A shift drops what follows the digits and fills zeros in front of them, and
// three multiplications join neighbours: digits, pairs, fours.
static inline unsigned digits_take(const char *p, uint32_t *value) {
  const unsigned char *b = (const unsigned char *)p;
  uint64_t v = (uint64_t)b[0] | (uint64_t)b[1] << 8 | (uint64_t)b[2] << 16 |
               (uint64_t)b[3] << 24 | (uint64_t)b[4] << 32 |
               (uint64_t)b[5] << 40 | (uint64_t)b[6] << 48 |
               (uint64_t)b[7] << 56;
  v ^= 0x3030303030303030u;
  uint64_t other = ((v + 0x7676767676767676u) | v) & 0x8080808080808080u;
  unsigned n = 8;
  if (other != 0) {
    n = (unsigned)__builtin_ctzll(other) / 8;
    if (n == 0) return 0;
    v <<= 64 - 8 * n;
  }
  v = (v * 10 + (v >> 8)) & 0x00ff00ff00ff00ffu;
  v = (v * 100 + (v >> 16)) & 0x0000ffff0000ffffu;
  v = v * 10000 + (v >> 32);
  *value = (uint32_t)v;
  return n;
}

// 10 to the power n <= 8.
static inline uint32_t digits_power(unsigned n) {
  static const uint32_t power[9] = {1,      10,      100,      1000,     10000,
                                    100000, 1000000, 10000000, 100000000};
  return power[n];
}

#endif

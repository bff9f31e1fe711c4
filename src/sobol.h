// sobol.h — a sequence that fills the unit cube evenly at every length, and
// the scrambling that makes it random without making it uneven.
//
// A point is handled as its binary digits behind the point in reading order:
// bit k of the 32 is the digit worth 2^-(k+1).

#ifndef SOBOL_H
#define SOBOL_H

#include <stdint.h>

enum { SOBOL_DIMENSIONS = 8, SOBOL_BITS = 32, SOBOL_ROW = 20 };

// Row k, column d: the digits of dimension d that bit k of the index flips, of
// which digit k is the last.  The first two are Sobol's; dimensions 2i and 2i +
// 1 together are a (0, 2) sequence: each aligned run of 2^m points has one in
// every box of size 2^-m. Behind the eight, the first four three times over.
// Source: Sobol' 1967.
extern const uint32_t SOBOL_COLUMNS[SOBOL_BITS][SOBOL_ROW];

// The digits of point `index`.
static inline uint32_t sobol_digits(uint32_t index, uint32_t dimension) {
  uint32_t digits = 0;
  for (int k = 0; index != 0; k++, index >>= 1)
    digits ^= SOBOL_COLUMNS[k][dimension] & (0 - (index & 1));
  return digits;
}

// Owen's scrambling by a hash: each digit is flipped or not, as a function of
// the seed and of the digits before it.  Carries run only towards later
// digits, which is what makes it one.  Source: Laine and Karras 2011, section
// 3.1; the constants of Vegdahl 2021.
static inline uint32_t sobol_scramble(uint32_t digits, uint32_t seed) {
  digits ^= digits * 0x3d20adeau;
  digits += seed;
  digits *= (seed >> 16) | 1;
  digits ^= digits * 0x05526c56u;
  digits ^= digits * 0x53a22864u;
  return digits;
}

// The same, but that points 0 to 3 stay half or a quarter apart, as they are
// unscrambled: the first two digits are flipped whatever they are, and those
// behind them up to the first 1 as they are behind any other two.
static inline uint32_t sobol_turn(uint32_t digits, uint32_t seed) {
  uint32_t rest = digits & ~3u, same = rest ^ (rest - 1);
  return (sobol_scramble(digits, seed) & ~same) | ((digits ^ seed) & same);
}

// The 32 bits in reverse.
static inline uint32_t sobol_reverse(uint32_t x) {
  x = (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
  x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
  x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
  x = (x & 0x00ff00ffu) << 8 | (x >> 8 & 0x00ff00ffu);
  return x << 16 | x >> 16;
}

// The number in [0, 1) that the first 24 digits are.
static inline float sobol_number(uint32_t digits) {
  return (float)(sobol_reverse(digits) >> 8) * 0x1p-24f;
}

#endif

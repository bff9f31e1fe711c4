// number.c

#include "number.h"

#include <errno.h>
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Digits that a uint64 holds whatever they are.
enum { WORD_DIGITS = 19 };

// Digits that reach strtof.  The midpoint of two floats has at most 113
// significant digits, so a decimal that differs from it differs there or is
// longer, and then one more digit says on which side it lies.
enum { SLOW_DIGITS = 120 };

// Units in the last place of a double; decimal_fast says what they guard.
enum { ROUNDING_GUARD = 16 };

// An exponent as written stops growing here: beyond, all is 0 or infinite.
static const int64_t EXPONENT_MAX = 100000000000000000;

// A decimal taken apart.  Its value is word * 10^(shift + exponent), but for
// what comes after the first 19 significant digits.
typedef struct decimal {
  const char *digits, *digits_end;  // the mantissa as written, with its point
  uint64_t word;                    // its first 19 significant digits
  int64_t shift;                    // power of ten of the last of them
  int64_t exponent;                 // as written behind the e
} decimal;

// 10^0 .. 10^22, all exact in double precision.
static const double POWER_OF_TEN[] = {
    1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
};

// The same of negative powers, rounded.
static const double POWER_OF_TENTH[] = {
    1e-0,  1e-1,  1e-2,  1e-3,  1e-4,  1e-5,  1e-6,  1e-7,
    1e-8,  1e-9,  1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15,
    1e-16, 1e-17, 1e-18, 1e-19, 1e-20, 1e-21, 1e-22,
};

static bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// Whether the bytes at p begin with the lower-case word, in any case.
static bool begins_with(const char *p, const char *end, const char *word) {
  size_t n = strlen(word);
  if ((size_t)(end - p) < n) return false;
  for (size_t i = 0; i < n; i++)
    if ((p[i] | 0x20) != word[i]) return false;
  return true;
}

// inf, infinity, nan.
static const char *special(const char *p, const char *end, bool negative,
                           float *out) {
  float value = NAN;
  size_t n = 3;
  if (begins_with(p, end, "inf")) {
    value = INFINITY;
    if (begins_with(p, end, "infinity")) n = 8;
  } else if (!begins_with(p, end, "nan")) {
    return NULL;
  }
  *out = negative ? -value : value;
  return p + n;
}

// The exponent at p ("e-12"); p itself when there is none.
static const char *take_exponent(const char *p, const char *end,
                                 int64_t *exponent) {
  if (p == end || (*p | 0x20) != 'e') return p;
  const char *q = p + 1;
  bool minus = q < end && *q == '-';
  if (q < end && (*q == '-' || *q == '+')) q++;
  if (q == end || !is_digit(*q)) return p;
  int64_t e = 0;
  for (; q < end && is_digit(*q); q++)
    if (e < EXPONENT_MAX) e = e * 10 + (*q - '0');
  *exponent = minus ? -e : e;
  return q;
}

// Whether all of the eight bytes at p are digits, and then their value.
//
// The bytes become one integer with the first one lowest.  Taking '0' off each
// leaves 0..9 for digits; adding 0x76 then sets the top bit of everything
// else.  Three multiplications join neighbours: digits, pairs, fours.
static inline bool eight_digits(const char *p, uint64_t *value) {
  const unsigned char *b = (const unsigned char *)p;
  uint64_t v = (uint64_t)b[0] | (uint64_t)b[1] << 8 | (uint64_t)b[2] << 16 |
               (uint64_t)b[3] << 24 | (uint64_t)b[4] << 32 |
               (uint64_t)b[5] << 40 | (uint64_t)b[6] << 48 |
               (uint64_t)b[7] << 56;
  v ^= 0x3030303030303030u;
  if ((((v + 0x7676767676767676u) | v) & 0x8080808080808080u) != 0)
    return false;
  v = (v * 10 + (v >> 8)) & 0x00ff00ff00ff00ffu;
  v = (v * 100 + (v >> 16)) & 0x0000ffff0000ffffu;
  *value = (v * 10000 + (v >> 32)) & 0xffffffffu;
  return true;
}

// Append the digits at p to *word, which wraps around when they are too many;
// the first byte behind them is returned.
static inline const char *take_digits(const char *p, const char *end,
                                      uint64_t *word) {
  uint64_t w = *word;
  for (; p < end && is_digit(*p); p++)
    w = w * 10 + (uint64_t)(*p - '0');
  *word = w;
  return p;
}

// The same where many digits are likely: behind the point.  Six decimals are
// the most common, so the seventh byte tells whether to try eight.
static inline const char *take_fraction(const char *p, const char *end,
                                        uint64_t *word) {
  uint64_t eight;
  while (end - p >= 8 && is_digit(p[6]) && eight_digits(p, &eight)) {
    *word = *word * 100000000 + eight;
    p += 8;
  }
  return take_digits(p, end, word);
}

// Take a mantissa of more than 19 digits apart: zeros in front do not count.
static void take_long(decimal *d) {
  int count = 0;
  bool point = false;
  d->word = 0;
  d->shift = 0;
  for (const char *p = d->digits; p < d->digits_end; p++) {
    if (*p == '.') {
      point = true;
    } else if (count < WORD_DIGITS) {
      d->word = d->word * 10 + (uint64_t)(*p - '0');
      if (d->word != 0) count++;
      d->shift -= point;
    } else {
      d->shift += !point;
    }
  }
}

// Take the decimal at p apart; NULL when there is no digit.
static inline const char *take_decimal(const char *p, const char *end,
                                       decimal *d) {
  d->digits = p;
  p = take_digits(p, end, &d->word);
  ptrdiff_t count = p - d->digits;
  if (p < end && *p == '.') {
    const char *fraction = p + 1;
    p = take_fraction(fraction, end, &d->word);
    d->shift = fraction - p;
    count += p - fraction;
  }
  if (count == 0) return NULL;
  d->digits_end = p;
  if (count > WORD_DIGITS) take_long(d);
  if (p < end && (*p | 0x20) == 'e') return take_exponent(p, end, &d->exponent);
  return p;
}

// Round the decimal by way of double precision.  The word, at most three
// powers, as many products and the digits that were cut off each err by 2^-53
// at most, relative: together by less than 8 units in the last place of the
// double.  A float's midpoints are the doubles whose low 29 bits are 1 0...0,
// so a double that is more than ROUNDING_GUARD units away from that pattern
// rounds to the same float as the decimal itself.  False where this decides
// nothing: near a midpoint, and outside the range of normal floats.
static inline bool decimal_fast(const decimal *d, float *out) {
  int64_t power = d->shift + d->exponent;
  if (power < -66 || power > 44) return false;
  double x = (double)d->word;
  for (; power > 22; power -= 22)
    x *= POWER_OF_TEN[22];
  for (; power < -22; power += 22)
    x *= POWER_OF_TENTH[22];
  x *= power < 0 ? POWER_OF_TENTH[-power] : POWER_OF_TEN[power];
  if (!(x >= (double)FLT_MIN && x <= (double)FLT_MAX)) return false;
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  int64_t away = (int64_t)(bits & 0x1fffffff) - 0x10000000;
  if (away >= -ROUNDING_GUARD && away <= ROUNDING_GUARD) return false;
  *out = (float)x;
  return true;
}

// The slow way: the significant digits without a point, one digit 1 for all
// that were cut off, and an exponent, to strtof.  No locale has a say in that.
static float decimal_slow(const decimal *d) {
  char text[SLOW_DIGITS + 32];
  size_t n = 0;
  bool point = false, cut = false;
  int64_t exponent = d->exponent;
  for (const char *p = d->digits; p < d->digits_end; p++) {
    if (*p == '.') {
      point = true;
    } else if (n < SLOW_DIGITS) {
      if (*p != '0' || n > 0) text[n++] = *p;
      exponent -= point;
    } else {
      if (*p != '0') cut = true;
      exponent += !point;
    }
  }
  if (cut) {
    text[n++] = '1';
    exponent--;
  }
  if (exponent > 9999) exponent = 9999;
  if (exponent < -9999) exponent = -9999;
  snprintf(text + n, sizeof text - n, "e%d", (int)exponent);
  int saved = errno;
  float value = strtof(text, NULL);
  errno = saved;
  return value;
}

const char *number_float(const char *p, const char *end, float *out) {
  bool negative = p < end && *p == '-';
  if (p < end && (*p == '-' || *p == '+')) p++;
  decimal d = {0};
  const char *after = take_decimal(p, end, &d);
  if (after == NULL) return special(p, end, negative, out);
  float value = 0;
  if (d.word != 0 && !decimal_fast(&d, &value)) value = decimal_slow(&d);
  *out = negative ? -value : value;
  return after;
}

const char *number_int(const char *p, const char *end, long long *out) {
  bool negative = p < end && *p == '-';
  if (p < end && (*p == '-' || *p == '+')) p++;
  const char *digits = p;
  long long value = 0;
  for (; p < end && is_digit(*p); p++) {
    int digit = *p - '0';
    if (value < (LLONG_MIN + digit) / 10) return NULL;
    value = value * 10 - digit;
  }
  if (p == digits || (!negative && value == LLONG_MIN)) return NULL;
  *out = negative ? value : -value;
  return p;
}

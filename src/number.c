// number.c

#include "number.h"

#include "digits.h"

#include <errno.h>
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdbool.h>
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
enum { ROUNDING_GUARD = 8 };

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
    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

static bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// The end of a run of digits at p.
static const char *skip_digits(const char *p, const char *end) {
  while (p < end && is_digit(*p))
    p++;
  return p;
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

// The digits at p into *word while they surely fit, eight at a time; *count
// grows by their number.
static const char *take_digits(const char *p, const char *end, uint64_t *word,
                               int *count) {
  uint32_t value;
  while (end - p >= DIGITS_READ && *count <= WORD_DIGITS - 8) {
    unsigned n = digits_take(p, &value);
    if (n == 0) return p;
    *word = *word * digits_power(n) + value;
    *count += (int)n;
    p += n;
    if (n < 8) return p;
  }
  for (; p < end && is_digit(*p) && *count < WORD_DIGITS; p++, ++*count)
    *word = *word * 10 + (uint64_t)(*p - '0');
  return p;
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
static const char *take_decimal(const char *p, const char *end, decimal *d) {
  int count = 0;
  d->digits = p;
  p = take_digits(p, end, &d->word, &count);
  const char *whole = skip_digits(p, end);
  bool fits = whole == p, any = whole > d->digits;
  p = whole;
  if (p < end && *p == '.') {
    int before = count;
    p = take_digits(whole + 1, end, &d->word, &count);
    d->shift = before - count;
    const char *fraction = skip_digits(p, end);
    fits = fits && fraction == p;
    any = any || fraction > whole + 1;
    p = fraction;
  }
  if (!any) return NULL;
  d->digits_end = p;
  if (!fits) take_long(d);
  return take_exponent(p, end, &d->exponent);
}

// Round the decimal by way of double precision.  The word, at most three
// factors and the digits that were cut off each err by 2^-53 at most, relative:
// together less than 5 units in the last place of the double.  A float's
// midpoints are the doubles whose low 29 bits are 1 0...0, so a double that is
// more than ROUNDING_GUARD units away from that pattern rounds to the same
// float as the decimal itself.  False where this decides nothing: near a
// midpoint, and outside the range of normal floats.
static bool decimal_fast(const decimal *d, float *out) {
  int64_t power = d->shift + d->exponent;
  if (power < -66 || power > 44) return false;
  double x = (double)d->word;
  for (; power > 22; power -= 22)
    x *= POWER_OF_TEN[22];
  for (; power < -22; power += 22)
    x /= POWER_OF_TEN[22];
  x = power < 0 ? x / POWER_OF_TEN[-power] : x * POWER_OF_TEN[power];
  if (!(x >= (double)FLT_MIN && x <= (double)FLT_MAX)) return false;
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  int64_t low = (int64_t)(bits & 0x1fffffff);
  int64_t away = low - 0x10000000;
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

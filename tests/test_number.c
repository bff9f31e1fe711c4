// test_number.c — decimal numbers are rounded as strtof rounds them, always.

#include "number.h"

#include <limits.h>
#include <locale.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// The longest number of these tests.
enum { TEXT_MAX = 256 };

static long turns(long n) {
  return getenv("FACET_QUICK") == NULL ? n : n / 50;
}

static uint64_t next_random(uint64_t *s) {
  *s ^= *s << 13;
  *s ^= *s >> 7;
  *s ^= *s << 17;
  return *s;
}

// Whether number_float and strtof agree: in every bit of the value and on
// where the number ends, also when the bytes end right behind it.
static bool agrees(const char *text) {
  char *end;
  float wanted = strtof(text, &end), got = 0;
  size_t n = (size_t)(end - text);
  const char *after = number_float(text, text + strlen(text), &got);
  bool ok = after == (n > 0 ? end : NULL);
  if (n > 0) ok = ok && memcmp(&wanted, &got, sizeof got) == 0;
  after = number_float(text, end, &got);
  ok = ok && (n == 0 || (after == end && memcmp(&wanted, &got, 4) == 0));
  if (!ok)
    print_message("# \"%s\": %a, expected %a\n", text, (double)got,
                  (double)wanted);
  return ok;
}

// n random digits at p, a point somewhere among them or not.
static char *put_digits(char *p, int n, uint64_t *s) {
  int point = (int)(next_random(s) % 48);
  uint64_t r = 0;
  for (int i = 0; i < n; i++) {
    if (i == point) *p++ = '.';
    if (i % 16 == 0) r = next_random(s);
    *p++ = (char)('0' + (r >> (i % 16 * 4)) % 16 % 10);
  }
  return p;
}

// 1 to 40 digits with a point anywhere, half of them with an exponent.
static void write_digits(char *p, uint64_t *s) {
  if (next_random(s) % 4 == 0) *p++ = next_random(s) % 2 == 0 ? '-' : '+';
  p = put_digits(p, 1 + (int)(next_random(s) % 40), s);
  *p = '\0';
  uint64_t r = next_random(s);
  if (r % 2 == 0) snprintf(p, 32, "e%d", (int)(r / 2 % 120) - 60);
}

// The way files write coordinates: a few digits, point, up to 17 decimals.
static void write_coordinate(char *p, uint64_t *s) {
  uint64_t r = next_random(s);
  if (r % 2 == 0) *p++ = '-';
  p = put_digits(p, 1 + (int)(r / 2 % 3), s);
  if (memchr(p - 3, '.', 3) == NULL) *p++ = '.';
  for (int n = (int)(r / 8 % 17); n > 0; n--)
    *p++ = (char)('0' + next_random(s) % 10);
  *p = '\0';
}

static float float_of(uint32_t bits) {
  float f;
  memcpy(&f, &bits, sizeof f);
  return f;
}

// Any float, normal or not, with 1 to 17 digits.
static void write_float(char *p, uint64_t *s) {
  uint64_t r = next_random(s);
  uint32_t bits = (uint32_t)r & 0x7fffffff;
  if (bits >= 0x7f800000) bits &= 0x3fffffff;
  snprintf(p, TEXT_MAX, "%.*g", 1 + (int)(r >> 40) % 17,
           (double)float_of(bits));
}

// The midpoint of two neighbouring floats in all its digits, or one unit of
// some digit beside it: the decimals that are hardest to round.
static void write_midpoint(char *p, uint64_t *s) {
  uint64_t r = next_random(s);
  uint32_t bits = (uint32_t)r & 0x7fffffff;
  if (bits >= 0x7f7fffff) bits &= 0x3fffffff;
  if (r >> 62 == 0) bits &= 0x00ffffff;  // around the smallest normal one
  double a = (double)float_of(bits), b = (double)float_of(bits + 1);
  int n =
      snprintf(p, TEXT_MAX, "%.*e", (r >> 32) % 2 == 0 ? 130 : 16, (a + b) / 2);
  char *e = memchr(p, 'e', (size_t)n);
  if ((r >> 33) % 4 == 0) e[-1] = '1';
}

// Random decimals of every shape, 10 million of them, are bit for bit what
// strtof makes of them.
static void random_decimals_agree_with_strtof(void **state) {
  (void)state;
  static void (*const WRITE[])(char *, uint64_t *) = {
      write_digits, write_coordinate, write_float, write_midpoint};
  static const long TURNS[] = {5000000, 4000000, 600000, 400000};
  uint64_t s = 88172645463325252u;
  int wrong = 0;
  for (int k = 0; k < 4; k++) {
    void (*write)(char *, uint64_t *) = WRITE[k];
    for (long i = turns(TURNS[k]); i > 0 && wrong < 10; i--) {
      char text[TEXT_MAX + 8] = {0};
      write(text + 4, &s);
      wrong += !agrees(text + 4);
    }
  }
  assert_int_equal(wrong, 0);
}

// The odd ones, each by name: what is no number, what ends early, what
// overflows, what underflows, and the borders of both.
static void odd_decimals_agree_with_strtof(void **state) {
  (void)state;
  static const char *const ODD[] = {
      "",
      ".",
      "-",
      "+",
      "e5",
      ".e5",
      "-.",
      "1.",
      ".5",
      "-.5",
      "1e",
      "1e+",
      "1e-",
      "1.e5",
      "1e5.5",
      "1..2",
      "1.2.3",
      "--1",
      "+-1",
      "1e05",
      "+1e+05",
      "-0",
      "-0.0",
      "0e9",
      "00012",
      "1E5",
      "inf",
      "-inf",
      "+INF",
      "Inf1",
      "infin",
      "infinity",
      "INFINITYx",
      "nan",
      "NaN",
      "-nan",
      "na",
      "in",
      "1 2",
      "1\t",
      "1/2",
      "12345678",
      "123456789",
      "1234567890123456789",
      "12345678901234567890",
      "16777217",
      "16777219",
      "33554434",
      "33554435",
      "9007199254740993",
      "3.4028234663852886e38",
      "3.4028235677973365e38",
      "3.4028235677973366e38",
      "3.4028235677973367e38",
      "3.5e38",
      "1e39",
      "1e400",
      "-1e400",
      "1e99999999999999999999",
      "1e-99999999999999999999",
      "0e99999999999999999999",
      "1.17549435e-38",
      "1.1754943508222875e-38",
      "1.1754942807573643e-38",
      "1.4e-45",
      "7.006492321624085e-46",
      "7.006492321624086e-46",
      "0.7e-45",
      "1e-46",
      "1e-400",
      "0.00000000000000000000000000000000000000000000000000001e53",
      "100000000000000000000000000000000000000000000000000000e-53"};
  for (size_t i = 0; i < sizeof ODD / sizeof ODD[0]; i++)
    assert_true(agrees(ODD[i]));
}

// Hexadecimal is not decimal: only the 0 is taken.
static void hexadecimal_is_not_read(void **state) {
  (void)state;
  const char *text = "0x10p1";
  float f = 1;
  assert_ptr_equal(number_float(text, text + 6, &f), text + 1);
  assert_true(f == 0);
}

// A million zeros before or behind the point cost time, not correctness.
static void zeros_without_end(void **state) {
  (void)state;
  size_t n = 1000000;
  char *text = malloc(n + 64);
  assert_non_null(text);
  memset(text, '0', n);
  strcpy(text + n, "1.25");
  assert_true(agrees(text));
  text[1] = '.';
  strcpy(text + n, "125e1000000");
  assert_true(agrees(text));
  text[0] = '7';
  text[1] = '0';
  strcpy(text + n, "e-1000000");
  assert_true(agrees(text));
  free(text);
}

// A locale whose decimal point is a comma changes nothing.
static void the_locale_has_no_say(void **state) {
  (void)state;
  static const char *const COMMA[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE",
                                      "nl_NL.UTF-8"};
  const char *set = NULL;
  for (int i = 0; i < 4 && set == NULL; i++)
    set = setlocale(LC_NUMERIC, COMMA[i]);
  if (set == NULL) {
    print_message("# SKIP no locale with a decimal comma\n");
    return;
  }
  static const char MIDPOINT[] = "1.00000017881393432617187500";
  float f = 0;
  const char *after = number_float(MIDPOINT, MIDPOINT + 28, &f);
  setlocale(LC_NUMERIC, "C");
  assert_ptr_equal(after, MIDPOINT + 28);
  assert_true(f == 0x1.000004p0f);
}

// Whole numbers of 64 bits and nothing more.
static void integers_have_64_bits(void **state) {
  (void)state;
  static const struct {
    const char *text;
    int taken;  // -1: refused
    long long value;
  } INTS[] = {{"0", 1, 0},
              {"-17x", 3, -17},
              {"+5/6", 2, 5},
              {"9223372036854775807", 19, LLONG_MAX},
              {"-9223372036854775808", 20, LLONG_MIN},
              {"9223372036854775808", -1, 0},
              {"-9223372036854775809", -1, 0},
              {"99999999999999999999", -1, 0},
              {"", -1, 0},
              {"-", -1, 0},
              {"x", -1, 0}};
  for (size_t i = 0; i < sizeof INTS / sizeof INTS[0]; i++) {
    const char *text = INTS[i].text;
    long long value = 0;
    const char *after = number_int(text, text + strlen(text), &value);
    assert_true(after == (INTS[i].taken < 0 ? NULL : text + INTS[i].taken));
    assert_true(value == INTS[i].value);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(random_decimals_agree_with_strtof),
      cmocka_unit_test(odd_decimals_agree_with_strtof),
      cmocka_unit_test(hexadecimal_is_not_read),
      cmocka_unit_test(zeros_without_end),
      cmocka_unit_test(the_locale_has_no_say),
      cmocka_unit_test(integers_have_64_bits),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

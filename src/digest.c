// digest.c

#include "digest.h"

#include <string.h>

// Every step can be undone, given the word: so two states that differ stay
// different for as long as the words are the same.  Source: the step is that
// of Steele, Lea and Flood 2014.
static uint64_t mix(uint64_t d, uint64_t word) {
  d = (d ^ word) * UINT64_C(0x9e3779b97f4a7c15);
  return d ^ d >> 29;
}

uint64_t digest_add(uint64_t d, const void *bytes, size_t n) {
  const unsigned char *p = bytes;
  for (size_t i = 0; i < n; i += 8) {
    uint64_t word = 0;
    memcpy(&word, p + i, n - i < 8 ? n - i : 8);
    d = mix(d, word);
  }
  return mix(d, n);
}

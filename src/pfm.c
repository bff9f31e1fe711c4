// pfm.c

#include "pfm.h"

#include "file.h"

#include <string.h>

// The next word of the header, and the one white space after it.
static bool pfm_word(FILE *f, char *word, size_t room) {
  size_t n = 0;
  int c = getc(f);
  while (c != EOF && c != ' ' && c != '\t' && c != '\r' && c != '\n') {
    if (n + 1 >= room) return false;
    word[n++] = (char)c;
    c = getc(f);
  }
  word[n] = '\0';
  return n > 0 && c != EOF;
}

// The scale must be a number other than 0; its sign is the byte order, minus
// for little endian.  Its size means nothing that readers agree on.
static bool pfm_scale(const char *word, bool *little) {
  bool minus = word[0] == '-', digit = false;
  const char *c = word + (minus || word[0] == '+');
  for (; *c != '\0' && *c != 'e' && *c != 'E'; c++) {
    if ((*c < '0' || *c > '9') && *c != '.') return false;
    if (*c >= '1' && *c <= '9') digit = true;
  }
  *little = minus;
  return digit && strspn(c, "eE+-0123456789") == strlen(c);
}

// Four bytes as a float.
static float pfm_float(const uint8_t *b, bool little) {
  uint32_t bits = 0;
  for (int i = 0; i < 4; i++)
    bits = bits << 8 | b[little ? 3 - i : i];
  float x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

// The header of a map.
typedef struct pfm_header {
  int width, height, channels;
  bool little;
} pfm_header;

// Read the header, up to the first byte of the pixels.
static bool pfm_read_header(pfm_header *h, FILE *f, const char *name,
                            error *err) {
  char word[32];
  if (!pfm_word(f, word, sizeof word) ||
      (strcmp(word, "PF") != 0 && strcmp(word, "Pf") != 0))
    return fail(err, "%s: not a PFM file, expected PF or Pf at its start",
                name);
  h->channels = word[1] == 'F' ? 3 : 1;
  if (!pfm_word(f, word, sizeof word) || !image_parse_side(word, &h->width) ||
      !pfm_word(f, word, sizeof word) || !image_parse_side(word, &h->height))
    return fail(err, "%s: bad PFM header, expected width and height in 1..%d",
                name, IMAGE_MAX_SIDE);
  if (!pfm_word(f, word, sizeof word) || !pfm_scale(word, &h->little))
    return fail(err, "%s: bad PFM header, expected a scale such as -1.0", name);
  return true;
}

bool pfm_load(image *out, FILE *f, const char *name, arena *mem, error *err) {
  pfm_header h;
  if (!pfm_read_header(&h, f, name, err)) return false;
  size_t row = (size_t)h.width * (size_t)h.channels * 4;
  uint64_t need = (uint64_t)row * (uint64_t)h.height, left = file_left(f);
  if (left < need)
    return fail(err,
                "%s: PFM ends early, %llu bytes of pixels where %d x %d "
                "needs %llu",
                name, (unsigned long long)left, h.width, h.height,
                (unsigned long long)need);
  arena scratch = {0};
  uint8_t *bytes = arena_alloc(&scratch, row, 1);
  image im = image_new(&scratch, h.width, h.height);
  bool ok = true;
  for (int y = h.height - 1; y >= 0 && ok; y--) {  // bottom row first
    ok = fread(bytes, 1, row, f) == row;
    for (int x = 0; x < h.width && ok; x++) {
      const uint8_t *b = bytes + (size_t)x * (size_t)h.channels * 4;
      vec3 *p = &im.pixels[(size_t)y * (size_t)h.width + (size_t)x];
      *p = vec3_all(pfm_float(b, h.little));
      if (h.channels == 1) continue;
      p->y = pfm_float(b + 4, h.little);
      p->z = pfm_float(b + 8, h.little);
    }
  }
  if (!ok) {
    arena_free(&scratch);
    return fail(err, "%s: PFM could not be read to its end", name);
  }
  arena_adopt(mem, &scratch);
  *out = im;
  return true;
}

// A float as four bytes, the least significant first.
static uint8_t *pfm_put(uint8_t *to, float x) {
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  for (int i = 0; i < 4; i++)
    *to++ = (uint8_t)(bits >> 8 * i & 255);
  return to;
}

bool pfm_save(const image *im, FILE *f, const char *name, error *err) {
  arena scratch = {0};
  size_t row = (size_t)im->width * 12;
  uint8_t *bytes = arena_alloc(&scratch, row, 1);
  bool ok = fprintf(f, "PF\n%d %d\n-1.0\n", im->width, im->height) > 0;
  for (int y = im->height - 1; y >= 0 && ok; y--) {
    uint8_t *to = bytes;
    for (int x = 0; x < im->width; x++) {
      vec3 p = im->pixels[(size_t)y * (size_t)im->width + (size_t)x];
      to = pfm_put(pfm_put(pfm_put(to, p.x), p.y), p.z);
    }
    ok = fwrite(bytes, 1, row, f) == row;
  }
  arena_free(&scratch);
  return ok || fail(err, "%s: cannot be written as PFM", name);
}

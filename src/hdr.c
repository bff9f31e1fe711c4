// hdr.c

#include "hdr.h"

#include "file.h"

#include <string.h>

// A mantissa m with the exponent byte e is m 2^(e - EXPONENT_BIAS): 128 for
// the sign of the exponent, 8 because the point stands before the mantissa.
// Source: Ward 1991, "Real pixels".
enum { EXPONENT_BIAS = 128 + 8 };

// Widths that the newer run lengths can express; other rows are flat.
enum { RUN_MIN_WIDTH = 8, RUN_MAX_WIDTH = 32767 };

// Runs shorter than this are cheaper as literals.
enum { RUN_SHORTEST = 4 };

// What the header says.
typedef struct hdr_header {
  bool xyz;
  double scale[3];      // the file's numbers times this are radiance
  int length, count;    // pixels of a scanline, and scanlines
  bool along_x;         // scanlines run along x
  bool flip_x, flip_y;  // x counts from the right, y from the bottom
} hdr_header;

// Read one line without its end into text, cutting what has no room.  False
// when the file ends before the line does.
static bool hdr_line(FILE *f, char *text, size_t room) {
  size_t n = 0;
  int c = getc(f);
  for (; c != '\n' && c != EOF; c = getc(f))
    if (n + 1 < room) text[n++] = (char)c;
  if (n > 0 && text[n - 1] == '\r') n--;
  text[n] = '\0';
  return c != EOF;
}

// Read decimal digits with a point, adding them to *value; returns how many
// of them stood behind the point, or -1 when there are none at all.
static int hdr_digits(const char **at, double *value) {
  int count = 0, behind = 0;
  bool point = false;
  for (;; (*at)++) {
    char c = **at;
    if (c == '.' && !point) {
      point = true;
      continue;
    }
    if (c < '0' || c > '9') break;
    *value = 10 * *value + (c - '0');
    count++;
    behind += point;
  }
  return count == 0 ? -1 : behind;
}

// A positive decimal number, as a double with a few units of error in its
// last place; *at moves behind it.  Exposures need no more.
static bool hdr_number(const char **at, double *out) {
  while (**at == ' ' || **at == '\t')
    (*at)++;
  if (**at == '+') (*at)++;
  double value = 0, exponent = 0;
  int behind = hdr_digits(at, &value);
  if (behind < 0) return false;
  if (**at == 'e' || **at == 'E') {
    (*at)++;
    double sign = **at == '-' ? -1 : 1;
    if (**at == '-' || **at == '+') (*at)++;
    if (hdr_digits(at, &exponent) != 0) return false;
    exponent *= sign;
  }
  value *= pow(10, exponent - behind);
  if (!(value > 0) || isinf(value)) return false;
  *out = value;
  return true;
}

// Take one line of the header into account.
static bool hdr_understand(hdr_header *h, const char *line, const char *name,
                           error *err) {
  double e[3];
  const char *at = strchr(line, '=');
  if (at == NULL) return true;
  at++;
  if (strncmp(line, "FORMAT=", 7) == 0) {
    h->xyz = strcmp(at, "32-bit_rle_xyze") == 0;
    if (h->xyz || strcmp(at, "32-bit_rle_rgbe") == 0) return true;
    return fail(err,
                "%s: Radiance FORMAT=%.60s, expected 32-bit_rle_rgbe or "
                "32-bit_rle_xyze",
                name, at);
  }
  if (strncmp(line, "EXPOSURE=", 9) == 0) {
    if (!hdr_number(&at, &e[0]))
      return fail(err, "%s: bad %.60s, expected a positive number", name, line);
    e[1] = e[2] = e[0];
  } else if (strncmp(line, "COLORCORR=", 10) == 0) {
    for (int c = 0; c < 3; c++)
      if (!hdr_number(&at, &e[c]))
        return fail(err, "%s: bad %.60s, expected three positive numbers", name,
                    line);
  } else {
    return true;  // GAMMA, PRIMARIES, VIEW and others change no number here
  }
  for (int c = 0; c < 3; c++)
    h->scale[c] /= e[c];
  return true;
}

// The line of the form "-Y 512 +X 1024": the slow axis first, + where it runs
// to the right or upwards.
static bool hdr_resolution(hdr_header *h, char *line) {
  char *word[4] = {line, NULL, NULL, NULL};
  for (int i = 1; i < 4; i++) {
    char *blank = strchr(word[i - 1], ' ');
    if (blank == NULL) return false;
    *blank = '\0';
    word[i] = blank + 1;
  }
  bool y_first = strcmp(word[0] + (word[0][0] != '\0'), "Y") == 0;
  h->along_x = y_first;
  for (int i = 0; i < 4; i += 2) {
    char sign = word[i][0], axis = (i == 0) == y_first ? 'Y' : 'X';
    if ((sign != '+' && sign != '-') || word[i][1] != axis || word[i][2] != 0)
      return false;
    if (axis == 'X') h->flip_x = sign == '-';
    if (axis == 'Y') h->flip_y = sign == '+';
  }
  return image_parse_side(word[1], &h->count) &&
         image_parse_side(word[3], &h->length);
}

// Read the header, up to the first byte of the pixels.
static bool hdr_read_header(hdr_header *h, FILE *f, const char *name,
                            error *err) {
  char line[256];
  *h = (hdr_header){.scale = {1, 1, 1}};
  if (!hdr_line(f, line, sizeof line) || strncmp(line, "#?", 2) != 0)
    return fail(err, "%s: not a Radiance picture, expected #? at its start",
                name);
  do {
    if (!hdr_line(f, line, sizeof line))
      return fail(err, "%s: Radiance header ends early, expected an empty line",
                  name);
    if (!hdr_understand(h, line, name, err)) return false;
  } while (line[0] != '\0');
  if (!hdr_line(f, line, sizeof line) || !hdr_resolution(h, line))
    return fail(err,
                "%s: bad Radiance size, expected a line like -Y 512 +X 1024 "
                "with sides in 1..%d",
                name, IMAGE_MAX_SIDE);
  return true;
}

// The rest of a flat scanline or one with old run lengths, whose first pixel
// is in row already: 1 1 1 n repeats the pixel before n times, and a second
// such in a row counts 256 times as much.  NULL, or what is wrong.
static const char *hdr_old_row(uint8_t *row, int length, FILE *f) {
  int at = 0, shift = 0;
  for (;;) {
    uint8_t *p = row + 4 * at;
    if (p[0] == 1 && p[1] == 1 && p[2] == 1) {
      if (at == 0 || shift > 16) return "a run repeats nothing";
      int n = p[3] << shift;
      if (n > length - at) return "a run leaves its scanline";
      for (; n > 0; n--, at++)
        memcpy(row + 4 * at, row + 4 * (at - 1), 4);
      shift += 8;
    } else {
      at++;
      shift = 0;
    }
    if (at == length) return NULL;
    if (fread(row + 4 * at, 1, 4, f) != 4) return "the file ends early";
  }
}

// A scanline with new run lengths, behind its four bytes of announcement: each
// channel for itself; above 128 a run, else so many literals.
static const char *hdr_new_row(uint8_t *row, int length, FILE *f) {
  for (int c = 0; c < 4; c++) {
    for (int at = 0; at < length;) {
      int head = getc(f);
      if (head == EOF) return "the file ends early";
      bool run = head > 128;
      int n = run ? head - 128 : head;
      // A run of nothing would never end.
      if (n == 0 || n > length - at) return "a run leaves its scanline";
      uint8_t value[128];
      size_t values = run ? 1 : (size_t)n;
      if (fread(value, 1, values, f) != values) return "the file ends early";
      for (int i = 0; i < n; i++, at++)
        row[4 * at + c] = value[run ? 0 : i];
    }
  }
  return NULL;
}

// Read the next scanline of whichever kind.  NULL, or what is wrong.
static const char *hdr_row(uint8_t *row, int length, FILE *f) {
  if (fread(row, 1, 4, f) != 4) return "the file ends early";
  bool fits = length >= RUN_MIN_WIDTH && length <= RUN_MAX_WIDTH;
  if (!fits || row[0] != 2 || row[1] != 2 || row[2] > 127)
    return hdr_old_row(row, length, f);
  if ((row[2] << 8 | row[3]) != length)
    return "a scanline announces another width";
  return hdr_new_row(row, length, f);
}

// What a mantissa's unit is worth, by the byte of the exponent.
typedef struct hdr_units {
  float of[256];
} hdr_units;

static hdr_units hdr_units_new(void) {
  hdr_units u = {{0}};
  for (int e = 1; e < 256; e++)
    u.of[e] = ldexpf(1, e - EXPONENT_BIAS);
  return u;
}

// Red, green and blue of one pixel with a shared exponent.
static vec3 hdr_decode(const hdr_units *u, const uint8_t *b) {
  float unit = u->of[b[3]];
  return (vec3){(float)b[0] * unit, (float)b[1] * unit, (float)b[2] * unit};
}

// CIE XYZ to linear RGB: the matrix of the primaries and the white of sRGB,
// inverted.  Source: IEC 61966-2-1:1999, section 5.2, which prints four digits.
static vec3 rgb_of_xyz(vec3 c) {
  return (vec3){3.2404542f * c.x - 1.5371385f * c.y - 0.4985314f * c.z,
                -0.9692660f * c.x + 1.8760108f * c.y + 0.0415560f * c.z,
                0.0556434f * c.x - 0.2040259f * c.y + 1.0572252f * c.z};
}

// The image of all scanlines, turned upright.
static image hdr_upright(const hdr_header *h, const uint8_t *rows, arena *mem) {
  int width = h->along_x ? h->length : h->count;
  int height = h->along_x ? h->count : h->length;
  vec3 scale = {(float)h->scale[0], (float)h->scale[1], (float)h->scale[2]};
  image im = image_new(mem, width, height);
  const hdr_units units = hdr_units_new();
  for (int i = 0; i < h->count; i++)
    for (int j = 0; j < h->length; j++, rows += 4) {
      int x = h->along_x ? j : i, y = h->along_x ? i : j;
      if (h->flip_x) x = width - 1 - x;
      if (h->flip_y) y = height - 1 - y;
      vec3 p = vec3_mul(hdr_decode(&units, rows), scale);
      im.pixels[(size_t)y * (size_t)width + (size_t)x] =
          h->xyz ? rgb_of_xyz(p) : p;
    }
  return im;
}

// Read all scanlines into *rows, which grows with them: memory is spent only
// for what the file has shown.  NULL, or what is wrong.
static const char *hdr_read_rows(const hdr_header *h, FILE *f, uint8_t **rows) {
  uint64_t least = h->length > 1 ? 8 : 4;  // bytes of a scanline
  uint64_t left = file_left(f);
  if (least * (uint64_t)h->count > left ||
      !image_fits(h->length, h->count, left))
    return "the file is too short for its width and height";
  size_t room = 0, row = 4 * (size_t)h->length;
  for (size_t i = 0; i < (size_t)h->count; i++) {
    *rows = array_grow(*rows, &room, (i + 1) * row, 1);
    const char *why = hdr_row(*rows + i * row, h->length, f);
    if (why != NULL) return why;
  }
  return NULL;
}

bool hdr_load(image *out, FILE *f, const char *name, arena *mem, error *err) {
  hdr_header h;
  if (!hdr_read_header(&h, f, name, err)) return false;
  uint8_t *rows = NULL;
  const char *why = hdr_read_rows(&h, f, &rows);
  if (why == NULL) *out = hdr_upright(&h, rows, mem);
  array_free(rows);
  return why == NULL ||
         fail(err, "%s: not a whole Radiance picture: %s", name, why);
}

// x in units of 2^e, to the nearest; 0 for NaN and below, at most 256.
static int hdr_mantissa(float x, int e) {
  if (!(x > 0)) return 0;
  double m = ldexp((double)x, -e);
  return m > 255.5 ? 256 : (int)(m + 0.5);
}

// The four bytes of p.  The largest component gets a mantissa of 128 or more
// where the exponent's byte allows; what is too large becomes 255 2^119.
static void hdr_encode(uint8_t *b, vec3 p) {
  float rgb[3] = {p.x, p.y, p.z}, peak = 0;
  for (int c = 0; c < 3; c++)
    if (rgb[c] > peak) peak = rgb[c];
  int e = 0;
  if (isinf(peak))
    e = 1 << 10;
  else
    frexp((double)peak, &e);  // peak < 2^e
  e = e < -127 ? -127 : e > 127 ? 127 : e;
  // Rounding up to 256 asks for the next exponent.
  if (hdr_mantissa(peak, e - 8) == 256 && e < 127) e++;
  int sum = 0;
  for (int c = 0; c < 3; c++) {
    int m = hdr_mantissa(rgb[c], e - 8);
    b[c] = (uint8_t)(m > 255 ? 255 : m);
    sum += b[c];
  }
  b[3] = (uint8_t)(sum == 0 ? 0 : e + 128);
  // 1 1 1 would be read as a run; it is 2^-135, black for all purposes.
  if (b[0] == 1 && b[1] == 1 && b[2] == 1) memset(b, 0, 4);
}

// Where the run that starts at `at` ends.
static int run_end(const uint8_t *row, int length, int at) {
  int end = at + 1;
  while (end < length && end - at < 127 && row[4 * end] == row[4 * at])
    end++;
  return end;
}

// Write one channel of a row, from its first byte on, in run lengths.
static void hdr_put_channel(const uint8_t *row, int length, FILE *f) {
  for (int at = 0; at < length;) {
    int start = at, end = run_end(row, length, at);
    // Literals until a run worth its two bytes begins.
    while (end - at < RUN_SHORTEST && at < length && at - start < 128) {
      at++;
      end = at < length ? run_end(row, length, at) : at;
    }
    if (at > start) {
      putc(at - start, f);
      for (int i = start; i < at; i++)
        putc(row[4 * i], f);
    }
    if (end - at >= RUN_SHORTEST) {
      putc(128 + end - at, f);
      putc(row[4 * at], f);
      at = end;
    }
  }
}

bool hdr_save(const image *im, FILE *f, const char *name, error *err) {
  arena scratch = {0};
  int width = im->width;
  uint8_t *row = arena_alloc(&scratch, (size_t)width, 4);
  fprintf(f, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n", im->height,
          width);
  bool runs = width >= RUN_MIN_WIDTH && width <= RUN_MAX_WIDTH;
  for (int y = 0; y < im->height; y++) {
    for (int x = 0; x < width; x++)
      hdr_encode(row + 4 * x,
                 im->pixels[(size_t)y * (size_t)width + (size_t)x]);
    if (!runs) {
      fwrite(row, 4, (size_t)width, f);
      continue;
    }
    const uint8_t head[4] = {2, 2, (uint8_t)(width >> 8), (uint8_t)width};
    fwrite(head, 1, 4, f);
    for (int c = 0; c < 4; c++)
      hdr_put_channel(row + c, width, f);
  }
  arena_free(&scratch);
  return !ferror(f) || fail(err, "%s: cannot be written as Radiance", name);
}

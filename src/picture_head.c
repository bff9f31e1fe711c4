// picture_head.c

#include "picture_head.h"

#include "file.h"
#include "picture.h"

#include <string.h>

// Most heads end soon; a JPEG has thumbnails and colour profiles before its
// size.
enum { HEAD_USUAL = 1 << 12, HEAD_MOST = 1 << 22 };

// The bytes of a head, and how many there are.
typedef struct head_bytes {
  const unsigned char *at;
  size_t count;
} head_bytes;

// A number of n bytes from place i, 0 beyond the end; the first byte is the
// highest, or the lowest.
static int big_endian(head_bytes h, size_t i, size_t n) {
  unsigned sum = 0;
  for (size_t k = 0; k < n; k++)
    sum = sum << 8 | (i + k < h.count ? h.at[i + k] : 0);
  return sum > IMAGE_MAX_SIDE ? 0 : (int)sum;
}

static int little_endian(head_bytes h, size_t i) {
  return i + 1 < h.count ? h.at[i] | h.at[i + 1] << 8 : 0;
}

// IHDR is the first chunk.
static picture_head head_of_png(head_bytes h) {
  return (picture_head){big_endian(h, 16, 4), big_endian(h, 20, 4)};
}

static picture_head head_of_tga(head_bytes h) {
  return (picture_head){little_endian(h, 12), little_endian(h, 14)};
}

// A segment is 0xff, its kind, and its length with those two bytes; the
// frame's, 0xc0 to 0xcf without 0xc4, 0xc8 and 0xcc, has the sides.
static picture_head head_of_jpeg(head_bytes h) {
  size_t i = 2;
  while (i + 9 < h.count && h.at[i] == 0xff) {
    unsigned kind = h.at[i + 1];
    bool frame = kind >= 0xc0 && kind <= 0xcf && kind != 0xc4 && kind != 0xc8 &&
                 kind != 0xcc;
    if (frame)
      return (picture_head){big_endian(h, i + 7, 2), big_endian(h, i + 5, 2)};
    bool filler = kind == 0xff;
    i += filler ? 1 : 2 + (size_t)big_endian(h, i + 2, 2);
  }
  return (picture_head){0};
}

// The next whole number in a line of text from *i on, which moves behind it;
// 0 where the line ends before.
static int next_whole(head_bytes h, size_t *i) {
  while (*i < h.count && h.at[*i] != '\n' && (h.at[*i] < '0' || h.at[*i] > '9'))
    ++*i;
  int sum = 0;
  for (; *i < h.count && h.at[*i] >= '0' && h.at[*i] <= '9'; ++*i)
    if (sum <= IMAGE_MAX_SIDE) sum = 10 * sum + (h.at[*i] - '0');
  return sum > IMAGE_MAX_SIDE ? 0 : sum;
}

// "PF", width, height: with any blanks and line ends in between.
static picture_head head_of_pfm(head_bytes h) {
  int side[2] = {0, 0};
  size_t i = 2;
  for (int k = 0; k < 2; k++) {
    while (i < h.count && strchr(" \t\r\n", h.at[i]) != NULL)
      i++;
    side[k] = next_whole(h, &i);
  }
  return (picture_head){side[0], side[1]};
}

static bool ends_line(head_bytes h, size_t i) {
  return h.at[i] == '\n' || (h.at[i] == '\r' && h.at[i + 1] == '\n');
}

// The line after the empty one: "-Y 512 +X 1024", or another way round.
static picture_head head_of_hdr(head_bytes h) {
  size_t i = 0;
  while (i + 2 < h.count && !(h.at[i] == '\n' && ends_line(h, i + 1)))
    i++;
  i += 2;
  while (i < h.count && h.at[i] != '+' && h.at[i] != '-' && h.at[i] != '\n')
    i++;
  bool turned = i + 1 < h.count && h.at[i + 1] == 'X';
  int first = next_whole(h, &i), second = next_whole(h, &i);
  return turned ? (picture_head){first, second} : (picture_head){second, first};
}

static picture_head head_of(picture_format format, head_bytes h) {
  switch (format) {
  case PICTURE_PNG: return head_of_png(h);
  case PICTURE_PFM: return head_of_pfm(h);
  case PICTURE_HDR: return head_of_hdr(h);
  case PICTURE_JPEG: return head_of_jpeg(h);
  case PICTURE_TGA: return head_of_tga(h);
  case PICTURE_UNKNOWN: break;
  }
  return (picture_head){0};
}

static bool has_sides(picture_head p) {
  return p.width >= 1 && p.height >= 1 && p.width <= IMAGE_MAX_SIDE &&
         p.height <= IMAGE_MAX_SIDE;
}

// By the first bytes of f, `most` of them at most; false when there are none.
static bool head_within(picture_head *out, picture_format *format, FILE *f,
                        size_t most) {
  arena once = {0};
  unsigned char *bytes = ARENA_NEW(&once, unsigned char, most);
  rewind(f);
  head_bytes h = {bytes, fread(bytes, 1, most, f)};
  *format = picture_sniff(bytes, h.count < 32 ? h.count : 32);
  *out = head_of(*format, h);
  arena_free(&once);
  return h.count > 0;
}

bool picture_head_read(picture_head *out, const char *path, error *err) {
  FILE *f = file_open(path, err);
  if (f == NULL) return false;
  picture_head head;
  picture_format format;
  bool any = head_within(&head, &format, f, HEAD_USUAL);
  if (format != PICTURE_UNKNOWN && !has_sides(head))
    head_within(&head, &format, f, HEAD_MOST);
  fclose(f);
  if (!any) return fail(err, "%s: is empty, expected a picture", path);
  if (format == PICTURE_UNKNOWN)
    return fail(err,
                "%s: not a picture that can be read, expected PNG, JPEG, "
                "TGA, Radiance (.hdr) or PFM",
                path);
  if (!has_sides(head))
    return fail(err, "%s: a picture whose head does not give its size", path);
  *out = head;
  return true;
}

// picture.c

#include "picture.h"

#include "file.h"
#include "hdr.h"
#include "jpeg.h"
#include "pfm.h"
#include "png.h"
#include "tga.h"

#include <errno.h>
#include <float.h>
#include <string.h>

// One kind of file: its suffixes, and who reads it into which half of a
// picture.
typedef struct picture_kind {
  picture_format format;
  const char *name, *suffixes[2];
  bool (*load_linear)(image *, FILE *, const char *, arena *, error *);
  bool (*load_stored)(pixmap *, FILE *, const char *, arena *, error *);
} picture_kind;

static const picture_kind PICTURE_KINDS[] = {
    {PICTURE_PNG, "PNG", {"png"}, NULL, png_load},
    {PICTURE_PFM, "PFM", {"pfm"}, pfm_load, NULL},
    {PICTURE_HDR, "Radiance", {"hdr", "pic"}, hdr_load, NULL},
    {PICTURE_JPEG, "JPEG", {"jpg", "jpeg"}, NULL, jpeg_load},
    {PICTURE_TGA, "TGA", {"tga"}, NULL, tga_load},
};

enum { PICTURE_KIND_COUNT = sizeof PICTURE_KINDS / sizeof *PICTURE_KINDS };

// The kind of a format; NULL for PICTURE_UNKNOWN.
static const picture_kind *kind_of(picture_format format) {
  for (int i = 0; i < PICTURE_KIND_COUNT; i++)
    if (PICTURE_KINDS[i].format == format) return &PICTURE_KINDS[i];
  return NULL;
}

// Whether two words are equal, ASCII letters of either case.
static bool same_letters(const char *a, const char *b) {
  for (; *a != '\0' || *b != '\0'; a++, b++) {
    int x = *a >= 'A' && *a <= 'Z' ? *a - 'A' + 'a' : *a;
    if (x != *b) return false;
  }
  return true;
}

picture_format picture_format_of(const char *path) {
  const char *slash = strrchr(path, '/');
  const char *base = slash == NULL ? path : slash + 1;
  const char *dot = strrchr(base, '.');
  const char *suffix = dot == NULL ? base : dot + 1;
  for (int i = 0; i < PICTURE_KIND_COUNT; i++)
    for (int j = 0; j < 2; j++) {
      const char *known = PICTURE_KINDS[i].suffixes[j];
      if (known != NULL && same_letters(suffix, known))
        return PICTURE_KINDS[i].format;
    }
  return PICTURE_UNKNOWN;
}

picture_format picture_sniff(const unsigned char *bytes, size_t n) {
  if (n >= 8 && memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) == 0) return PICTURE_PNG;
  if (n >= 3 && memcmp(bytes, "\xff\xd8\xff", 3) == 0) return PICTURE_JPEG;
  if (n >= 2 && memcmp(bytes, "#?", 2) == 0) return PICTURE_HDR;
  if (n >= 3 && bytes[0] == 'P' && (bytes[1] == 'F' || bytes[1] == 'f') &&
      (bytes[2] == '\n' || bytes[2] == ' ' || bytes[2] == '\r'))
    return PICTURE_PFM;
  if (tga_is_plausible(bytes, n)) return PICTURE_TGA;
  return PICTURE_UNKNOWN;
}

// x, or what takes its place as radiance; *count grows when they differ.
static float repaired(float x, long *count) {
  if (x >= 0 && x <= FLT_MAX) return x;
  (*count)++;
  return x > 0 ? FLT_MAX : 0;  // infinity; NaN and below 0
}

// Repair every pixel.  Light is neither negative nor infinite, and one NaN
// would spread over all that is filtered from it.
static void repair_image(image *im, const char *path, report *r) {
  long count = 0, pixels = 0;
  size_t n = (size_t)im->width * (size_t)im->height;
  for (size_t i = 0; i < n; i++) {
    long before = count;
    vec3 *p = &im->pixels[i];
    *p = (vec3){repaired(p->x, &count), repaired(p->y, &count),
                repaired(p->z, &count)};
    pixels += count > before;
  }
  if (count > 0)
    report_warn(r,
                "%s: %ld of %zu pixels have negative or non-finite values: "
                "NaN and below 0 became 0, infinity the largest float",
                path, pixels, n);
}

// Read what the first bytes of f announce.
static bool load_any(picture *out, FILE *f, const char *path, arena *mem,
                     error *err) {
  unsigned char head[32];
  size_t n = fread(head, 1, sizeof head, f);
  if (n == 0) return fail(err, "%s: is empty, expected a picture", path);
  rewind(f);
  const picture_kind *kind = kind_of(picture_sniff(head, n));
  if (kind == NULL)
    return fail(err,
                "%s: not a picture that can be read, expected PNG, JPEG, "
                "TGA, Radiance (.hdr) or PFM",
                path);
  picture p = {.is_linear = kind->load_linear != NULL};
  bool ok = p.is_linear ? kind->load_linear(&p.linear, f, path, mem, err)
                        : kind->load_stored(&p.stored, f, path, mem, err);
  if (ok) *out = p;
  return ok;
}

bool picture_read(picture *out, const char *path, arena *mem, report *r,
                  error *err) {
  FILE *f = file_open(path, err);
  if (f == NULL) return false;
  bool ok = load_any(out, f, path, mem, err);
  fclose(f);
  if (ok && out->is_linear) repair_image(&out->linear, path, r);
  return ok;
}

bool picture_read_linear(image *out, const char *path, arena *mem, report *r,
                         error *err) {
  picture p;
  if (!picture_read(&p, path, mem, r, err)) return false;
  *out = p.is_linear ? p.linear : image_from_pixmap(mem, &p.stored, true);
  return true;
}

// Write im to an open file.
static bool save_any(const image *im, FILE *f, const char *path,
                     picture_format format, int depth, error *err) {
  switch (format) {
  case PICTURE_PNG: return png_save(im, depth, f, path, err);
  case PICTURE_PFM: return pfm_save(im, f, path, err);
  case PICTURE_HDR: return hdr_save(im, f, path, err);
  default:
    return fail(
        err, "%s: cannot write this format, expected .png, .pfm or .hdr", path);
  }
}

bool picture_write(const image *im, const char *path, picture_format format,
                   int depth, error *err) {
  arena names = {0};
  file_writer w;
  bool ok = file_create(&w, path, &names, err);
  if (ok) {
    ok = save_any(im, w.stream, path, format, depth, err);
    // A full disk shows as a failed write; only errno knows why.
    if (ferror(w.stream))
      ok = fail(err, "%s: cannot be written: %s", path, strerror(errno));
    if (ok)
      ok = file_commit(&w, err);
    else
      file_discard(&w);
  }
  arena_free(&names);
  return ok;
}

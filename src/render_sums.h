// render_sums.h — what a picture is made of while it grows: sums of samples,
// and counts.

#ifndef RENDER_SUMS_H
#define RENDER_SUMS_H

#include "film.h"
#include "first_hit.h"
#include "render_guide.h"
#include "tally.h"

// Bits of render_settings.aovs, and indices of render_result.aov by position.
// Normal, depth and albedo are means over the samples' first surfaces; what
// sees none counts 0, for depth not at all.  Variance is that of the mean, 0
// after one sample.
enum {
  RENDER_AOV_NORMAL = 1,
  RENDER_AOV_DEPTH = 2,
  RENDER_AOV_ALBEDO = 4,
  RENDER_AOV_VARIANCE = 8,
  RENDER_AOV_SAMPLES = 16,
  RENDER_AOV_COUNT = 5
};

typedef struct render_result {
  image color;                  // of the crop window
  image aov[RENDER_AOV_COUNT];  // pixels NULL where not asked for
  int spp;                      // samples a pixel, on average
  double seconds;
  double error;  // estimated relative error, 0: not estimated
  uint64_t rays, samples;
  uint64_t cut;                  // paths ended by path_naive's limit
  path_stats paths;              // those and what else paths did
  size_t film_bytes;             // of all sums
  bool squares;                  // of the colour, for its variance
  uint64_t non_finite;           // samples dropped
  int bad_x, bad_y, bad_sample;  // the first of them, in the full film
  bool stopped;                  // before spp, by *stop
} render_result;

// Of the window's pixels.  Films without sums were not asked for.
typedef struct render_sums {
  film color, normal, depth, albedo;
  tally tally;
  uint32_t taken;  // samples of each pixel, where no guide plans
} render_sums;

render_sums render_sums_new(int width, int height, unsigned aovs, bool squares,
                            arena *mem);

// Add what the first surface of a sample of pixel i looks like.
void render_sums_add_first(render_sums *s, size_t i, const first_hit *f);

// The images of a result, in mem.  A guide that has means of its own says
// what a pixel is; it may be NULL.
void render_sums_images(render_result *out, const render_sums *s, unsigned aovs,
                        const render_guide *guide, arena *mem);

// The counts of a result for a film of that width.
void render_sums_counts(render_result *out, const render_sums *s,
                        int film_width);

#endif

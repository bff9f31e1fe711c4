// tally.c

#include "tally.h"

void tally_drop(tally *t, uint64_t sample, uint64_t pixel) {
  bool first = t->non_finite++ == 0 || sample < t->bad_sample ||
               (sample == t->bad_sample && pixel < t->bad_pixel);
  if (!first) return;
  t->bad_sample = sample;
  t->bad_pixel = pixel;
}

void tally_add(tally *t, const tally *other) {
  t->paths.rays += other->paths.rays;
  t->paths.cut += other->paths.cut;
  t->paths.followed += other->paths.followed;
  t->paths.asked += other->paths.asked;
  t->paths.shadows += other->paths.shadows;
  t->paths.through += other->paths.through;
  t->paths.aimed += other->paths.aimed;
  t->paths.shared += other->paths.shared;
  t->samples += other->samples;
  if (other->non_finite == 0) return;
  tally_drop(t, other->bad_sample, other->bad_pixel);
  t->non_finite += other->non_finite - 1;
}

// build.c — whose hands.

#include "build.h"

#include "build_levels.h"
#include "bvh_read.h"
#include "clock.h"
#include "simd_runs.h"

const bvh_hands *build_avx2_hands(void) {
  bool here = build_avx2.run != NULL && simd_runs(1);
  return here ? &build_avx2 : NULL;
}

const bvh_hands *build_hands(void) {
  const bvh_hands *best = build_avx2_hands();
  return best != NULL ? best : &bvh_plain_hands;
}

void build_tree(bvh *out, const bvh *mesh, bvh_method method, arena *mem,
                pool *threads) {
  double start = clock_seconds();
  *out = (bvh){.positions = mesh->positions,
               .index = mesh->index,
               .triangle_count = mesh->triangle_count};
  arena refs = {0};
  bvh_source from = {.method = method, .mem = &refs, .hands = build_hands()};
  from.root = bvh_read(&from.refs, out, 0, &refs, threads);
  bvh_build_source(out, &from, mem, threads);
  out->seconds = clock_seconds() - start;
}

// dfg.h — how much a rough surface reflects of a white sky, as a table.
//
// The albedo of a coat of reflectance F0 is F0 c1 + c2: both numbers depend on
// the cosine to the viewer and on roughness alone.

#ifndef DFG_H
#define DFG_H

#include "arena.h"
#include "microfacet.h"
#include "pool.h"

// Nodes along sqrt(NoV) and along sqrt(roughness), both from 0 to 1: the first
// and the last lie on the edges.
enum { DFG_COLUMNS = 225, DFG_ROWS = 97 };

// c1 = integral of f (1 - (1 - oh)^5) nl, c2 = integral of f (1 - oh)^5 nl,
// where f = D V.  PBR_REPORT takes k = r^2 / 2.
typedef struct dfg_pair {
  float c1, c2;
} dfg_pair;

typedef struct dfg {
  pbr_model model;
  dfg_pair *table;  // DFG_ROWS rows of DFG_COLUMNS, roughness 0 first
  dfg_pair *mean;   // DFG_ROWS: means over the hemisphere by the cosine
} dfg;

// Who will look up what.
typedef struct dfg_need {
  pbr_model model;
  const float *roughness;
  size_t count;
} dfg_need;

// The integral itself, to 1e-5.  Both arguments in [0, 1]; roughness 0 is a
// mirror.
dfg_pair dfg_integral(pbr_model model, float nv, float roughness);

// Fill the table: a few tenths of a second.
void dfg_build(dfg *out, pbr_model model, arena *mem, pool *threads);

// The same with no rows but those that lookups of these roughness values read.
void dfg_build_for(dfg *out, dfg_need need, arena *mem, pool *threads);

// Bilinear between the nodes.  Arguments outside of [0, 1] read as the nearest
// end.  Within 1e-3 of the integral for nv >= 1e-3 and
// roughness >= 0.05.
dfg_pair dfg_lookup(const dfg *d, float nv, float roughness);
dfg_pair dfg_lookup_mean(const dfg *d, float roughness);

#endif

// lean.h — where the lobe of a rough surface looks: between the mirror
// direction and the normal, as a table.
//
// Seen head-on a lobe is round and looks along the mirror direction.  Seen from
// the side it is cut by the horizon and thinned by shadowing, and its mean
// direction leans towards the normal.  PBR_GGX alone.

#ifndef LEAN_H
#define LEAN_H

#include "arena.h"
#include "pool.h"
#include "vec.h"

// Nodes along sqrt(NoV) and along sqrt(roughness), both from 0 to 1.
enum { LEAN_COLUMNS = 33, LEAN_ROWS = 33 };

// The integrals of f wi nl, a vector in the plane of mirror direction R and
// normal n, told by their coefficients: r1 R + n1 n for f = D V (1 - (1 -
// oh)^5) and r2 R + n2 n for f = D V (1 - oh)^5.  A coat of reflectance F0 has
// the first F0 times and the second once.
typedef struct lean_pair {
  float r1, n1, r2, n2;
} lean_pair;

typedef struct lean {
  lean_pair *table;  // LEAN_ROWS rows of LEAN_COLUMNS, roughness 0 first
} lean;

// The integrals, to 2e-3.  Both arguments in [0, 1]; roughness 0 is a mirror.
lean_pair lean_integral(float nv, float roughness);

// Fill the table: a twentieth of a second.
void lean_build(lean *out, arena *mem, pool *threads);

// The same with no rows but those that lookups of these roughness values read.
void lean_build_for(lean *out, const float *roughness, int count, arena *mem,
                    pool *threads);

// Bilinear between the nodes; arguments outside of [0, 1] read as the nearest
// end.
lean_pair lean_lookup(const lean *l, float nv, float roughness);

// The unit mean direction of the lobe of a coat of reflectance f0, for unit n
// and wo with a positive cosine.
vec3 lean_towards(const lean *l, vec3 n, vec3 wo, float f0, float roughness);

#endif

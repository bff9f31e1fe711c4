// watertight.c — rays from inside of closed meshes, at points of their edges
// and at their vertices: each must hit something.

#include "../vessels.h"

#include "stress.h"

void stress_watertight(stress *s) {
  arena mem = {0};
  vessel all[VESSELS];
  vessel_losses friendly = {{0}, {0}}, slivers = {{0}, {0}};
  // Ninths of 10^7 at edges and 10^7 at vertices; a long slice has 10^8.
  size_t rays = stress_count(s, 5e3, 1e7 / 9, 5e7 / 9);
  vessels_all(all, &mem);
  for (int i = 0; i < VESSELS; i++)
    vessel_pour(i < VESSELS_FRIENDLY ? &friendly : &slivers, &all[i], rays,
                1 + 7919 * s->slice, s->size != STRESS_LONG, s->threads);
  stress_print(
      s, (stress_row){"leaks: rays at edges, sizes 1e-6 to 1e6, far, flat",
                      friendly.tried[0], friendly.lost[0], NO_LIMIT, NO_LIMIT,
                      "Embree's tests allow 2e-5; pbrt tries 2e5"});
  stress_print(s, (stress_row){"leaks: rays at vertices of the same",
                               friendly.tried[1], friendly.lost[1], NO_LIMIT,
                               NO_LIMIT, "3.6e-3 (Embree 3.13, robust)"});
  stress_print(s, (stress_row){"leaks: edges of slivers, aspect 1e7",
                               slivers.tried[0], slivers.lost[0], NO_LIMIT,
                               NO_LIMIT, "none"});
  stress_print(s, (stress_row){"leaks: vertices of slivers", slivers.tried[1],
                               slivers.lost[1], NO_LIMIT, NO_LIMIT, "none"});
  arena_free(&mem);
}

// ibl_methods.h — the other ways to sum light from an environment, one
// direction at a time: what `ibl` is measured against.

#ifndef IBL_METHODS_H
#define IBL_METHODS_H

#include "ibl_level.h"
#include "ibl_lobe.h"
#include "ibl_source.h"
#include "ibl_wave.h"

typedef enum ibl_method {
  IBL_BRUTE_FORCE,  // every texel, in double
  IBL_UNIFORM,      // directions all over the hemisphere
  IBL_SAMPLED,      // directions by the lobe's own density
  IBL_MIPPED,       // the same, each reading a mean over its share
  IBL_TREE,         // blocks of texels, as large as the lobe allows
  IBL_ORDER_2,      // spherical harmonics up to order 2
  IBL_METHODS
} ibl_method;

// Directions of the sampling methods.
enum { IBL_METHOD_SAMPLES = 1024, IBL_MOST_MIPS = 12 };

// What they read: the map with its suns, its means and its sums over 2 x 2, 4 x
// 4, ... texels, and its spectrum.
typedef struct ibl_methods {
  image mip[IBL_MOST_MIPS];
  int mips;
  image power[IBL_MOST_MIPS];   // sums of radiance times solid angle, as blocks
  image middle[IBL_MOST_MIPS];  // and where that comes from: no unit vectors
  int powers;
  wave spectrum;
  lobe by;      // what light is weighed by: ibl_methods_aim
  double k[3];  // its spectrum up to order 2
} ibl_methods;

void ibl_methods_open(ibl_methods *out, const env *e, arena *mem,
                      pool *threads);

// Choose the lobe.
void ibl_methods_aim(ibl_methods *m, lobe by);

// The sum about unit direction d by that method.
vec3 ibl_method_at(const ibl_methods *m, ibl_method how, vec3 d);

const char *ibl_method_name(ibl_method how);

// The unit direction at local x, y, z about the axis.
vec3 ibl_about(vec3 axis, vec3 local);

#endif

#include <float.h>
#include "build_kernel.h"
extern const bvh_hands build_avx2;
const bvh_hands build_avx2 = BUILD_HANDS;

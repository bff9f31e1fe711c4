#include <float.h>
#include "build_kernel.h"
extern const bvh_hands build_avx512;
const bvh_hands build_avx512 = BUILD_HANDS;

// simd.h — eight floats at once, on whatever the compiler is told to use.
//
// Included by the files that are compiled once a level (Makefile): the same
// names mean one register with AVX2, two elsewhere.  There is no fused
// multiply-add here.

#ifndef SIMD_H
#define SIMD_H

#include "simd_avx2.h"
#include "simd_base.h"

#endif

// simd.h — eight floats at once, on whatever the compiler is told to use.
//
// Included by the files that are compiled once a level (Makefile): the same
// names mean one register with AVX2, two elsewhere.  All give the same bits.
//
// f8_load, f8_store, f8_all: from memory, to it, one number in all lanes; no
// address needs to be aligned.  f8_of_bytes: eight bytes as numbers.  f8_max
// and f8_min: where either is NaN, the second.  f8_le, f8_lt: bit k says
// whether it is true of lane k.  f8_mad is the only operation that may be fused
// (one rounding, not two), and so is asked only where the product is exact.

#ifndef SIMD_H
#define SIMD_H

#include "simd_avx2.h"
#include "simd_base.h"

#endif

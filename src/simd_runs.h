// simd_runs.h — which levels of instructions this machine has.

#ifndef SIMD_RUNS_H
#define SIMD_RUNS_H

#include <stdbool.h>

// Whether this processor, and the system on it, have what code compiled for a
// level needs: 0, what every processor has; 1, AVX2; 2, AVX-512 (Makefile).
bool simd_runs(int level);

#endif

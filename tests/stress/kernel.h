// kernel.h — the same code with float and with double, as two functions.

#ifndef KERNEL_H
#define KERNEL_H

#include <stddef.h>
#include <stdint.h>

// Samples first .. first + n - 1 of a small room, of paths of so many segments
// (0: no limit): each one's radiance into out, red.
typedef struct kernel_request {
  int max_depth;
  uint64_t seed;
  size_t first, n;
} kernel_request;

void kernel_float(const kernel_request *q, double *out);
void kernel_double(const kernel_request *q, double *out);

#endif

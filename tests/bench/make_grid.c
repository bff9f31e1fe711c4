// make_grid.c — a large OBJ file on standard output, to measure readers with.
//
//   cc -O2 tests/bench/make_grid.c -lm -o build/make_grid
//   build/make_grid [TRIANGLES [FORM]] >grid.obj
//
// A wavy height field of at least TRIANGLES (default 5,000,000) triangles.
// FORM vn (default) writes v, vn and "f a//b ...", v only "f a ...", and vt
// also texture coordinates, "f a/b/c ...".

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The height over (x, y) in [0, 1]^2, and its gradient.
static void height(double x, double y, double out[3]) {
  out[0] = 0.05 * sin(23 * x) * cos(17 * y) + 0.01 * sin(211 * x + 97 * y);
  out[1] = 1.15 * cos(23 * x) * cos(17 * y) + 2.11 * cos(211 * x + 97 * y);
  out[2] = -0.85 * sin(23 * x) * sin(17 * y) + 0.97 * cos(211 * x + 97 * y);
}

int main(int argc, char **argv) {
  long triangles = argc > 1 ? strtol(argv[1], NULL, 10) : 5000000;
  const char *form = argc > 2 ? argv[2] : "vn";
  int normals = strcmp(form, "v") != 0, texcoords = strcmp(form, "vt") == 0;
  long n = (long)ceil(sqrt((double)triangles / 2));
  for (long j = 0; j <= n; j++)
    for (long i = 0; i <= n; i++) {
      double x = (double)i / (double)n, y = (double)j / (double)n, h[3];
      height(x, y, h);
      printf("v %.6f %.6f %.6f\n", 10 * x, 10 * h[0], 10 * y);
      if (texcoords) printf("vt %.6f %.6f\n", x, y);
      double length = sqrt(h[1] * h[1] + h[2] * h[2] + 1);
      if (normals)
        printf("vn %.6f %.6f %.6f\n", -h[1] / length, 1 / length,
               -h[2] / length);
    }
  for (long j = 0; j < n; j++)
    for (long i = 0; i < n; i++) {
      long a = j * (n + 1) + i + 1, b = a + n + 1;
      long f[6] = {a, b, a + 1, a + 1, b, b + 1};
      for (int k = 0; k < 6; k++) {
        if (k % 3 == 0) printf("f");
        if (texcoords) printf(" %ld/%ld/%ld", f[k], f[k], f[k]);
        if (!texcoords && normals) printf(" %ld//%ld", f[k], f[k]);
        if (!texcoords && !normals) printf(" %ld", f[k]);
        if (k % 3 == 2) printf("\n");
      }
    }
  return fflush(stdout) == 0 ? 0 : 1;
}

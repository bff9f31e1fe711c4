// make_rays_mesh.c — large OBJ files on standard output, to trace rays in.
//
//   cc -O2 tests/bench/make_rays_mesh.c -lm -o build/make_rays_mesh
//   build/make_rays_mesh FORM TRIANGLES >mesh.obj
//
// FORM rock: a sphere with bumps of all sizes, closed, at least TRIANGLES
// triangles, as a scan is.  FORM columns: leaning prisms of 40 sides and
// aspect 50 to 400 in a hall, two triangles a side: long and thin, as halls of
// columns are.  FORM stadium: a small dense rock in the middle of a large
// bowl of few triangles.

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double radius(double x, double y, double z) {
  double r = 1, a = 0.25, f = 2.3;
  for (int k = 0; k < 8; k++) {
    double u = f * x + 0.4 * k, v = f * y - 0.7 * k, w = f * z + 1.1 * k;
    r += a * sin(u + 0.6 * sin(v)) * sin(v + 0.6 * sin(w)) *
         sin(w + 0.6 * sin(u));
    a *= 0.5;
    f *= 2.1;
  }
  return r;
}

// A cube's six faces of n x n cells, pushed to the sphere; corners are not
// shared between faces, but their coordinates agree.
static long rock(long triangles, long first, double size) {
  long n = (long)ceil(sqrt((double)triangles / 12));
  for (int f = 0; f < 6; f++)
    for (long j = 0; j <= n; j++)
      for (long i = 0; i <= n; i++) {
        double u =
            tan((2.0 * (double)i / (double)n - 1) * 0.25 * 3.14159265358979);
        double v =
            tan((2.0 * (double)j / (double)n - 1) * 0.25 * 3.14159265358979);
        double s = f % 2 ? 1 : -1, p[3];
        p[f / 2] = s;
        p[(f / 2 + 1) % 3] = s * u;
        p[(f / 2 + 2) % 3] = v;
        double l = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        double r = size * radius(p[0] / l, p[1] / l, p[2] / l) / l;
        printf("v %.7g %.7g %.7g\n", r * p[0], r * p[1], r * p[2]);
      }
  for (int f = 0; f < 6; f++)
    for (long j = 0; j < n; j++)
      for (long i = 0; i < n; i++) {
        long a = first + f * (n + 1) * (n + 1) + j * (n + 1) + i, b = a + n + 1;
        printf("f %ld %ld %ld\nf %ld %ld %ld\n", a, a + 1, b, a + 1, b + 1, b);
      }
  return first + 6 * (n + 1) * (n + 1);
}

static void columns(long triangles) {
  const int sides = 40;
  long n = triangles / (2 * sides) + 1, first = 1;
  unsigned seed = 1;
  for (long c = 0; c < n; c++) {
    double r[6];
    for (int k = 0; k < 6; k++) {
      seed = seed * 1664525u + 1013904223u;
      r[k] = (double)(seed >> 8) / 16777216.0;
    }
    double x = 10 * r[0], z = 10 * r[1], w = 0.02 + 0.1 * r[2];
    double h = 4 + 4 * r[3], lean = 3 * (r[4] - 0.5), lean2 = 3 * (r[5] - 0.5);
    for (int k = 0; k < sides; k++) {
      double a = 2 * 3.14159265358979 * k / sides;
      double px = x + w * cos(a), pz = z + w * sin(a);
      printf("v %.7g 0 %.7g\nv %.7g %.7g %.7g\n", px, pz, px + lean, h,
             pz + lean2);
    }
    for (int k = 0; k < sides; k++) {
      long a = first + 2 * k, b = first + 2 * ((k + 1) % sides);
      printf("f %ld %ld %ld\nf %ld %ld %ld\n", a, a + 1, b, b, a + 1, b + 1);
    }
    first += 2 * sides;
  }
}

static void stadium(long triangles) {
  long first = rock(triangles, 1, 0.05);
  const int rings = 24, sides = 64;
  for (int j = 0; j <= rings; j++)
    for (int i = 0; i < sides; i++) {
      double a = 2 * 3.14159265358979 * i / sides;
      double r = 0.2 + 9.8 * j / rings,
             h = j < 6 ? -0.1 : 0.02 * (j - 6) * (j - 6);
      printf("v %.7g %.7g %.7g\n", r * cos(a), h, r * sin(a));
    }
  for (int j = 0; j < rings; j++)
    for (int i = 0; i < sides; i++) {
      long a = first + j * sides + i, b = first + j * sides + (i + 1) % sides;
      printf("f %ld %ld %ld %ld\n", a, b, b + sides, a + sides);
    }
}

int main(int argc, char **argv) {
  const char *form = argc > 1 ? argv[1] : "rock";
  long triangles = argc > 2 ? strtol(argv[2], NULL, 10) : 1000000;
  if (strcmp(form, "columns") == 0)
    columns(triangles);
  else if (strcmp(form, "stadium") == 0)
    stadium(triangles);
  else
    rock(triangles, 1, 1);
  return fflush(stdout) == 0 ? 0 : 1;
}

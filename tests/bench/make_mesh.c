// make_mesh.c — meshes to measure trees with, as OBJ on standard output.
//
//   cc -O2 tests/bench/make_mesh.c -lm -o build/make_mesh
//   build/make_mesh KIND [TRIANGLES] >mesh.obj
//
// KIND, each of about TRIANGLES (default 200,000):
//   ball     a sphere with bumps at every scale, like a scan
//   columns  leaning columns of 64 sides from the floor to the roof: triangles
//            hundreds of times as long as wide
//   stadium  a ball on the field of an arena of long steps and beams
//   streets  houses of walls, floors, bars and ropes along straight streets

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static long vertex_count;

static const double PI = 3.14159265358979;

// A number in [0, 1) that k decides.  Source: Vigna's splitmix64.
static double chance(uint64_t k) {
  uint64_t z = (k + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static long put_vertex(double x, double y, double z) {
  printf("v %.6f %.6f %.6f\n", x, y, z);
  return ++vertex_count;
}

static void put_quad(long a, long b, long c, long d) {
  printf("f %ld %ld %ld\nf %ld %ld %ld\n", a, b, c, a, c, d);
}

// A grid of n x 2 n cells around a sphere of radius r about (x, y, z).
static void ball(long n, double x, double y, double z, double r) {
  long first = vertex_count + 1;
  for (long j = 0; j <= n; j++)
    for (long i = 0; i <= 2 * n; i++) {
      double v = PI * (double)j / (double)n, u = PI * (double)i / (double)n;
      double h = 1;
      for (int k = 1; k < 9; k++) {
        double f = pow(2, k);
        h += 0.16 / f * sin(f * u + k) * sin(f * v + 2 * k) * sin(v);
      }
      put_vertex(x + r * h * sin(v) * cos(u), y + r * h * cos(v),
                 z + r * h * sin(v) * sin(u));
    }
  for (long j = 0; j < n; j++)
    for (long i = 0; i < 2 * n; i++) {
      long a = first + j * (2 * n + 1) + i, b = a + 2 * n + 1;
      put_quad(a, a + 1, b + 1, b);
    }
}

// A prism of `sides` sides and radius r between two points.
static void prism(int sides, double r, const double a[3], const double b[3]) {
  long first = vertex_count + 1;
  double d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  int k = fabs(d[0]) < fabs(d[1]) ? 0 : 1;
  double e[3] = {k == 0, k == 1, 0};
  double u[3] = {d[1] * e[2] - d[2] * e[1], d[2] * e[0] - d[0] * e[2],
                 d[0] * e[1] - d[1] * e[0]};
  double v[3] = {d[1] * u[2] - d[2] * u[1], d[2] * u[0] - d[0] * u[2],
                 d[0] * u[1] - d[1] * u[0]};
  double lu = r / sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
  double lv = r / sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  for (int i = 0; i < sides; i++)
    for (int end = 0; end < 2; end++) {
      const double *p = end ? b : a;
      double c = lu * cos(2 * PI * i / sides), s = lv * sin(2 * PI * i / sides);
      put_vertex(p[0] + c * u[0] + s * v[0], p[1] + c * u[1] + s * v[1],
                 p[2] + c * u[2] + s * v[2]);
    }
  for (int i = 0; i < sides; i++) {
    long p = first + 2 * i, q = first + 2 * ((i + 1) % sides);
    put_quad(p, q, q + 1, p + 1);
  }
}

// A box between two corners, turned about the y axis through (0, 0, 0).
static void block(const double lo[3], const double hi[3], double turn) {
  static const int face[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                 {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
  long first = vertex_count + 1;
  double c = cos(turn), s = sin(turn);
  for (int k = 0; k < 8; k++) {
    double x = k & 1 ? hi[0] : lo[0], z = k & 4 ? hi[2] : lo[2];
    put_vertex(c * x + s * z, k & 2 ? hi[1] : lo[1], c * z - s * x);
  }
  for (int k = 0; k < 6; k++)
    put_quad(first + face[k][0], first + face[k][1], first + face[k][2],
             first + face[k][3]);
}

static void columns(long triangles) {
  enum { SIDES = 64 };
  for (long i = 0; i < triangles / (2 * SIDES); i++) {
    uint64_t k = 4 * (uint64_t)i;
    double x = 100 * chance(k), z = 100 * chance(k + 1);
    double dx = 16 * (chance(k + 2) - 0.5), dz = 16 * (chance(k + 3) - 0.5);
    prism(SIDES, 0.4, (double[]){x, 0, z}, (double[]){x + dx, 60, z + dz});
  }
}

static void stadium(long triangles) {
  long sectors = triangles / 400 + 8;
  for (long i = 0; i < sectors; i++) {
    double turn = 2 * PI * (double)i / (double)sectors;
    double half = PI * 60 / (double)sectors;
    for (int row = 0; row < 12; row++)
      block((double[]){60 + 3.0 * row, 0, -half * (1 + 0.05 * row)},
            (double[]){63 + 3.0 * row, 2 + 1.5 * row, half * (1 + 0.05 * row)},
            turn);
    double c = cos(turn), s = sin(turn), t = sin(turn + 1), q = cos(turn + 1);
    prism(4, 0.15, (double[]){60 * c, 38, -60 * s},
          (double[]){99 * q, 24, -99 * t});
    prism(4, 0.15, (double[]){96 * c, 0, -96 * s},
          (double[]){70 * q, 40, -70 * t});
  }
  block((double[]){-60, -1, -60}, (double[]){60, 0, 60}, 0.3);
  ball((long)sqrt((double)triangles / 8) + 4, 0, 1.2, 0, 1);
}

static void streets(long triangles) {
  long n = (long)sqrt((double)triangles / 320) + 1;
  for (long h = 0; h < n * n; h++) {
    uint64_t k = 40 * (uint64_t)h;
    double x = 30 * (double)(h % n), z = 30 * (double)(h / n);
    double w = 8 + 8 * chance(k), tall = 8 + 30 * chance(k + 1);
    double turn = 0.5;
    for (int f = 0; f < 8; f++)
      block((double[]){x, tall * f / 8, z},
            (double[]){x + w, tall * f / 8 + 0.2, z + w}, turn);
    for (int b = 0; b < 12; b++) {
      double at = w * b / 12;
      block((double[]){x + at, 0, z}, (double[]){x + at + 0.1, tall, z + 0.1},
            turn);
    }
    for (int r = 0; r < 4; r++) {
      double c = cos(turn), s = sin(turn), u = x + w * chance(k + 2 + r);
      double v = z + 30 + 8 * chance(k + 8 + r);
      prism(4, 0.02, (double[]){c * u + s * z, tall, c * z - s * u},
            (double[]){c * (u + 20) + s * v, 2 + 6 * chance(k + 12 + r),
                       c * v - s * (u + 20)});
    }
  }
  double all = 30 * (double)n;
  block((double[]){-30, -1, -30}, (double[]){all, 0, all}, 0.5);
}

int main(int argc, char **argv) {
  const char *kind = argc > 1 ? argv[1] : "";
  long triangles = argc > 2 ? strtol(argv[2], NULL, 10) : 200000;
  if (strcmp(kind, "ball") == 0)
    ball((long)ceil(sqrt((double)triangles / 4)), 0, 0, 0, 1);
  else if (strcmp(kind, "columns") == 0)
    columns(triangles);
  else if (strcmp(kind, "stadium") == 0)
    stadium(triangles);
  else if (strcmp(kind, "streets") == 0)
    streets(triangles);
  else
    return fprintf(stderr, "usage: make_mesh "
                           "ball|columns|stadium|streets [TRIANGLES]\n"),
           2;
  return 0;
}

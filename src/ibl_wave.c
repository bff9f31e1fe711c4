// ibl_wave.c — a fast Fourier transform along the rows, then, for each of its
// frequencies m, Legendre functions along the columns.  Rows at the same
// distance from the equator share the functions, but for a sign.

#include "ibl_wave.h"

enum { WAVE_MAX_WIDTH = 1024 };

// PI with all digits of a double.
#define WAVE_PI 3.14159265358979324

// A complex number.
typedef struct wave_z {
  double re, im;
} wave_z;

// The roots of unity e^(2 pi i k / n) for k < n / 2.
typedef struct wave_roots {
  int n;
  wave_z root[WAVE_MAX_WIDTH / 2];
} wave_roots;

static wave_z wave_z_mul(wave_z a, wave_z b) {
  return (wave_z){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

static void wave_roots_fill(wave_roots *r, int n) {
  r->n = n;
  for (int k = 0; k < n / 2; k++)
    r->root[k] = (wave_z){cos(2 * WAVE_PI * k / n), sin(2 * WAVE_PI * k / n)};
}

// Put z[i] where i's bits read backwards.
static void wave_reverse(wave_z *z, int n) {
  for (int i = 1, j = 0; i < n; i++) {
    int bit = n >> 1;
    for (; (j & bit) != 0; bit >>= 1)
      j ^= bit;
    j ^= bit;
    if (i >= j) continue;
    wave_z t = z[i];
    z[i] = z[j], z[j] = t;
  }
}

// z[k] = sum of z[j] e^(sign 2 pi i j k / n).  Source: Cooley and Tukey 1965.
static void wave_fft(wave_z *z, const wave_roots *r, int sign) {
  int n = r->n;
  wave_reverse(z, n);
  for (int half = 1; half < n; half *= 2)
    for (int k = 0; k < half; k++) {
      wave_z w = r->root[k * (n / 2 / half)];
      w.im *= sign;
      for (int i = k; i < n; i += 2 * half) {
        wave_z a = z[i], b = wave_z_mul(w, z[i + half]);
        z[i] = (wave_z){a.re + b.re, a.im + b.im};
        z[i + half] = (wave_z){a.re - b.re, a.im - b.im};
      }
    }
}

static float wave_channel(vec3 v, int c) {
  return c == 0 ? v.x : c == 1 ? v.y : v.z;
}

// Two doubles that one instruction adds or multiplies, with gcc and clang.
#define WAVE_VECTOR __attribute__((vector_size(16)))

typedef WAVE_VECTOR double wave_pair;

// One direction of the transform: rows of the half sphere at cos theta > 0,
// from the pole to the equator, and for each row and m the sum (even) and the
// difference (odd) of the northern and the southern row's frequencies.
typedef struct wave_job {
  wave w;
  const image *map;  // analysis
  wave_grid grid;    // synthesis
  const double *k;
  int degree, rows;  // rows of one half, with the equator
  double *sine, *cosine, *weight;
  wave_rgb *even, *odd;  // [m * rows + row]
  wave_roots roots;
} wave_job;

// Legendre functions of one m along all rows, by degree.
typedef struct legendre {
  const wave_job *job;
  int m, l, first;      // rows before `first` are 0 to all degrees
  double *p0, *p1;      // of l - 1 and l
  double room[2][260];  // up to 257 rows
} legendre;

// P_mm = sqrt((2 m + 1)!! / (4 pi (2 m)!!)) sin^m.  Towards the pole it is
// nothing until l reaches m / sin theta: such rows are left out.
static void legendre_start(legendre *g, const wave_job *job, int m) {
  g->job = job, g->m = g->l = m, g->first = 0;
  g->p0 = g->room[0], g->p1 = g->room[1];
  while (g->first < job->rows - 1 &&
         m > (job->degree + 1) * job->sine[g->first] + 40)
    g->first++;
  double scale = 0.28209479177387814;  // 1 / sqrt(4 pi)
  for (int i = 1; i <= m; i++)
    scale *= sqrt((2 * i + 1) / (2.0 * i));
  for (int j = 0; j < job->rows; j++) {
    double power = j >= g->first ? scale : 0, square = job->sine[j];
    for (int bits = m; bits != 0; bits >>= 1, square *= square)
      if (bits % 2 == 1) power *= square;
    g->p0[j] = 0, g->p1[j] = power;
  }
}

// From l to l + 1, by the recurrence of three terms.
static void legendre_next(legendre *g) {
  double l = ++g->l, m = g->m, below = l - 1;
  double a = sqrt((4 * l * l - 1) / (l * l - m * m));
  double b = sqrt((below * below - m * m) / (4 * below * below - 1));
  double *p = g->p0;
  for (int j = g->first; j < g->job->rows; j++)
    p[j] = a * (g->job->cosine[j] * g->p1[j] - b * g->p0[j]);
  g->p0 = g->p1, g->p1 = p;
}

// Frequencies of a northern and a southern row at once: as real and imaginary
// part of one complex row.
static void analyse_rows(void *context, size_t row, int worker) {
  (void)worker;
  wave_job *job = context;
  const image *map = job->map;
  int n = map->width, j = (int)row, south = map->height - 1 - j;
  wave_z z[WAVE_MAX_WIDTH];
  const vec3 *a = map->pixels + (size_t)j * (size_t)n;
  const vec3 *b = map->pixels + (size_t)south * (size_t)n;
  for (int c = 0; c < 3; c++) {
    for (int i = 0; i < n; i++) {
      z[i].re = (double)wave_channel(a[i], c);
      z[i].im = south > j ? (double)wave_channel(b[i], c) : 0;
    }
    wave_fft(z, &job->roots, -1);
    for (int m = 0; m <= job->degree; m++) {
      wave_z p = z[m], q = z[(n - m) & (n - 1)];
      wave_z up = {(p.re + q.re) / 2, (p.im - q.im) / 2};
      wave_z down = {(p.im + q.im) / 2, (q.re - p.re) / 2};
      wave_rgb *e = &job->even[(size_t)m * (size_t)job->rows + row];
      wave_rgb *o = &job->odd[(size_t)m * (size_t)job->rows + row];
      e->c[c][0] = up.re + down.re, e->c[c][1] = up.im + down.im;
      o->c[c][0] = up.re - down.re, o->c[c][1] = up.im - down.im;
    }
  }
}

// What a texel of each row weighs, so that sums of harmonics up to the height
// of the map are exact: nearly its solid angle, but for the rows at the poles.
// Source: Fejer 1933, his first rule.
static void fill_weights(wave_job *job, arena *mem) {
  int height = job->map->height;
  job->weight = ARENA_NEW(mem, double, (size_t)job->rows);
  for (int j = 0; j < job->rows; j++) {
    double sum = 1, theta = WAVE_PI * (j + 0.5) / height;
    for (int k = 1; k <= height / 2; k++)
      sum -= 2 * cos(2 * k * theta) / (4.0 * k * k - 1);
    job->weight[j] = 2 * WAVE_PI / job->map->width * 2 / height * sum;
  }
}

// Sum of p[row] f[row] over the rows.
static wave_rgb wave_dot(const double *p, const wave_rgb *f, int first,
                         int rows) {
  wave_pair sum[3] = {{0, 0}, {0, 0}, {0, 0}};
  for (int j = first; j < rows; j++)
    for (int c = 0; c < 3; c++)
      sum[c] += p[j] * (wave_pair){f[j].c[c][0], f[j].c[c][1]};
  wave_rgb out;
  for (int c = 0; c < 3; c++)
    out.c[c][0] = sum[c][0], out.c[c][1] = sum[c][1];
  return out;
}

// All degrees of one m.  Texels lie half a texel off the nodes u = i / width.
static void analyse_order(void *context, size_t order, int worker) {
  (void)worker;
  wave_job *job = context;
  int m = (int)order;
  size_t at = order * (size_t)job->rows;
  legendre g;
  legendre_start(&g, job, m);
  double turn = -WAVE_PI * m / job->map->width;
  wave_z shift = {cos(turn), sin(turn)};
  for (int j = 0; j < job->rows; j++) {
    double weight = job->weight[j];
    for (int c = 0; c < 3; c++)
      for (int k = 0; k < 2; k++) {
        job->even[at + (size_t)j].c[c][k] *= weight;
        job->odd[at + (size_t)j].c[c][k] *= weight;
      }
  }
  for (int l = m; l <= job->degree; l++) {
    if (l > m) legendre_next(&g);
    const wave_rgb *f = ((l - m) % 2 == 0 ? job->even : job->odd) + at;
    wave_rgb sum = wave_dot(g.p1, f, g.first, job->rows);
    wave_rgb *a = &job->w.a[wave_at(&job->w, l, m)];
    for (int c = 0; c < 3; c++) {
      wave_z z = wave_z_mul((wave_z){sum.c[c][0], sum.c[c][1]}, shift);
      a->c[c][0] = z.re, a->c[c][1] = z.im;
    }
  }
}

// Room for the rows, and their angles: theta = pi (j + offset) / height.
static void wave_job_open(wave_job *job, double height, double offset,
                          arena *mem) {
  size_t n = (size_t)job->rows, all = n * (size_t)(job->degree + 1);
  job->sine = ARENA_NEW(mem, double, n);
  job->cosine = ARENA_NEW(mem, double, n);
  for (int j = 0; j < job->rows; j++) {
    double theta = WAVE_PI * (j + offset) / height;
    job->sine[j] = sin(theta), job->cosine[j] = cos(theta);
  }
  job->even = ARENA_NEW(mem, wave_rgb, all);
  job->odd = ARENA_NEW(mem, wave_rgb, all);
}

void wave_analyse(wave *out, const image *map, arena *mem, pool *threads) {
  arena once = {0};
  int degree = map->width / 2 - 1;
  if (degree > WAVE_MAX_DEGREE) degree = WAVE_MAX_DEGREE;
  size_t count = (size_t)(degree + 1) * (size_t)(degree + 2) / 2;
  *out = (wave){degree, ARENA_NEW(mem, wave_rgb, count)};
  wave_job *job = ARENA_NEW(&once, wave_job, 1);
  *job = (wave_job){
      .w = *out, .map = map, .degree = degree, .rows = (map->height + 1) / 2};
  wave_job_open(job, map->height, 0.5, &once);
  fill_weights(job, &once);
  wave_roots_fill(&job->roots, map->width);
  pool_run(threads, (size_t)job->rows, analyse_rows, job);
  pool_run(threads, (size_t)degree + 1, analyse_order, job);
  arena_free(&once);
}

// The rows' frequency m, from all degrees.
static void synthesise_order(void *context, size_t order, int worker) {
  (void)worker;
  wave_job *job = context;
  int m = (int)order;
  size_t at = order * (size_t)job->rows;
  legendre g;
  legendre_start(&g, job, m);
  for (int l = m; l <= job->degree; l++) {
    if (l > m) legendre_next(&g);
    if (job->k[l] == 0) continue;
    const wave_rgb *a = &job->w.a[wave_at(&job->w, l, m)];
    wave_rgb *f = ((l - m) % 2 == 0 ? job->even : job->odd) + at;
    wave_pair v[3];
    for (int c = 0; c < 3; c++)
      v[c] = job->k[l] * (wave_pair){a->c[c][0], a->c[c][1]};
    for (int j = g.first; j < job->rows; j++)
      for (int c = 0; c < 3; c++) {
        f[j].c[c][0] += g.p1[j] * v[c][0];
        f[j].c[c][1] += g.p1[j] * v[c][1];
      }
  }
}

// A row's texels from its frequencies: red and green as real and imaginary
// part of one transform, blue and nothing as those of another.
static void fill_texels(const wave_job *job, vec3 *texels, int row,
                        double sign) {
  wave_z x[WAVE_MAX_WIDTH] = {{0, 0}}, y[WAVE_MAX_WIDTH] = {{0, 0}};
  int n = job->grid.width;
  for (int m = 0; m <= job->degree; m++) {
    size_t at = (size_t)m * (size_t)job->rows + (size_t)row;
    const wave_rgb *e = &job->even[at], *o = &job->odd[at];
    wave_z f[3];
    for (int c = 0; c < 3; c++)
      f[c] = (wave_z){e->c[c][0] + sign * o->c[c][0],
                      e->c[c][1] + sign * o->c[c][1]};
    x[m] = (wave_z){f[0].re - f[1].im, f[0].im + f[1].re};
    y[m] = f[2];
    if (m == 0) continue;
    // At -m stand the conjugates.
    x[n - m] = (wave_z){f[0].re + f[1].im, f[1].re - f[0].im};
    y[n - m] = (wave_z){f[2].re, -f[2].im};
  }
  wave_fft(x, &job->roots, 1);
  wave_fft(y, &job->roots, 1);
  for (int i = 0; i < n; i++)
    texels[i] = (vec3){(float)x[i].re, (float)x[i].im, (float)y[i].re};
}

static void synthesise_rows(void *context, size_t row, int worker) {
  (void)worker;
  const wave_job *job = context;
  size_t width = (size_t)job->grid.width, last = (size_t)job->grid.height - 1;
  fill_texels(job, job->grid.texels + row * width, (int)row, 1);
  if (last - row != row)
    fill_texels(job, job->grid.texels + (last - row) * width, (int)row, -1);
}

void wave_synthesise(const wave_grid *out, const wave *w, const double *k,
                     int degree, pool *threads) {
  arena once = {0};
  wave_job *job = ARENA_NEW(&once, wave_job, 1);
  *job = (wave_job){.w = *w,
                    .grid = *out,
                    .k = k,
                    .degree = degree,
                    .rows = (out->height + 1) / 2};
  wave_job_open(job, out->height - 1, 0, &once);
  wave_roots_fill(&job->roots, out->width);
  pool_run(threads, (size_t)degree + 1, synthesise_order, job);
  pool_run(threads, (size_t)job->rows, synthesise_rows, job);
  arena_free(&once);
}

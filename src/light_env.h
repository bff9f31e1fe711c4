// light_env.h — directions towards the bright parts of an environment.

#ifndef LIGHT_ENV_H
#define LIGHT_ENV_H

#include "env.h"
#include "pick.h"
#include "pool.h"

// A table over the cells between the texels of a map, in each of which what a
// lookup returns is bilinear.  It holds what is brighter than the mean of the
// map: the even rest is found best by scattered rays.  So a constant
// environment has no table.  Source: Karlik et al. 2019, "MIS Compensation".
typedef struct light_env {
  const env *env;
  image map;         // env's, or the built-in sky as one
  float mean, peak;  // of its radiance
  float less;        // what the table leaves out everywhere: the mean, or 0
  float *scale;      // by row: of what is above that, so that it is 1 at most,
                     // times the sine of the angle to +Y
  pick rows;         // of cells: one more, the first and the last half as high
  pick *columns;     // as many cells as texels, of each row
  float irradiance;  // what the table stands for, on a plane, roughly; 0: none
  float rest;        // what it leaves out, likewise
} light_env;

void light_env_build(light_env *out, const env *e, arena *mem, pool *threads);

// Another table over the same map, which leaves out nothing.
void light_env_whole(light_env *out, const light_env *of, arena *mem,
                     pool *threads);

// A unit direction, the radiance from there and the density per steradian with
// which it comes; 0 when there is none.
typedef struct env_sample {
  vec3 wi, radiance;
  float pdf;
} env_sample;

// A sample for two uniform numbers, of columns and rows.
env_sample light_env_sample(const light_env *l, vec2 u);

// Samples for n pairs of numbers: the same as one by one, but tables are waited
// for together.
void light_env_samples(const light_env *l, const vec2 *u, size_t n,
                       env_sample *out);

// The density of light_env_sample at unit wi; and in two steps, where the first
// lets tables come nearer: uv is env_uv(wi).
float light_env_pdf(const light_env *l, vec3 wi);
void light_env_expect(const light_env *l, vec2 uv);
float light_env_density(const light_env *l, vec2 uv);

// A cell of the table: what is left of two numbers that found it, and its
// probability.
typedef struct light_env_spot {
  int column, row;
  double unit;  // that picks the column: see pick.h
  vec2 u;
  float share;
} light_env_spot;

// The most spots that are looked for together.
enum { LIGHT_TOGETHER = 64 };

// light_env_samples in two steps: the cells, whose texels are asked to come
// nearer; and what is there.  Columns are found for n spots, LIGHT_TOGETHER at
// most, of which the rows are known: s->unit finds them.
void light_env_spots(const light_env *l, const vec2 *u, size_t n,
                     light_env_spot *out);
void light_env_find_columns(const light_env *l, light_env_spot *s, size_t n);
env_sample light_env_sample_cell(const light_env *l, const light_env_spot *s);

// The cell in which (u, v) lies, and where.
typedef struct light_env_place {
  int column, row;
  vec2 at;
} light_env_place;

light_env_place light_env_place_of(const light_env *l, vec2 uv);

// The density there, if that cell has a probability of `share`.
float light_env_cell_density(const light_env *l, const light_env_place *p,
                             float v, float share);

#endif

// mesh.c

#include "mesh.h"

void mesh_bounds(const mesh *m, vec3 *lo, vec3 *hi) {
  *lo = vec3_all(INFINITY);
  *hi = vec3_all(-INFINITY);
  for (size_t i = 0; i < m->position_count; i++) {
    if (!vec3_finite(m->positions[i])) continue;
    *lo = vec3_min(*lo, m->positions[i]);
    *hi = vec3_max(*hi, m->positions[i]);
  }
}

// Differences and products of floats are exact or nearly so in double, so
// that slivers keep their area.
double mesh_triangle_area(const mesh *m, size_t t) {
  const uint32_t *corner = m->position_index + 3 * t;
  vec3 a = m->positions[corner[0]], b = m->positions[corner[1]];
  vec3 c = m->positions[corner[2]];
  if (!vec3_finite(a) || !vec3_finite(b) || !vec3_finite(c)) return 0;
  double ux = (double)b.x - (double)a.x, vx = (double)c.x - (double)a.x;
  double uy = (double)b.y - (double)a.y, vy = (double)c.y - (double)a.y;
  double uz = (double)b.z - (double)a.z, vz = (double)c.z - (double)a.z;
  double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
  return 0.5 * sqrt(x * x + y * y + z * z);
}

double mesh_area(const mesh *m) {
  double sum = 0;
  for (size_t t = 0; t < m->triangle_count; t++)
    sum += mesh_triangle_area(m, t);
  return sum;
}

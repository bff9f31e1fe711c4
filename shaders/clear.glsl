// clear.glsl — glass as a material.

// No light but from exactly the mirrored and the refracted direction.
vec3 matter_direct(matter m, vec3 n, vec3 wo, vec3 wi) {
  return vec3(0.0);
}

vec3 matter_ambient(matter m, vec3 n, vec3 wo) {
  return glass_seen(m, n, wo, vec3(1.0));
}

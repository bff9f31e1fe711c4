// mirror.glsl — a mirror, which sees the environment and nothing else.

// No light but from exactly the mirrored direction.
vec3 matter_direct(matter m, vec3 n, vec3 wo, vec3 wi) {
  return vec3(0.0);
}

vec3 matter_ambient(matter m, vec3 n, vec3 wo) {
  return m.ks * env_seen(reflect(-wo, n));
}

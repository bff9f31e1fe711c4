// glass.glsl — clear bodies, which show the environment and nothing else.

// Exact unpolarised reflectance; eta is the index inside over outside.
float glass_reflectance(float cos_i, float eta) {
  float s2 = (eta - 1.0) * (eta + 1.0) + cos_i * cos_i;
  if (!(s2 > 0.0)) return 1.0;
  float s = sqrt(s2);
  float across = (cos_i - s) / (cos_i + s);
  float along = (eta * eta * cos_i - s) / (eta * eta * cos_i + s);
  return 0.5 * (across * across + along * along);
}

// Where light leaves that entered along t at the normal n.  The far side is
// not known here.  A flat facet is taken for a pane, whose far side undoes
// what the near side did; a curved one for a ball: there the ray meets the far
// side at n - 2 (n.t) t, and leaves under the angle that it came in.
vec3 glass_exit(vec3 n, vec3 t, vec3 wo, float eta) {
  if (at_curved == 0.0) return -wo;
  return refract(t, 2.0 * dot(n, t) * t - n, eta);
}

// The environment as a clear body shows it, stained by tint on the way
// through.
vec3 glass_seen(matter m, vec3 n, vec3 wo, vec3 tint) {
  float eta = m.ni > 0.0 ? m.ni : 1.0;
  float share = glass_reflectance(dot(n, wo), eta);
  vec3 t = refract(-wo, n, 1.0 / eta);
  return mix(tint * env_seen(glass_exit(n, t, wo, eta)),
             env_seen(reflect(-wo, n)), share);
}

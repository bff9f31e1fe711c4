// blinn_phong.glsl — the twin of the Blinn-Phong of bsdf.c and matter.c.

float blinn_phong_norm(float n) {
  return (n + 2.0) * (n + 4.0) / (8.0 * PI * (exp2(-0.5 * n) + n));
}

// kd and ks scaled down to a sum of at most 1.
float scaled_down(matter m) {
  vec3 sum = m.kd + m.ks;
  return 1.0 / max(1.0, max(sum.x, max(sum.y, sum.z)));
}

vec3 matter_direct(matter m, vec3 n, vec3 wo, vec3 wi) {
  float cos_i = dot(n, wi);
  if (!(cos_i > 0.0)) return vec3(0.0);
  vec3 f = m.kd / PI;
  vec3 h = normalize(wo + wi);
  f += m.ks * (blinn_phong_norm(m.ns) * cosine_power(n, h, m.ns));
  return f * (cos_i * scaled_down(m));
}

// The lobe as wide as a roughness of the environment: alpha^2 = 2 / (n + 2).
vec3 matter_ambient(matter m, vec3 n, vec3 wo) {
  vec3 diffuse = m.kd / PI * ambient_irradiance(n);
  float roughness = sqrt(sqrt(2.0 / (m.ns + 2.0)));
  vec3 specular = m.ks * ambient_radiance(reflect(-wo, n), roughness);
  return (diffuse + specular) * scaled_down(m);
}

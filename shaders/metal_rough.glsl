// metal_rough.glsl — metallic-roughness told in Blinn-Phong: the twin of
// matter.c's.

float coat_norm(float n) {
  return (n + 2.0) * (n + 4.0) / (8.0 * PI * (exp2(-0.5 * n) + n));
}

vec3 coat_fresnel(vec3 f0, float cos_o) {
  return mix(f0, vec3(1.0), pow(1.0 - cos_o, 5.0));
}

vec3 matter_direct(matter m, vec3 n, vec3 wo, vec3 wi) {
  float cos_i = dot(n, wi), a = m.roughness * m.roughness;
  if (!(cos_i > 0.0)) return vec3(0.0);
  vec3 f0 = mix(vec3(0.04), m.kd, m.metallic);
  vec3 kd = m.kd * (1.0 - m.metallic);
  float ns = max(2.0 / (a * a) - 2.0, 0.0);
  if (!(ns < 1e8))
    return (1.0 - coat_fresnel(f0, dot(n, wo))) * kd / PI * cos_i;
  vec3 h = normalize(wo + wi);
  vec3 f = kd * (1.0 - f0) / PI;
  return cos_i * (f + f0 * coat_norm(ns) * cosine_power(n, h, ns));
}

vec3 matter_ambient(matter m, vec3 n, vec3 wo) {
  vec3 f0 = mix(vec3(0.04), m.kd, m.metallic);
  vec3 f = coat_fresnel(f0, dot(n, wo) * (1.0 - m.roughness) + m.roughness);
  vec3 kd = m.kd * (1.0 - m.metallic) * (1.0 - f);
  return kd / PI * ambient_irradiance(n) +
         f * ambient_radiance(reflect(-wo, n), m.roughness);
}

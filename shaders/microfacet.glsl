// microfacet.glsl — the twin of src/microfacet.c: same names, same arguments,
// same order of operations.  Needs num.glsl.

#define ALPHA_MIN 1e-6
#define DIELECTRIC_F0 0.04
#define V_DENOMINATOR_MIN 1e-20

#define PBR_GGX 0
#define PBR_REPORT 1

struct half_angles {
  float nl, nv, nh, oh;
  float t;
};

half_angles half_angles_of(vec3 n, vec3 wo, vec3 wi) {
  vec3 sum = wo + wi;
  float m = max(abs(sum.x), max(abs(sum.y), abs(sum.z)));
  vec3 h = m > 0.0 ? normalize(sum / m) : n;
  vec3 across = cross(n, h);
  return half_angles(dot(n, wi), dot(n, wo), dot(n, h),
                     min(0.5 * length(sum), 1.0), dot(across, across));
}

float ggx_d(float t, float nh, float alpha) {
  if (!(alpha >= ALPHA_MIN)) return 0.0;
  float a = alpha * nh;
  float s = alpha / (t + a * a);
  return s * s / PI;
}

float smith_root(float c, float alpha) {
  return sqrt(c * c * (1.0 - alpha) * (1.0 + alpha) + alpha * alpha);
}

float ggx_v(float nl, float nv, float alpha) {
  float sum = nl * smith_root(nv, alpha) + nv * smith_root(nl, alpha);
  return 0.5 / max(sum, V_DENOMINATOR_MIN);
}

float schlick_v(float nl, float nv, float k) {
  float product = (nl * (1.0 - k) + k) * (nv * (1.0 - k) + k);
  return 0.25 / max(product, V_DENOMINATOR_MIN);
}

float schlick_k_point(float roughness) {
  return (roughness + 1.0) * (roughness + 1.0) * 0.125;
}

float schlick_k_env(float roughness) {
  return roughness * roughness * 0.5;
}

vec3 fresnel_schlick(vec3 f0, float oh) {
  float m = 1.0 - oh, m2 = m * m;
  return mix(f0, vec3(1.0), m2 * m2 * m);
}

vec3 metal_rough_f0(vec3 c, float metallic) {
  return mix(vec3(DIELECTRIC_F0), c, metallic);
}

struct rough_terms {
  int model;
  vec3 f0;
  vec3 kd;
  float alpha;
  float k;
  float e_mean;
};

float rough_v(rough_terms s, half_angles a) {
  if (s.model == PBR_GGX) return ggx_v(a.nl, a.nv, s.alpha);
  return schlick_v(a.nl, a.nv, s.k);
}

vec3 rough_specular(rough_terms s, half_angles a) {
  float dv = ggx_d(a.t, a.nh, s.alpha) * rough_v(s, a);
  return fresnel_schlick(s.f0, a.oh) * dv;
}

vec3 rough_diffuse(rough_terms s, half_angles a, float e_l, float e_v) {
  if (s.model == PBR_GGX)
    return s.kd * ((1.0 - e_l) * (1.0 - e_v) / (1.0 - s.e_mean) / PI);
  return s.kd * (vec3(1.0) - fresnel_schlick(s.f0, a.oh)) / PI;
}

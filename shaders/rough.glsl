// rough.glsl — metallic-roughness by microfacets, in place of
// metal_rough.glsl: the twin of bsdf_rough.c.  Needs microfacet.glsl, and
// mirrored.glsl or another file that says where lobes look.

// Pairs by sqrt(nv) and sqrt(roughness), and in one more column their means.
uniform sampler2D u_dfg;

// The pair of a place in the table: x in columns, roughness in [0, 1].
vec2 dfg_at(float x, float roughness) {
  vec2 size = vec2(textureSize(u_dfg, 0));
  float y = sqrt(clamp(roughness, 0.0, 1.0)) * (size.y - 1.0);
  return textureLod(u_dfg, (vec2(x, y) + 0.5) / size, 0.0).rg;
}

vec2 dfg_lookup(float nv, float roughness) {
  float columns = float(textureSize(u_dfg, 0).x - 1);
  return dfg_at(sqrt(clamp(nv, 0.0, 1.0)) * (columns - 1.0), roughness);
}

vec2 dfg_lookup_mean(float roughness) {
  return dfg_at(float(textureSize(u_dfg, 0).x - 1), roughness);
}

// The specular albedo of a dielectric, of a pair of the table.
float dielectric_albedo(vec2 pair) {
  return DIELECTRIC_F0 * pair.x + pair.y;
}

rough_terms rough_of(matter m) {
  rough_terms s;
#ifdef MODEL_REPORT
  s.model = PBR_REPORT;
#else
  s.model = PBR_GGX;
#endif
  s.f0 = metal_rough_f0(m.kd, m.metallic);
  s.kd = m.kd * (1.0 - m.metallic);
  s.alpha = m.roughness * m.roughness;
  s.k = schlick_k_point(m.roughness);
  s.e_mean = dielectric_albedo(dfg_lookup_mean(m.roughness));
  return s;
}

vec3 matter_direct(matter m, vec3 n, vec3 wo, vec3 wi) {
  half_angles a = half_angles_of(n, wo, wi);
  if (!(a.nl > 0.0 && a.nv > 0.0)) return vec3(0.0);
  rough_terms s = rough_of(m);
  float e_l = dielectric_albedo(dfg_lookup(a.nl, m.roughness));
  float e_v = dielectric_albedo(dfg_lookup(a.nv, m.roughness));
  return (rough_diffuse(s, a, e_l, e_v) + rough_specular(s, a)) * a.nl;
}

// The report's share of the ground where light comes from all around: Fresnel
// against the normal, and less steep on rough surfaces.
vec3 report_kd(rough_terms s, float nv, float roughness) {
  float m = clamp(1.0 - nv, 0.0, 1.0), m2 = m * m;
  vec3 top = max(vec3(1.0 - roughness), s.f0);
  return s.kd * (1.0 - mix(s.f0, top, m2 * m2 * m));
}

vec3 matter_ambient(matter m, vec3 n, vec3 wo) {
  rough_terms s = rough_of(m);
  float nv = dot(n, wo);
  vec2 pair = dfg_lookup(nv, m.roughness);
  vec3 kd = s.model == PBR_GGX ? s.kd * (1.0 - dielectric_albedo(pair))
                               : report_kd(s, nv, m.roughness);
  float f0 = (s.f0.x + s.f0.y + s.f0.z) / 3.0;
  vec3 towards = lobe_towards(n, wo, f0, m.roughness);
  return kd / PI * ambient_irradiance(n) +
         (s.f0 * pair.x + pair.y) *
             ambient_radiance(towards, m.roughness);
}

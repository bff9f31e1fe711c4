// surface.frag — the light that a surface sends to the eye.

out vec4 out_color;

void main() {
#ifdef ONCE
  at_find();
#endif
  vec3 wo = normalize(u_eye - at_position);
  float side = at_front ? 1.0 : -1.0;
  vec3 ng = side * at_facet, n = normal_face(side * normal_at(), wo);
  matter m = matter_at();
  vec3 sum = matter_ambient(m, n, wo);
#if LIGHTS > 0
  for (int i = 0; i < LIGHTS; i++) {
    vec3 power, wi = light_at(i, at_position, power);
    vec3 f = matter_direct(m, n, wo, wi);
    if (max(f.x, max(f.y, f.z)) > 0.0)
      sum += f * power * light_reaches(i, at_position, ng);
  }
#endif
#ifdef CLEAR
  vec3 through = min(m.tf, vec3(1.0));
  sum = mix(sum, glass_seen(m, n, wo, m.kd), through);
#endif
  if (at_front) sum += matter_emission();
#ifdef ONCE
  out_color = seen_share() * vec4(sum, 1.0);
#else
  out_color = vec4(sum, matter_opacity());
#endif
}

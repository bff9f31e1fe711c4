// mirrored.glsl — the split sum's answer to where a lobe looks: along the
// mirror direction, from wherever it is seen.

vec3 lobe_towards(vec3 n, vec3 wo, float f0, float roughness) {
  return reflect(-wo, n);
}

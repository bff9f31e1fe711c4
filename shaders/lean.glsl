// lean.glsl — where lobes look: the twin of lean.c, in place of mirrored.glsl.

// Pairs by sqrt(nv) and sqrt(roughness).
uniform sampler2D u_lean;

vec4 lean_lookup(float nv, float roughness) {
  vec2 size = vec2(textureSize(u_lean, 0));
  vec2 at = sqrt(clamp(vec2(nv, roughness), 0.0, 1.0)) * (size - 1.0);
  return textureLod(u_lean, (at + 0.5) / size, 0.0);
}

vec3 lobe_towards(vec3 n, vec3 wo, float f0, float roughness) {
  vec4 p = lean_lookup(dot(n, wo), roughness);
  vec2 sum = f0 * p.xy + p.zw;
  return normalize(sum.x * reflect(-wo, n) + sum.y * n);
}

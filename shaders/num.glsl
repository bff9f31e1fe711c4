// num.glsl — numbers that every shader may need.

const float PI = 3.14159265;

// h.z^n for a unit half vector at distance h = cos to the normal: near the
// pole from sin^2, as in bsdf.c, since the cosine itself is too coarse there.
float cosine_power(vec3 n, vec3 h, float exponent) {
  vec3 across = cross(n, h);
  float t = dot(across, across);
  if (t >= 0.25) return pow(max(dot(n, h), 0.0), exponent);
  float z = t / (2.0 - t), z2 = z * z;
  float atanh_z =
      z * (1.0 + z2 * (1.0 / 3.0 + z2 * (1.0 / 5.0 + z2 * (1.0 / 7.0))));
  return exp2(-exponent * 1.44269504 * atanh_z);
}

// first.frag — what a surface looks like by itself: its normal, its depth or
// its base colour.  FIRST is that of raster_shading.

uniform vec3 u_forward;
uniform vec2 u_first;  // scale, and what is added

out vec4 out_color;

// White for glass, the colour of the reflection for a mirror.
vec3 first_albedo(matter m) {
#if defined(KIND_GLASS)
  return vec3(1.0);
#elif defined(KIND_MIRROR)
  return m.ks;
#else
  return m.kd;
#endif
}

void main() {
#if FIRST == 1
  vec3 it = normal_at();
#elif FIRST == 2
  vec3 it = vec3(dot(at_position - u_eye, u_forward));
#else
  vec3 it = first_albedo(matter_at());
#endif
  out_color = vec4(it * u_first.x + u_first.y, 1.0);
}

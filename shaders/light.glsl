// light.glsl — point and directional lights.

#if LIGHTS > 0
// The position and 1, or the unit direction to the light and 0.
uniform vec4 u_light_at[LIGHTS];

// W/sr, or W/m^2 on a facing plane.
uniform vec3 u_light_power[LIGHTS];

// The unit direction to light i, and its irradiance on a facing plane at p.
vec3 light_at(int i, vec3 p, out vec3 power) {
  vec3 d = u_light_at[i].xyz;
  power = u_light_power[i];
  if (u_light_at[i].w == 0.0) return d;
  d -= p;
  float r2 = dot(d, d);
  power = r2 > 0.0 ? power / r2 : vec3(0.0);
  return d * inversesqrt(r2);
}
#endif

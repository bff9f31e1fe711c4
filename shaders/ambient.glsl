// ambient.glsl — light from the environment, as much as two numbers know of
// it: the irradiance from above and that from below.

uniform vec3 u_ambient_above, u_ambient_below;

// True irradiance on a surface of unit normal n.
vec3 ambient_irradiance(vec3 n) {
  return mix(u_ambient_below, u_ambient_above, 0.5 + 0.5 * n.y);
}

// The mean radiance around direction d under a lobe of that roughness.
vec3 ambient_radiance(vec3 d, float roughness) {
  return mix(env_seen(d), ambient_irradiance(d) / PI, roughness);
}

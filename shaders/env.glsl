// env.glsl — the environment as seen in a direction: the twin of env.c.
//
// ENV_KIND is that of env.h: 0 none, 1 constant, 2 the built-in sky, 3 a map.

uniform sampler2D u_env_map;
uniform vec3 u_env_scale;    // scale, times the colour of a constant
uniform float u_env_rotate;  // turns

// The built-in sky, before scaling.
vec3 env_sky(vec3 d) {
  const vec3 zenith = vec3(0.16, 0.30, 0.60);
  const vec3 horizon = vec3(0.62, 0.68, 0.74);
  const vec3 ground = vec3(0.19, 0.18, 0.17);
  const vec3 sun = vec3(4.6, 4.2, 3.5);
  const vec3 sun_at = vec3(-2.0, 2.0, 1.0) / 3.0;
  float turn = 2.0 * PI * u_env_rotate, c = cos(turn), s = sin(turn);
  d = vec3(d.x * c - d.z * s, d.y, d.z * c + d.x * s);
  float h = clamp(d.y, -1.0, 1.0);
  vec3 sky = h >= 0.0 ? mix(zenith, horizon, pow(1.0 - h, 4.0))
                      : mix(ground, horizon, pow(1.0 + h, 16.0));
  float glow = pow(clamp(dot(d, sun_at), 0.0, 1.0), 16.0);
  return sky + glow * sun;
}

// Radiance that arrives from the unit direction d.
vec3 env_seen(vec3 d) {
#if ENV_KIND == 1
  return u_env_scale;
#elif ENV_KIND == 2
  return u_env_scale * env_sky(d);
#elif ENV_KIND == 3
  float u = 0.5 + atan(d.x, -d.z) / (2.0 * PI) + u_env_rotate;
  float v = atan(length(d.xz), d.y) / PI;
  return u_env_scale * textureLod(u_env_map, vec2(u, v), 0.0).rgb;
#else
  return vec3(0.0);
#endif
}

// matter.glsl — a material at a point, its textures looked up: the twin of
// matter.c.  MAP_KD and so on say which textures there are.

// What scatters light at a point.
struct matter {
  vec3 kd, ks;  // kd: the base colour of metallic-roughness
  vec3 tf;
  float ns, ni, roughness, metallic;
};

#ifdef ONCE
// Row k of the material in the table: kd and roughness; ks and ns; ke and ni; tf
// and metallic; the last is not for us.
vec4 matter_row(int k) {
  return texelFetch(u_materials, 5 * at_material + k);
}

vec3 matter_emission() {
  return matter_row(2).rgb;
}

matter matter_at() {
  vec4 kd = matter_row(0), ks = matter_row(1), ke = matter_row(2);
  vec4 tf = matter_row(3);
  return matter(kd.rgb * at_color, ks.rgb, tf.rgb, ks.w, ke.w, kd.w, tf.w);
}
#else
uniform vec3 u_kd, u_ks, u_ke, u_tf;
uniform float u_ns, u_ni, u_d, u_roughness, u_metallic;
uniform sampler2D u_map_kd, u_map_ks, u_map_ke, u_map_ns, u_map_d;
uniform sampler2D u_map_pr, u_map_pm, u_map_bump, u_map_norm;

// Scale and offset of texture coordinates, by texture in the order above.
uniform vec4 u_map_place[9];

// The weights that make one number of a texel.
uniform vec4 u_map_channel[9];

// Pictures have their first row on top.
vec2 map_place(int map, vec2 uv) {
  vec2 placed = uv * u_map_place[map].xy + u_map_place[map].zw;
  return vec2(placed.x, 1.0 - placed.y);
}

vec3 map_rgb(sampler2D from, int map) {
  return texture(from, map_place(map, at_texcoord)).rgb;
}

float map_number(sampler2D from, int map) {
  vec4 texel = texture(from, map_place(map, at_texcoord));
  return dot(texel, u_map_channel[map]);
}

vec3 matter_emission() {
#ifdef MAP_KE
  return u_ke * map_rgb(u_map_ke, 2);
#else
  return u_ke;
#endif
}

float matter_opacity() {
#ifdef MAP_D
  return clamp(u_d * map_number(u_map_d, 4), 0.0, 1.0);
#else
  return clamp(u_d, 0.0, 1.0);
#endif
}

matter matter_at() {
  matter m =
      matter(u_kd * at_color, u_ks, u_tf, u_ns, u_ni, u_roughness, u_metallic);
#ifdef MAP_KD
  m.kd *= map_rgb(u_map_kd, 0);
#endif
#ifdef MAP_KS
  m.ks *= map_rgb(u_map_ks, 1);
#endif
#ifdef MAP_NS
  m.ns *= map_number(u_map_ns, 3);
#endif
#ifdef MAP_PR
  m.roughness = map_number(u_map_pr, 5);
#endif
#ifdef MAP_PM
  m.metallic = map_number(u_map_pm, 6);
#endif
  return m;
}
#endif

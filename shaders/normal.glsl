// normal.glsl — the shading normal: the twin of surface_normal.c.

// n made unit, or, where it leans too far from the facet's normal, as near to
// it as is allowed.
vec3 normal_lean(vec3 n, vec3 ng) {
  n = normalize(n);
  float c = dot(n, ng);
  if (c >= 0.01) return n;
  vec3 across = n - c * ng;
  if (!(dot(across, across) > 0.5)) return ng;
  return normalize(normalize(across) + 0.01 * ng);
}

// n turned just far enough to face wo.
vec3 normal_face(vec3 n, vec3 wo) {
  float c = dot(n, wo);
  if (c > 0.0) return n;
  vec3 across = n - c * wo;
  if (!(dot(across, across) > 1e-6)) return wo;
  return normalize(normalize(across) + wo / 1024.0);
}

#if defined(MAP_BUMP) || defined(MAP_NORM)
// How position grows with texture coordinates, from the neighbouring pixels;
// false where the texture is degenerate.
bool texture_frame(out vec3 dpdu, out vec3 dpdv) {
  vec3 px = dFdx(at_position), py = dFdy(at_position);
  vec2 wx = dFdx(at_texcoord), wy = dFdy(at_texcoord);
  float det = wx.x * wy.y - wx.y * wy.x;
  dpdu = (px * wy.y - py * wx.y) / det;
  dpdv = (py * wx.x - px * wy.x) / det;
  return abs(det) > 0.0;
}
#endif

#ifdef MAP_NORM
vec3 normal_mapped(vec3 n, vec3 dpdu, vec3 dpdv) {
  vec3 c = 2.0 * map_rgb(u_map_norm, 8) - 1.0;
  vec3 t = normalize(dpdu - dot(dpdu, n) * n), b = cross(n, t);
  if (dot(b, dpdv) < 0.0) b = -b;
  return normalize(c.x * t + c.y * b + c.z * n);
}
#endif

#ifdef MAP_BUMP
uniform float u_bump;  // world units of height

float bump_height(vec2 uv) {
  return dot(texture(u_map_bump, map_place(7, uv)), u_map_channel[7]);
}

vec3 normal_bumped(vec3 n, vec3 dpdu, vec3 dpdv) {
  vec2 texels = vec2(textureSize(u_map_bump, 0)) * abs(u_map_place[7].xy);
  vec2 d = 0.5 / texels, uv = at_texcoord;
  float du = bump_height(uv + vec2(d.x, 0)) - bump_height(uv - vec2(d.x, 0));
  float dv = bump_height(uv + vec2(0, d.y)) - bump_height(uv - vec2(0, d.y));
  vec2 slope = u_bump * vec2(du, dv) * texels;
  vec3 across_v = cross(dpdv, n), across_u = cross(n, dpdu);
  float det = dot(dpdu, across_v);
  if (!(abs(det) > 0.0)) return n;
  return normalize(n - (slope.x * across_v + slope.y * across_u) / det);
}
#endif

// The shading normal on the side of the winding.
vec3 normal_at() {
  vec3 n = normal_lean(at_normal, at_facet);
#if defined(MAP_BUMP) || defined(MAP_NORM)
  vec3 dpdu, dpdv;
  if (!texture_frame(dpdu, dpdv)) return n;
#ifdef MAP_NORM
  n = normal_mapped(n, dpdu, dpdv);
#endif
#ifdef MAP_BUMP
  n = normal_bumped(n, dpdu, dpdv);
#endif
  n = normal_lean(n, at_facet);
#endif
  return n;
}

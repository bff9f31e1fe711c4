// at_once.glsl — where the surface is that a sample sees, by the number of its
// triangle: in place of at.glsl.

uniform samplerBuffer u_vertices;  // four texels a vertex, see surface.vert
uniform samplerBuffer u_materials;
uniform vec3 u_eye;

vec3 at_position, at_normal, at_facet, at_color;
vec2 at_texcoord;
ivec2 at_gloss;
float at_curved;
bool at_front;
int at_material;

// So many edges of a triangle is a place away from it at most.
#define AT_FARTHEST 8.0

// What is a and b and c at the corners, at the barycentric place uv.
vec3 at_between(vec3 a, vec3 b, vec3 c, vec2 uv) {
  return a + uv.x * (b - a) + uv.y * (c - a);
}

// The place in the triangle of corners a, b, c that the eye sees along d; next to
// it where only another sample of the pixel sees the triangle, and not far from
// it even where that is seen from its edge.
vec2 at_place(vec3 a, vec3 b, vec3 c, vec3 d) {
  vec3 s = u_eye - a, q = cross(s, b - a), h = cross(d, c - a);
  float det = dot(b - a, h);
  vec2 uv = vec2(dot(s, h), dot(d, q)) / det;
  if (!(abs(det) > 0.0)) return vec2(1.0 / 3.0);
  return clamp(uv, -AT_FARTHEST, AT_FARTHEST);
}

vec4 at_texel(int vertex, int k) {
  return texelFetch(u_vertices, 4 * vertex + k);
}

// Set all of the above.
void at_find() {
  int v = 3 * int(max(seen_by(u_sample), 1u) - 1u);
  vec4 a = at_texel(v, 0), b = at_texel(v + 1, 0), c = at_texel(v + 2, 0);
  vec2 uv = at_place(a.xyz, b.xyz, c.xyz, seen_along());
  vec4 na = at_texel(v, 1), nb = at_texel(v + 1, 1), nc = at_texel(v + 2, 1);
  vec4 color = at_texel(v, 3);
  at_position = at_between(a.xyz, b.xyz, c.xyz, uv);
  at_normal = at_between(na.xyz, nb.xyz, nc.xyz, uv);
  at_facet = at_texel(v, 2).xyz;
  at_curved = a.w;
  at_front = dot(at_facet, u_eye - a.xyz) > 0.0;
  at_color = color.rgb;
#ifdef COLORS
  at_color = at_between(color.rgb, at_texel(v + 1, 3).rgb,
                        at_texel(v + 2, 3).rgb, uv);
#endif
  at_material = int(color.w);
  at_gloss = ivec2(texelFetch(u_materials, 5 * at_material + 4).yz);
}

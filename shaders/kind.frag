// kind.frag — which program shades what the sample in question sees, as a depth:
// 0 where an earlier sample of the pixel sees the same.

uniform samplerBuffer u_vertices, u_materials;
uniform float u_nothing;  // what shades a sample that sees no triangle

void main() {
  uint mine = seen_by(u_sample);
  int vertex = 12 * int(max(mine, 1u) - 1u);
  int material = int(texelFetch(u_vertices, vertex + 3).w);
  float kind = texelFetch(u_materials, 5 * material + 4).x;
  if (mine == 0u) kind = u_nothing;
  for (int k = 0; k < SAMPLES; k++)
    if (k < u_sample && seen_by(k) == mine) kind = 0.0;
  gl_FragDepth = kind;
}

// cover.vert — one triangle that covers the picture at a depth.

uniform float u_depth;  // 0 to 1, as it is stored

void main() {
  vec2 at = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(at, CLIP_Z(u_depth), 1.0);
}

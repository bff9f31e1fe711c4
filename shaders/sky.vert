// sky.vert — one triangle that covers the picture, behind everything.

uniform vec3 u_sky_corner, u_sky_right, u_sky_up;

out vec3 at_direction;

void main() {
  vec2 at = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  at_direction = u_sky_corner + (0.5 + 0.5 * at.x) * u_sky_right +
                 (0.5 + 0.5 * at.y) * u_sky_up;
  gl_Position = vec4(at, SKY_DEPTH, 1.0);
}

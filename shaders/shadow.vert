// shadow.vert — triangles to a layer of the shadow maps.

in vec4 in_position;

uniform mat4 u_clip;

void main() {
  gl_Position = u_clip * vec4(in_position.xyz, 1.0);
}

// surface.vert — triangles to the picture.

in vec3 in_position, in_normal;
in vec4 in_facet;  // unit normal by the winding; 1 where it is curved
in vec2 in_texcoord;
in vec3 in_color;

uniform mat4 u_clip;  // from the world, about the middle of the scene

out vec3 at_position, at_normal, at_color;
flat out vec3 at_facet;
flat out float at_curved;
out vec2 at_texcoord;

void main() {
  at_position = in_position;
  at_normal = in_normal;
  at_facet = in_facet.xyz;
  at_curved = in_facet.w;
  at_texcoord = in_texcoord;
  at_color = in_color;
  gl_Position = u_clip * vec4(in_position, 1.0);
}

// surface.vert — triangles to the picture.

in vec4 in_position;  // and 1 where the triangle is curved
in vec4 in_normal;    // and u
in vec4 in_facet;     // unit normal by the winding, and v
in vec4 in_color;     // and the number of the material

uniform mat4 u_clip;  // from the world, about the middle of the scene

out vec3 at_position, at_normal, at_color;
flat out vec3 at_facet;
flat out float at_curved;
out vec2 at_texcoord;

void main() {
  at_position = in_position.xyz;
  at_curved = in_position.w;
  at_normal = in_normal.xyz;
  at_facet = in_facet.xyz;
  at_texcoord = vec2(in_normal.w, in_facet.w);
  at_color = in_color.xyz;
  gl_Position = u_clip * vec4(in_position.xyz, 1.0);
}

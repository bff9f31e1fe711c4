// at.glsl — where a surface is, as its triangle is drawn.

in vec3 at_position;      // world space, about the middle of the scene
in vec3 at_normal;        // interpolated
flat in vec3 at_facet;    // unit, by the winding
flat in float at_curved;  // 1 where the triangle stands for something round
in vec2 at_texcoord;
in vec3 at_color;

uniform vec3 u_eye;

// The first texel and the width of the environment blurred for this surface.
uniform ivec2 u_gloss;
#define at_gloss u_gloss

#define at_front gl_FrontFacing

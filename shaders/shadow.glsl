// shadow.glsl — what the lights see, as depths in the layers of one texture.

#ifdef SHADOWS
uniform sampler2DArrayShadow u_shadow;
uniform mat4 u_shadow_of[SHADOW_LAYERS];  // to the clip space of a layer

// The look-up is moved off the surface by this many texels.
#ifndef SHADOW_OFFSET
#define SHADOW_OFFSET 2.0
#endif

// By light: the first layer, and the side of a texel in world units (for a
// point light at distance 1).
uniform vec2 u_shadow_light[LIGHTS];

// Of the six layers of a point light the one that looks along d: +x -x +y -y
// +z -z.
int shadow_face(vec3 d) {
  vec3 a = abs(d);
  if (a.x >= a.y && a.x >= a.z) return d.x >= 0.0 ? 0 : 1;
  if (a.y >= a.z) return d.y >= 0.0 ? 2 : 3;
  return d.z >= 0.0 ? 4 : 5;
}

// The share of light i that reaches p, seen from the side of ng.
float light_reaches(int i, vec3 p, vec3 ng) {
  int layer = int(u_shadow_light[i].x);
  float texel = u_shadow_light[i].y;
  if (u_light_at[i].w > 0.0) {
    vec3 d = p - u_light_at[i].xyz, a = abs(d);
    layer += shadow_face(d);
    texel *= max(a.x, max(a.y, a.z));
  }
  vec4 q = u_shadow_of[layer] * vec4(p + SHADOW_OFFSET * texel * ng, 1.0);
  vec3 at = q.xyz / q.w;
  return texture(u_shadow,
                 vec4(0.5 + 0.5 * at.xy, float(layer), SHADOW_DEPTH(at.z)));
}
#else
float light_reaches(int i, vec3 p, vec3 ng) {
  return 1.0;
}
#endif

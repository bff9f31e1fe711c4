// seen.glsl — which triangle a sample sees.  SAMPLES: how many a pixel has.

#if SAMPLES > 1
uniform usampler2DMS u_seen;
#else
uniform usampler2D u_seen;
#endif

uniform int u_sample;  // the one in question

// The number of the triangle that sample k sees, and 1; 0 for none.
uint seen_by(int k) {
#if SAMPLES > 1
  return texelFetch(u_seen, ivec2(gl_FragCoord.xy), k).r;
#else
  return texelFetch(u_seen, ivec2(gl_FragCoord.xy), 0).r;
#endif
}

// The share of the pixel's samples that see what the one in question sees.
float seen_share() {
  uint mine = seen_by(u_sample);
  float same = 0.0;
  for (int k = 0; k < SAMPLES; k++)
    same += seen_by(k) == mine ? 1.0 : 0.0;
  return same / float(SAMPLES);
}

// The direction through the middle of the pixel; its length means nothing.
uniform vec3 u_sky_corner, u_sky_right, u_sky_up;
uniform vec2 u_film;  // width and height in pixels

vec3 seen_along() {
  vec2 at = gl_FragCoord.xy / u_film;
  return u_sky_corner + at.x * u_sky_right + at.y * u_sky_up;
}

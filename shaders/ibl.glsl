// ibl.glsl — light from the environment, summed beforehand, in place of
// ambient.glsl: the twin of ibl.c and ibl_level.c.  The levels lie one after
// the other in a texture; its own row length means nothing.
//
// IBL_LEVELS: how many by roughness; IBL_ROUGHNESS, IBL_START, IBL_WIDTH: lists
// by level, the irradiance last.

const int IBL_ROW = 2048;

uniform sampler2D u_ibl;

vec3 ibl_texel(int at) {
  return texelFetch(u_ibl, ivec2(at % IBL_ROW, at / IBL_ROW), 0).rgb;
}

// The weights of the four nodes around a place t in [0, 1) of a cell.
vec4 spline_weights(float t) {
  float s = 1.0 - t;
  return vec4(s * s * s, 4.0 - 6.0 * t * t + 3.0 * t * t * t,
              4.0 - 6.0 * s * s + 3.0 * s * s * s, t * t * t) / 6.0;
}

// Four nodes of the row that starts at `start`, x0 the second.
vec3 ibl_row(int start, int x0, int width, vec4 w) {
  int last = width - 1;
  return w.x * ibl_texel(start + ((x0 - 1) & last)) +
         w.y * ibl_texel(start + (x0 & last)) +
         w.z * ibl_texel(start + ((x0 + 1) & last)) +
         w.w * ibl_texel(start + ((x0 + 2) & last));
}

// A level is its first texel and its width.
vec3 ibl_level_at(ivec2 level, vec2 uv) {
  int width = level.y, height = width / 2 + 1;
  float x = fract(uv.x) * float(width);
  float y = clamp(uv.y, 0.0, 1.0) * float(height - 1);
  int x0 = int(x), y0 = min(int(y), height - 2);
  vec4 wx = spline_weights(x - float(x0)), wy = spline_weights(y - float(y0));
  int start = level.x + y0 * width;
  vec3 sum = wy.x * ibl_row(start, x0, width, wx) +
             wy.y * ibl_row(start + width, x0, width, wx) +
             wy.z * ibl_row(start + 2 * width, x0, width, wx) +
             wy.w * ibl_row(start + 3 * width, x0, width, wx);
  return max(sum, vec3(0.0));
}

vec3 ibl_towards(ivec2 level, vec3 d) {
  float u = 0.5 + atan(d.x, -d.z) / (2.0 * PI) + u_env_rotate;
  float v = atan(length(d.xz), d.y) / PI;
  return u_env_scale * ibl_level_at(level, vec2(u, v));
}

vec3 ibl_level_towards(int level, vec3 d) {
  return ibl_towards(ivec2(IBL_START[level], IBL_WIDTH[level]), d);
}

// True irradiance on a surface of unit normal n.
vec3 ambient_irradiance(vec3 n) {
  return ibl_level_towards(IBL_LEVELS, n);
}

// The mean radiance around direction d under a lobe of that roughness; where
// that is known beforehand, without a look at the list.
vec3 ambient_radiance(vec3 d, float roughness) {
#if defined(GLOSS_SHARP)
  return env_seen(d);
#elif defined(GLOSS_LEVEL)
  return ibl_towards(at_gloss, d);
#elif IBL_LEVELS > 0
  if (!(roughness > 0.0)) return env_seen(d);
  float first = IBL_ROUGHNESS[0];
  if (roughness < first) {
    float t = roughness / first;
    t = t * t * t * t;
    return mix(env_seen(d), ibl_level_towards(0, d), t);
  }
  int i = 0;
  while (i + 1 < IBL_LEVELS && IBL_ROUGHNESS[i + 1] <= roughness)
    i++;
  vec3 low = ibl_level_towards(i, d);
  if (i + 1 == IBL_LEVELS || roughness == IBL_ROUGHNESS[i]) return low;
  float step = IBL_ROUGHNESS[i + 1] - IBL_ROUGHNESS[i];
  return mix(low, ibl_level_towards(i + 1, d),
             (roughness - IBL_ROUGHNESS[i]) / step);
#else
  return env_seen(d);
#endif
}

// raster_shadow.c

#include "raster_shadow.h"

// Texels a side when nothing else is asked for: at distance 5 from a lamp one
// is 1 cm wide; and when there are more layers than MANY_LAYERS, so that the
// texture stays below 256 MiB.
enum { SHADOW_SIZE = 1024, SHADOW_SIZE_MANY = 512, MANY_LAYERS = 64 };

// A face of a point light sees this many texels more than its quarter of the
// horizon on each side, so that filtering at its rim reads no neighbour's.
enum { SHADOW_RIM = 2 };

// The nearest that casts a shadow, as a share of the scene's radius.  Reversed
// float depth does not mind how near that is; the other kind loses all its
// digits to it.
#define SHADOW_NEAR 1e-5f
#define SHADOW_NEAR_PLAIN 1e-3f

// The axes of the faces of a cube, in the order of shadow.glsl: where it looks,
// right and up.
static const vec3 FACE_AXES[6][3] = {
    {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
    {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}}, {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
    {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}},
};

// Row i of m is (v, w).
static void set_row(raster_matrix *m, int i, vec3 v, float w) {
  m->m[i] = v.x;
  m->m[4 + i] = v.y;
  m->m[8 + i] = v.z;
  m->m[12 + i] = w;
}

// Row i: dot(v, p - from).
static void set_row_from(raster_matrix *m, int i, vec3 v, vec3 from) {
  set_row(m, i, v, -vec3_dot(v, from));
}

// Depth is near / distance, or 1 - 2 near / distance: there is no far plane.
static raster_matrix face_view(const vec3 axes[3], vec3 from, int size,
                               raster_space space) {
  raster_matrix m;
  float zoom = (float)(size - 2 * SHADOW_RIM) / (float)size;
  set_row_from(&m, 0, vec3_scale(axes[1], zoom), from);
  set_row_from(&m, 1, vec3_scale(axes[2], zoom), from);
  set_row_from(&m, 3, axes[0], from);
  float near =
      space.radius * (space.reversed ? SHADOW_NEAR : SHADOW_NEAR_PLAIN);
  if (space.reversed)
    set_row(&m, 2, vec3_all(0), near);
  else
    set_row(&m, 2, axes[0], -vec3_dot(axes[0], from) - 2 * near);
  return m;
}

// A box around the scene's sphere that looks along the light.
static raster_matrix parallel_view(vec3 to_light, raster_space space) {
  raster_matrix m;
  vec3 aside = fabsf(to_light.y) < 0.9f ? (vec3){0, 1, 0} : (vec3){1, 0, 0};
  vec3 right = vec3_unit(vec3_cross(aside, to_light));
  vec3 up = vec3_cross(to_light, right);
  float s = 1 / space.radius;
  set_row(&m, 0, vec3_scale(right, s), 0);
  set_row(&m, 1, vec3_scale(up, s), 0);
  if (space.reversed)
    set_row(&m, 2, vec3_scale(to_light, 0.5f * s), 0.5f);
  else
    set_row(&m, 2, vec3_scale(to_light, -s), 0);
  set_row(&m, 3, vec3_all(0), 1);
  return m;
}

size_t raster_shadow_layers(const scene *s) {
  size_t n = 0;
  for (size_t i = 0; i < s->light_count; i++)
    n += s->lights[i].kind == LIGHT_POINT ? 6 : 1;
  return n;
}

static void make_views(raster_shadow *out, const scene *s, raster_space space) {
  float wide = (float)(out->size - 2 * SHADOW_RIM);
  size_t layer = 0;
  for (size_t i = 0; i < s->light_count; i++) {
    const light *l = &s->lights[i];
    out->by_light[i].first = (float)layer;
    if (l->kind == LIGHT_DIR) {
      vec3 to_light = vec3_unit(vec3_neg(l->at));
      out->by_light[i].texel = 2 * space.radius / (float)out->size;
      out->clip[layer++] = parallel_view(to_light, space);
      continue;
    }
    out->by_light[i].texel = 2 / wide;
    vec3 from = vec3_sub(l->at, space.origin);
    for (int k = 0; k < 6; k++)
      out->clip[layer++] = face_view(FACE_AXES[k], from, out->size, space);
  }
}

// The texture compares: a look-up gives the share of the four nearest texels
// that are not nearer to the light.
static void make_shadow_texture(const gl_api *f, raster_shadow *s,
                                bool reversed) {
  const GLenum target = GL_TEXTURE_2D_ARRAY;
  f->GenTextures(1, &s->texture);
  f->BindTexture(target, s->texture);
  f->TexImage3D(target, 0, GL_DEPTH_COMPONENT32F, s->size, s->size,
                (GLsizei)s->layers, 0, GL_DEPTH_COMPONENT, GL_FLOAT, NULL);
  f->TexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  f->TexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  f->TexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  f->TexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  f->TexParameteri(target, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  f->TexParameteri(target, GL_TEXTURE_COMPARE_FUNC,
                   reversed ? GL_GEQUAL : GL_LEQUAL);
}

bool raster_shadow_new(raster_shadow *out, const gl *g, const scene *s,
                       raster_space space, int size, arena *mem, error *err) {
  const gl_api *f = gl_functions(g);
  raster_shadow r = {.layers = raster_shadow_layers(s),
                     .lights = s->light_count};
  r.size = size > 0                 ? size
           : r.layers > MANY_LAYERS ? SHADOW_SIZE_MANY
                                    : SHADOW_SIZE;
  r.clip = ARENA_NEW(mem, raster_matrix, r.layers);
  r.by_light = ARENA_NEW(mem, raster_shadow_light, r.lights);
  make_views(&r, s, space);
  make_shadow_texture(f, &r, space.reversed);
  f->GenFramebuffers(1, &r.framebuffer);
  f->BindFramebuffer(GL_FRAMEBUFFER, r.framebuffer);
  f->FramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, r.texture, 0,
                             0);
  f->DrawBuffer(GL_NONE);
  f->ReadBuffer(GL_NONE);
  GLenum status = f->CheckFramebufferStatus(GL_FRAMEBUFFER);
  *out = r;
  if (status == GL_FRAMEBUFFER_COMPLETE) return true;
  raster_shadow_free(g, out);
  return fail(err, "OpenGL: no shadow maps of %d texels for %zu lights", r.size,
              r.lights);
}

void raster_shadow_free(const gl *g, raster_shadow *s) {
  const gl_api *f = gl_functions(g);
  f->DeleteFramebuffers(1, &s->framebuffer);
  f->DeleteTextures(1, &s->texture);
  *s = (raster_shadow){0};
}

void raster_shadow_begin(const gl *g, const raster_shadow *s, size_t layer,
                         bool reversed) {
  const gl_api *f = gl_functions(g);
  f->BindFramebuffer(GL_FRAMEBUFFER, s->framebuffer);
  f->FramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, s->texture, 0,
                             (GLint)layer);
  f->Viewport(0, 0, s->size, s->size);
  f->ClearDepth(reversed ? 0 : 1);
  f->Clear(GL_DEPTH_BUFFER_BIT);
}

// gl_make.c

#include "gl_make.h"

GLuint gl_texture_new(const gl *g, const gl_texture_spec *s) {
  const gl_api *f = gl_functions(g);
  GLuint name;
  f->GenTextures(1, &name);
  f->BindTexture(GL_TEXTURE_2D, name);
  f->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  f->TexImage2D(GL_TEXTURE_2D, 0, (GLint)s->internal, s->width, s->height, 0,
                s->format, s->type, s->pixels);
  f->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, (GLint)s->wrap_s);
  f->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, (GLint)s->wrap_t);
  f->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  f->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
                   s->mipmaps ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
  if (s->mipmaps) f->GenerateMipmap(GL_TEXTURE_2D);
  return name;
}

// A renderbuffer attached to the framebuffer in force.
static GLuint attach_buffer(const gl_api *f, const gl_target *t, GLenum format,
                            GLenum attachment) {
  GLuint name;
  f->GenRenderbuffers(1, &name);
  f->BindRenderbuffer(GL_RENDERBUFFER, name);
  f->RenderbufferStorageMultisample(GL_RENDERBUFFER,
                                    t->samples > 1 ? t->samples : 0, format,
                                    t->width, t->height);
  f->FramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, name);
  return name;
}

static bool complete(const gl_api *f, const gl_target *t, error *err) {
  GLenum status = f->CheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE) return true;
  return fail(err,
              "OpenGL: no framebuffer of %dx%d with %d samples (status %#x)",
              t->width, t->height, t->samples, status);
}

// The framebuffer whose colour is a texture, for reading and for later passes.
static bool make_resolved(const gl *g, gl_target *t, error *err) {
  const gl_api *f = gl_functions(g);
  t->resolved =
      gl_texture_new(g, &(gl_texture_spec){.width = t->width,
                                           .height = t->height,
                                           .internal = GL_RGBA32F,
                                           .format = GL_RGBA,
                                           .type = GL_FLOAT,
                                           .wrap_s = GL_CLAMP_TO_EDGE,
                                           .wrap_t = GL_CLAMP_TO_EDGE});
  f->GenFramebuffers(1, &t->read);
  f->BindFramebuffer(GL_FRAMEBUFFER, t->read);
  f->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                          t->resolved, 0);
  if (t->samples <= 1) {
    t->draw = t->read;
    t->depth = attach_buffer(f, t, GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
  }
  return complete(f, t, err);
}

bool gl_target_new(gl_target *out, const gl *g, int width, int height,
                   int samples, error *err) {
  const gl_api *f = gl_functions(g);
  GLint most = 1;
  f->GetIntegerv(GL_MAX_SAMPLES, &most);
  gl_target t = {.width = width, .height = height};
  t.samples = samples < 1 ? 1 : samples > most ? most : samples;
  bool ok = make_resolved(g, &t, err);
  if (ok && t.samples > 1) {
    f->GenFramebuffers(1, &t.draw);
    f->BindFramebuffer(GL_FRAMEBUFFER, t.draw);
    t.color = attach_buffer(f, &t, GL_RGBA32F, GL_COLOR_ATTACHMENT0);
    t.depth = attach_buffer(f, &t, GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
    ok = complete(f, &t, err);
  }
  if (ok)
    *out = t;
  else
    gl_target_free(g, &t);
  return ok;
}

void gl_target_resolve(const gl *g, const gl_target *t) {
  const gl_api *f = gl_functions(g);
  if (t->draw == t->read) return;
  f->BindFramebuffer(GL_READ_FRAMEBUFFER, t->draw);
  f->BindFramebuffer(GL_DRAW_FRAMEBUFFER, t->read);
  f->BlitFramebuffer(0, 0, t->width, t->height, 0, 0, t->width, t->height,
                     GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

// Names that are 0 are passed over by OpenGL.
void gl_target_free(const gl *g, gl_target *t) {
  const gl_api *f = gl_functions(g);
  if (t->draw != t->read) f->DeleteFramebuffers(1, &t->draw);
  f->DeleteFramebuffers(1, &t->read);
  f->DeleteRenderbuffers(1, &t->color);
  f->DeleteRenderbuffers(1, &t->depth);
  f->DeleteTextures(1, &t->resolved);
  *t = (gl_target){0};
}

// OpenGL's first row is the lowest.
image gl_target_image(const gl *g, const gl_target *t, float *alpha,
                      arena *mem) {
  const gl_api *f = gl_functions(g);
  image out = image_new(mem, t->width, t->height);
  size_t wide = (size_t)t->width, high = (size_t)t->height;
  arena scratch = {0};
  float *rgba = ARENA_NEW(&scratch, float, 4 * wide * high);
  f->BindFramebuffer(GL_READ_FRAMEBUFFER, t->read);
  f->PixelStorei(GL_PACK_ALIGNMENT, 4);
  f->ReadPixels(0, 0, t->width, t->height, GL_RGBA, GL_FLOAT, rgba);
  for (size_t i = 0; i < wide * high; i++) {
    const float *from = rgba + 4 * ((high - 1 - i / wide) * wide + i % wide);
    out.pixels[i] = (vec3){from[0], from[1], from[2]};
    if (alpha != NULL) alpha[i] = from[3];
  }
  arena_free(&scratch);
  return out;
}

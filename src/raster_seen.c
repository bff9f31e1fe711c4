// raster_seen.c

#include "raster_seen.h"

#include "raster_program.h"

// Texels of a triangle: three vertices of four.
enum { TRIANGLE_TEXELS = 12 };

bool raster_seen_fits(const gl *g, size_t triangles) {
  GLint most = 0;
  gl_functions(g)->GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  return triangles <= (size_t)most / TRIANGLE_TEXELS;
}

// A buffer as a list of RGBA texels.
static GLuint texture_over(const gl_api *f, GLuint buffer) {
  GLuint name;
  f->GenTextures(1, &name);
  f->BindTexture(GL_TEXTURE_BUFFER, name);
  f->TexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, buffer);
  return name;
}

// The numbers, read as they are or not at all.
static void make_numbers(const gl_api *f, raster_seen *s,
                         const gl_target *like) {
  f->GenTextures(1, &s->numbers);
  f->BindTexture(s->target, s->numbers);
  if (s->samples > 1) {
    f->TexImage2DMultisample(s->target, s->samples, GL_R32UI, like->width,
                             like->height, GL_TRUE);
    return;
  }
  f->TexImage2D(s->target, 0, GL_R32UI, like->width, like->height, 0,
                GL_RED_INTEGER, GL_UNSIGNED_INT, NULL);
  f->TexParameteri(s->target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  f->TexParameteri(s->target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

bool raster_seen_new(raster_seen *out, const gl *g, const raster_mesh *m,
                     const gl_target *like, error *err) {
  const gl_api *f = gl_functions(g);
  raster_seen s = {.samples = out->samples};
  s.target = s.samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
  make_numbers(f, &s, like);
  f->GenRenderbuffers(1, &s.depth);
  f->BindRenderbuffer(GL_RENDERBUFFER, s.depth);
  f->RenderbufferStorageMultisample(
      GL_RENDERBUFFER, s.samples > 1 ? s.samples : 0, GL_DEPTH_COMPONENT32F,
      like->width, like->height);
  f->GenFramebuffers(1, &s.framebuffer);
  f->BindFramebuffer(GL_FRAMEBUFFER, s.framebuffer);
  f->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, s.target,
                          s.numbers, 0);
  f->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT,
                             GL_RENDERBUFFER, s.depth);
  s.vertices = texture_over(f, m->buffer);
  f->GenBuffers(1, &s.table);
  f->BindBuffer(GL_TEXTURE_BUFFER, s.table);
  s.materials = texture_over(f, s.table);
  *out = s;
  GLenum status = f->CheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE) return true;
  return fail(err, "OpenGL: no framebuffer of %dx%d numbers (status %#x)",
              like->width, like->height, status);
}

// Names that are 0 are passed over by OpenGL.
void raster_seen_free(const gl *g, raster_seen *s) {
  const gl_api *f = gl_functions(g);
  const GLuint textures[] = {s->numbers, s->vertices, s->materials};
  f->DeleteFramebuffers(1, &s->framebuffer);
  f->DeleteRenderbuffers(1, &s->depth);
  f->DeleteTextures(3, textures);
  f->DeleteBuffers(1, &s->table);
  *s = (raster_seen){.samples = s->samples};
}

void raster_seen_fill(const gl *g, const raster_seen *s, const float *texels,
                      size_t materials) {
  const gl_api *f = gl_functions(g);
  size_t bytes = materials * RASTER_MATERIAL_TEXELS * 4 * sizeof *texels;
  f->BindBuffer(GL_TEXTURE_BUFFER, s->table);
  f->BufferData(GL_TEXTURE_BUFFER, (GLsizeiptr)bytes, texels, GL_STREAM_DRAW);
}

void raster_seen_bind(const gl *g, const raster_seen *s, GLuint program,
                      int first_unit) {
  const gl_api *f = gl_functions(g);
  const GLenum targets[] = {s->target, GL_TEXTURE_BUFFER, GL_TEXTURE_BUFFER};
  const GLuint names[] = {s->numbers, s->vertices, s->materials};
  const char *const uniforms[] = {"u_seen", "u_vertices", "u_materials"};
  for (int i = 0; i < 3; i++) {
    f->ActiveTexture(GL_TEXTURE0 + (GLenum)(first_unit + i));
    f->BindTexture(targets[i], names[i]);
    raster_set_unit(g, program, uniforms[i], first_unit + i);
  }
}

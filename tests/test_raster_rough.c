// test_raster_rough.c — metallic-roughness in GLSL against its twin in C.

#include "gl_worlds.h"

#include "gl_make.h"
#include "glsl.h"
#include "num.h"
#include "raster_rough.h"

#include <string.h>

// A million pairs of directions are too many for a test: 64 x 64 of them, of
// all roughnesses, on the sphere's upper half.
enum { SIDE = 64 };

typedef struct texel {
  float x, y, z, w;
} texel;

// wo and roughness, wi and F0, for each pixel.
static void fill_inputs(texel *wo, texel *wi) {
  for (uint64_t i = 0; i < SIDE * SIDE; i++) {
    rng r = rng_of(9, i, 0);
    texel *to[2] = {wo, wi};
    for (int k = 0; k < 2; k++) {
      float z = fmaxf(rng_next(&r), 1e-3f), s = sqrtf(1 - z * z);
      vec2 c = num_circle(rng_next(&r));
      to[k][i] = (texel){s * c.x, s * c.y, z, rng_next(&r)};
    }
    wo[i].w = 0.02f + 0.98f * wo[i].w * wo[i].w;
    if (i % 2 == 0) continue;  // near the mirror direction
    float a = wo[i].w * wo[i].w * rng_next(&r), b = 1 - 0.5f * a;
    vec3 near = {a - b * wo[i].x, -b * wo[i].y, b * wo[i].z};
    near = vec3_unit(near);
    wi[i].x = near.x, wi[i].y = near.y, wi[i].z = near.z;
  }
}

static const char VERTEX[] =
    "#version 330 core\n"
    "void main() {\n"
    "  vec2 p = vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0;\n"
    "  gl_Position = vec4(p, 0.0, 1.0);\n"
    "}\n";

static const char FRAGMENT[] =
    "uniform sampler2D u_wo, u_wi;\n"
    "out vec4 o;\n"
    "void main() {\n"
    "  vec4 wo = texelFetch(u_wo, ivec2(gl_FragCoord.xy), 0);\n"
    "  vec4 wi = texelFetch(u_wi, ivec2(gl_FragCoord.xy), 0);\n"
    "  vec3 n = vec3(0.0, 0.0, 1.0);\n"
    "  half_angles a = half_angles_of(n, wo.xyz, wi.xyz);\n"
    "  float alpha = wo.w * wo.w;\n"
    "  rough_terms s = rough_terms(PBR_REPORT, vec3(wi.w), vec3(0.7), alpha,\n"
    "                              schlick_k_point(wo.w), 0.2);\n"
    "  vec3 d = rough_diffuse(s, a, 0.1, 0.3), f = rough_specular(s, a);\n"
    "  s.model = PBR_GGX;\n"
    "  o = vec4(f.x, d.x, rough_specular(s, a).x,\n"
    "           rough_diffuse(s, a, 0.1, 0.3).x);\n"
    "}\n";

// The four numbers of the shader above.
static texel in_c(texel wo, texel wi) {
  vec3 o = {wo.x, wo.y, wo.z}, i = {wi.x, wi.y, wi.z};
  half_angles a = half_angles_of((vec3){0, 0, 1}, o, i);
  rough_terms s = {PBR_REPORT,  vec3_all(wi.w),        vec3_all(0.7f),
                   wo.w * wo.w, schlick_k_point(wo.w), 0.2f};
  texel t = {rough_specular(&s, a).x, rough_diffuse(&s, a, 0.1f, 0.3f).x, 0, 0};
  s.model = PBR_GGX;
  t.z = rough_specular(&s, a).x;
  t.w = rough_diffuse(&s, a, 0.1f, 0.3f).x;
  return t;
}

static GLuint twin_program(const gl_api *f) {
  const char *vertex[] = {VERTEX};
  const char *fragment[] = {"#version 330 core\n", glsl_text("num.glsl"),
                            glsl_text("microfacet.glsl"), FRAGMENT};
  GLuint p = f->CreateProgram();
  f->AttachShader(p, compiled(f, GL_VERTEX_SHADER, 1, vertex));
  f->AttachShader(p, compiled(f, GL_FRAGMENT_SHADER, 4, fragment));
  f->LinkProgram(p);
  return p;
}

static GLuint input_texture(const gl *g, int unit, const texel *pixels) {
  gl_texture_spec spec = {SIDE,     SIDE,   GL_RGBA32F,       GL_RGBA,
                          GL_FLOAT, pixels, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE,
                          false};
  gl_functions(g)->ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
  return gl_texture_new(g, &spec);
}

// Draw the shader and read its floats, row 0 at the bottom as it wrote them.
static void draw_twin(gl *g, const texel *wo, const texel *wi, texel *out) {
  const gl_api *f = gl_functions(g);
  gl_target t;
  error err;
  assert_true(gl_target_new(&t, g, SIDE, SIDE, 1, &err));
  GLuint p = twin_program(f), array;
  const texel *inputs[2] = {wo, wi};
  const char *names[2] = {"u_wo", "u_wi"};
  f->BindFramebuffer(GL_FRAMEBUFFER, t.draw);
  f->Viewport(0, 0, SIDE, SIDE);
  f->UseProgram(p);
  for (int i = 0; i < 2; i++) {
    f->BindTexture(GL_TEXTURE_2D, input_texture(g, i, inputs[i]));
    f->Uniform1i(f->GetUniformLocation(p, names[i]), i);
  }
  f->GenVertexArrays(1, &array);
  f->BindVertexArray(array);
  f->Disable(GL_DEPTH_TEST);
  f->DrawArrays(GL_TRIANGLES, 0, 3);
  f->ReadPixels(0, 0, SIDE, SIDE, GL_RGBA, GL_FLOAT, out);
  gl_target_free(g, &t);
}

// Every term in GLSL is the one in C to a relative 1e-5.
static void terms_are_twins(void **state) {
  (void)state;
  arena mem = {0};
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  texel *wo = ARENA_NEW(&mem, texel, SIDE * SIDE);
  texel *wi = ARENA_NEW(&mem, texel, SIDE * SIDE);
  texel *got = ARENA_NEW(&mem, texel, SIDE * SIDE);
  fill_inputs(wo, wi);
  draw_twin(g, wo, wi, got);
  double worst = 0;
  for (int i = 0; i < SIDE * SIDE; i++) {
    texel want = in_c(wo[i], wi[i]);
    const float *a = &got[i].x, *b = &want.x;
    for (int k = 0; k < 4; k++)
      worst = fmax(worst, fabs((double)a[k] / (double)b[k] - 1));
  }
  print_message("# worst relative difference %.1e\n", worst);
  assert_true(worst < 1e-5);
  gl_close(g);
  arena_free(&mem);
}

enum { WIDTH = 160, HEIGHT = 120 };

// Smooth balls of every roughness and two metals over a rough floor.
static world *rough_stage(void) {
  world *w = world_new();
  for (int i = 0; i < 6; i++) {
    material *m = &w->materials[i];
    *m = world_material(MATERIAL_METAL_ROUGH, (vec3){0.8f, 0.55f, 0.3f},
                        vec3_all(0));
    m->roughness = 0.1f + 0.18f * (float)i;
    m->metallic = i % 3 == 0 ? 0 : i % 3 == 1 ? 1 : 0.3f;
  }
  world_quad(w, (vec3){-6, 0, 4}, (vec3){12, 0, 0}, (vec3){0, 0, -10}, 5);
  for (int i = 0; i < 5; i++)
    world_ball(w, (vec3){2 * (float)i - 4, 1, 0}, 0.95f, 3, true, (uint32_t)i);
  w->lights[0] = (light){LIGHT_POINT, {3, 5, 4}, {30, 28, 20}};
  w->lights[1] = (light){LIGHT_POINT, {-4, 2, 2}, {4, 8, 12}};
  w->lights[2] = (light){LIGHT_DIR, {0.6f, -0.64f, -0.48f}, {0.7f, 0.7f, 0.9f}};
  world_ready(w, 3);
  return w;
}

// Without shadows the direct light of metallic-roughness is the same picture
// from both engines, by both sets of formulas: every pixel off the edges within
// 1/255.
static void direct_light_is_the_same(void **state) {
  (void)state;
  arena mem = {0};
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  world *w = rough_stage();
  camera_view v =
      world_view((vec3){0.5f, 2.5f, 9}, (vec3){0, 1, 0}, 40, WIDTH, HEIGHT);
  for (int model = PBR_GGX; model <= PBR_REPORT; model++) {
    dfg table;
    dfg_build(&table, (pbr_model)model, &mem, NULL);
    raster_rough rough = raster_rough_new(g, &table, &mem);
    raster_settings set = {.width = WIDTH,
                           .height = HEIGHT,
                           .msaa = 1,
                           .lights = true,
                           .model = (raster_model)model,
                           .metal_rough = raster_rough_piece(&rough)};
    image im = drawn(w, g, &v, &set, &mem);
    w->path.dfg = &table;
    float worst = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
      int x = i % WIDTH, y = i / WIDTH;
      if (on_edge(w, &v, x, y)) continue;
      worst = fmaxf(worst, far_apart(im.pixels[i], traced(w, &v, x, y, false)));
    }
    print_message("# worst %.5f of 255\n", 255 * (double)worst);
    assert_true(worst <= 1.0f / 255);
    raster_rough_free(g, &rough);
  }
  world_free(w);
  gl_close(g);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(terms_are_twins),
      cmocka_unit_test(direct_light_is_the_same),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

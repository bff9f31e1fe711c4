// test_raster_env.c — light from environments in GLSL against its twin in C,
// and pictures whose light is known.

#include "gl_worlds.h"

#include "gl_make.h"
#include "glsl.h"
#include "num.h"
#include "raster_env.h"
#include "raster_rough.h"

#include <string.h>

enum { SIDE = 48 };

// Read the levels in the direction of each pixel of a texture, whose fourth
// number is the roughness, below 0 for irradiance.
static const char READ_LEVELS[] =
    "uniform sampler2D u_question;\n"
    "out vec4 o;\n"
    "void main() {\n"
    "  vec4 q = texelFetch(u_question, ivec2(gl_FragCoord.xy), 0);\n"
    "  o = vec4(q.w < 0.0 ? ambient_irradiance(q.xyz)\n"
    "                     : ambient_radiance(q.xyz, q.w), 1.0);\n"
    "}\n";

static const char WHOLE_SCREEN[] =
    "#version 330 core\n"
    "void main() {\n"
    "  vec2 p = vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0;\n"
    "  gl_Position = vec4(p, 0.0, 1.0);\n"
    "}\n";

static GLuint level_program(const gl_api *f, const char *defines) {
  const char *vertex[] = {WHOLE_SCREEN};
  const char *fragment[] = {"#version 330 core\n#define ENV_KIND 2\n",
                            defines,
                            glsl_text("num.glsl"),
                            glsl_text("env.glsl"),
                            glsl_text("ibl.glsl"),
                            READ_LEVELS};
  GLuint p = f->CreateProgram();
  f->AttachShader(p, compiled(f, GL_VERTEX_SHADER, 1, vertex));
  f->AttachShader(p, compiled(f, GL_FRAGMENT_SHADER, 6, fragment));
  f->LinkProgram(p);
  return p;
}

// A question: a direction and a roughness.
typedef struct query {
  float x, y, z, roughness;
} query;

// The answers of the shader, four floats each.
static void ask_shader(gl *g, const env *e, const raster_env *r,
                       const query *asked, query *out) {
  const gl_api *f = gl_functions(g);
  gl_target t;
  error err;
  assert_true(gl_target_new(&t, g, SIDE, SIDE, 1, &err));
  gl_texture_spec spec = {SIDE,     SIDE,  GL_RGBA32F,       GL_RGBA,
                          GL_FLOAT, asked, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE,
                          false};
  GLuint p = level_program(f, r->defines), array;
  f->ActiveTexture(GL_TEXTURE0);
  f->BindTexture(GL_TEXTURE_2D, gl_texture_new(g, &spec));
  f->BindFramebuffer(GL_FRAMEBUFFER, t.draw);
  f->Viewport(0, 0, SIDE, SIDE);
  f->UseProgram(p);
  f->Uniform1i(f->GetUniformLocation(p, "u_question"), 0);
  f->Uniform1f(f->GetUniformLocation(p, "u_env_rotate"), e->rotate);
  f->Uniform3f(f->GetUniformLocation(p, "u_env_scale"), e->scale, e->scale,
               e->scale);
  raster_piece piece = raster_env_piece(r);
  piece.bind(piece.context, g, p, 1);
  f->GenVertexArrays(1, &array);
  f->BindVertexArray(array);
  f->Disable(GL_DEPTH_TEST);
  f->DrawArrays(GL_TRIANGLES, 0, 3);
  f->ReadPixels(0, 0, SIDE, SIDE, GL_RGBA, GL_FLOAT, out);
  gl_target_free(g, &t);
}

static void fill_queries(query *q) {
  for (uint64_t i = 0; i < SIDE * SIDE; i++) {
    rng r = rng_of(3, i, 0);
    vec2 around = num_circle(rng_next(&r));
    float y = 2 * rng_next(&r) - 1, s = sqrtf(1 - y * y);
    q[i] =
        (query){s * around.x, y, s * around.y, i % 3 == 0 ? -1 : rng_next(&r)};
  }
  q[0] = (query){0, 1, 0, 0.3f}, q[1] = (query){0, -1, 0, 0.3f};
  q[2] = (query){0, 0, 1, -1}, q[3] = (query){0, 0, -1, 0};
}

// Irradiance and radiance of any roughness, also between the levels, below
// the first, at the poles and across the seam, are the same in GLSL and in C,
// to 1e-4 of a value.
static void lookups_are_twins(void **state) {
  (void)state;
  arena mem = {0};
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  env e = {.kind = ENV_SKY, .rotate = 0.3f, .scale = 2};
  ibl b;
  ibl_need need = {.diffuse = true, .all = true};
  ibl_make(&b, &e, &need, &mem, NULL);
  raster_env r = raster_env_new(g, &b, &mem);
  query *asked = ARENA_NEW(&mem, query, SIDE * SIDE);
  query *got = ARENA_NEW(&mem, query, SIDE * SIDE);
  fill_queries(asked);
  ask_shader(g, &e, &r, asked, got);
  double worst = 0;
  for (int i = 0; i < SIDE * SIDE; i++) {
    vec3 d = {asked[i].x, asked[i].y, asked[i].z};
    vec3 want = asked[i].roughness < 0
                    ? ibl_irradiance(&b, d)
                    : ibl_radiance(&b, d, asked[i].roughness);
    vec3 v = {got[i].x, got[i].y, got[i].z};
    float far = vec3_peak(vec3_abs(vec3_sub(v, want))) / vec3_peak(want);
    worst = fmax(worst, (double)far);
  }
  print_message("# worst relative difference %.1e\n", worst);
  assert_true(worst < 1e-4);
  raster_env_free(g, &r);
  gl_close(g);
  arena_free(&mem);
}

// A map of 1 all around; metal shows F0 C1 + C2 to 2e-3.
static void white_light_shows_the_table(void **state) {
  (void)state;
  arena mem = {0};
  gl *g = gl_or_skip(GL_BACKEND_AUTO, &mem);
  world *w = world_new();
  w->materials[0] = world_material(MATERIAL_METAL_ROUGH,
                                   (vec3){0.8f, 0.6f, 0.3f}, vec3_all(0));
  w->materials[0].metallic = 1, w->materials[0].roughness = 0.4f;
  world_quad(w, (vec3){-9, 0, 9}, (vec3){18, 0, 0}, (vec3){0, 0, -18}, 0);
  world_ready(w, 0);
  w->scene.env =
      (env){.kind = ENV_MAP, .map = image_new(&mem, 512, 256), .scale = 1};
  for (int i = 0; i < 512 * 256; i++)
    w->scene.env.map.pixels[i] = vec3_all(1);
  dfg table;
  dfg_build(&table, PBR_GGX, &mem, NULL);
  raster_rough rough = raster_rough_new(g, &table, &mem);
  ibl_need need = raster_env_need(&w->scene, PBR_GGX, false, NULL, &mem);
  need.use_cache = false;
  ibl b;
  ibl_make(&b, &w->scene.env, &need, &mem, NULL);
  raster_env r = raster_env_new(g, &b, &mem);
  raster_settings set = {.width = 32,
                         .height = 32,
                         .msaa = 1,
                         .ambient = raster_env_piece(&r),
                         .metal_rough = raster_rough_piece(&rough)};
  camera_view v = world_view((vec3){0, 3, 3}, (vec3){0, 0, 0}, 20, 32, 32);
  image im = drawn(w, g, &v, &set, &mem);
  for (int y = 0; y < 32; y++)
    for (int x = 0; x < 32; x++) {
      ray to = camera_ray(&v, (float)x + 0.5f, (float)y + 0.5f);
      dfg_pair p = dfg_integral(PBR_GGX, -vec3_unit(to.d).y, 0.4f);
      vec3 got = im.pixels[32 * y + x];
      assert_true(fabsf(got.x - (0.8f * p.c1 + p.c2)) < 2e-3f);
      assert_true(fabsf(got.z - (0.3f * p.c1 + p.c2)) < 2e-3f);
    }
  raster_env_free(g, &r);
  raster_rough_free(g, &rough);
  world_free(w);
  gl_close(g);
  arena_free(&mem);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lookups_are_twins),
      cmocka_unit_test(white_light_shows_the_table),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

// raster_pass.c

#include "raster_pass.h"

#include "num.h"

// Rows of directions over a half turn in the sum for the irradiance.
enum { IRRADIANCE_ROWS = 64 };

vec3 raster_irradiance(const env *e, vec3 n) {
  const int rows = IRRADIANCE_ROWS;
  double sum[3] = {0, 0, 0};
  for (int i = 0; i < 2 * rows * rows; i++) {
    float v = ((float)(i / (2 * rows)) + 0.5f) / (float)rows;
    float u = ((float)(i % (2 * rows)) + 0.5f) / (float)(2 * rows);
    vec3 d = env_direction((vec2){u, v}), l = env_radiance(e, d);
    double sine = (double)num_circle(0.5f * v).y;
    double cosine = (double)vec3_dot(n, d);
    if (!(cosine > 0)) continue;
    sum[0] += sine * cosine * (double)l.x;
    sum[1] += sine * cosine * (double)l.y;
    sum[2] += sine * cosine * (double)l.z;
  }
  // A cell is pi / rows on either side.
  double cell = (double)PI / rows * ((double)PI / rows);
  return (vec3){(float)(sum[0] * cell), (float)(sum[1] * cell),
                (float)(sum[2] * cell)};
}

// The scale of what first.frag writes, and what is added.
static vec2 first_scale(const raster_stock *r, raster_shading shading,
                        bool as_mean) {
  if (as_mean || shading == RASTER_ALBEDO) return (vec2){1, 0};
  if (shading == RASTER_NORMAL) return (vec2){0.5f, 0.5f};
  return (vec2){1 / r->view.farthest, 0};
}

// Make the program of material `which` current, with all its uniforms.
static bool use_material(raster_stock *r, size_t which, raster_shading shading,
                         bool as_mean, error *err) {
  GLuint program;
  const material *m = &r->materials[which];
  raster_variant v = raster_variant_of(&r->set, m, shading);
  if (!raster_program_get(&program, &r->programs, v, err)) return false;
  gl_functions(r->g)->UseProgram(program);
  raster_set_view(r, program);
  raster_set_material(r, program, which);
  if (shading != RASTER_RADIANCE) {
    raster_set2(r->g, program, "u_first", first_scale(r, shading, as_mean));
    return true;
  }
  raster_set_light(r, program, v.kind);
  return true;
}

// Whether light goes straight through a material in this kind of picture.
static bool is_sheet(const raster_stock *r, size_t which,
                     raster_shading shading) {
  return shading == RASTER_RADIANCE && r->materials[which].passes;
}

const raster_frustum *raster_pass_view(const raster_stock *r) {
  return r->set.spared.outside ? &r->frustum : NULL;
}

bool raster_pass_leaves(const raster_stock *r, size_t which) {
  const bool *unseen = r->set.spared.unseen;
  return r->mesh.parts[which].count == 0 || r->hidden[which] ||
         (unseen != NULL && unseen[which]);
}

static bool draw_solids(raster_stock *r, raster_shading shading, bool as_mean,
                        error *err) {
  gl_functions(r->g)->BindVertexArray(r->mesh.vertices);
  for (size_t i = 0; i < r->mesh.part_count; i++) {
    if (raster_pass_leaves(r, i) || is_sheet(r, i, shading)) continue;
    if (!use_material(r, i, shading, as_mean, err)) return false;
    r->counts.drawn += raster_draw_part(r, i, raster_pass_view(r), -1);
  }
  return true;
}

// From far to near, each over what is there already; runs of one material in
// one call.  They leave no depth.
static bool draw_sheets(raster_stock *r, error *err) {
  const gl_api *f = gl_functions(r->g);
  const raster_mesh *m = &r->mesh;
  if (m->sheet_count == 0) return true;
  raster_mesh_sort(&r->mesh, r->g, r->view.eye, r->view.forward);
  f->Enable(GL_BLEND);
  f->BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  f->DepthMask(GL_FALSE);
  bool ok = true;
  for (size_t i = 0, end; i < m->sheet_count && ok; i = end) {
    uint32_t of = m->sheets[i].material;
    for (end = i; end < m->sheet_count && m->sheets[end].material == of;)
      end++;
    if (raster_pass_leaves(r, of)) continue;
    ok = use_material(r, of, RASTER_RADIANCE, false, err);
    r->counts.drawn += end - i;
    if (ok)
      f->DrawElements(GL_TRIANGLES, (GLsizei)(3 * (end - i)), GL_UNSIGNED_INT,
                      (const void *)(uintptr_t)(3 * i * sizeof(uint32_t)));
  }
  f->Disable(GL_BLEND);
  f->DepthMask(GL_TRUE);
  return ok;
}

static bool draw_sky(raster_stock *r, error *err) {
  const gl_api *f = gl_functions(r->g);
  GLuint program;
  raster_variant v = {.stage = RASTER_STAGE_SKY};
  if (!raster_program_get(&program, &r->programs, v, err)) return false;
  f->UseProgram(program);
  raster_set_view(r, program);
  raster_set_env(r, program);
  f->BindVertexArray(r->no_vertices);
  f->DrawArrays(GL_TRIANGLES, 0, 3);
  r->counts.skies++;
  return true;
}

// Whether some sample of the framebuffer in force lies open to the sky: a
// triangle behind all surfaces that leaves nothing behind is counted.
static bool find_open(raster_stock *r, bool *open, error *err) {
  const gl_api *f = gl_functions(r->g);
  GLuint program, query, passed;
  raster_variant v = {.stage = RASTER_STAGE_VEIL};
  if (!raster_program_get(&program, &r->programs, v, err)) return false;
  f->UseProgram(program);
  raster_set_view(r, program);
  f->BindVertexArray(r->no_vertices);
  f->ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  f->DepthMask(GL_FALSE);
  f->GenQueries(1, &query);
  f->BeginQuery(GL_ANY_SAMPLES_PASSED, query);
  f->DrawArrays(GL_TRIANGLES, 0, 3);
  f->EndQuery(GL_ANY_SAMPLES_PASSED);
  f->GetQueryObjectuiv(query, GL_QUERY_RESULT, &passed);
  f->DeleteQueries(1, &query);
  f->DepthMask(GL_TRUE);
  f->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  *open = passed != 0;
  return true;
}

bool raster_pass_sky(raster_stock *r, bool *wanted, error *err) {
  *wanted = r->set.sky && r->scene->env.kind != ENV_NONE;
  return !*wanted || !r->set.spared.covered || find_open(r, wanted, err);
}

// Solid parts into the layer whose view is in force.
static bool draw_casters(raster_stock *r, const raster_matrix *clip,
                         error *err) {
  const gl_api *f = gl_functions(r->g);
  raster_frustum sides = raster_frustum_of_matrix(clip->m, r->space.origin);
  const raster_frustum *view = r->set.spared.outside ? &sides : NULL;
  for (size_t i = 0; i < r->mesh.part_count; i++) {
    const raster_part *part = &r->mesh.parts[i];
    if (part->count == 0 || r->hidden[i]) continue;
    bool sheet = r->materials[i].passes;
    raster_variant v = {.stage = RASTER_STAGE_SHADOW};
    if (sheet) {
      v = raster_variant_of(&r->set, &r->materials[i], RASTER_RADIANCE);
      v.stage = RASTER_STAGE_SHADOW_SHEET;
    }
    GLuint program;
    if (!raster_program_get(&program, &r->programs, v, err)) return false;
    f->UseProgram(program);
    f->UniformMatrix4fv(f->GetUniformLocation(program, "u_clip"), 1, GL_FALSE,
                        clip->m);
    if (sheet) raster_set_material(r, program, i);
    r->counts.casters += raster_draw_part(r, i, view, -1);
  }
  return true;
}

void raster_pass_begin(const raster_stock *r) {
  const gl_api *f = gl_functions(r->g);
  if (r->space.reversed) f->ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  f->Enable(GL_DEPTH_TEST);
  f->DepthFunc(r->space.reversed ? GL_GEQUAL : GL_LEQUAL);
  f->DepthMask(GL_TRUE);
}

bool raster_pass_shadows(raster_stock *r, error *err) {
  const gl_api *f = gl_functions(r->g);
  raster_pass_begin(r);
  f->BindVertexArray(r->mesh.vertices);
  for (size_t layer = 0; layer < r->shadow.layers; layer++) {
    size_t before = r->counts.casters;
    raster_shadow_begin(r->g, &r->shadow, layer, r->space.reversed);
    if (!draw_casters(r, &r->shadow.clip[layer], err)) return false;
    r->counts.layers += r->counts.casters > before;
  }
  return true;
}

bool raster_pass_frame(raster_stock *r, raster_shading shading, bool as_mean,
                       error *err) {
  const gl_api *f = gl_functions(r->g);
  float empty = shading == RASTER_DEPTH && !as_mean ? 1 : 0;
  raster_pass_begin(r);
  f->BindFramebuffer(GL_FRAMEBUFFER, r->many.draw);
  f->Viewport(0, 0, r->many.width, r->many.height);
  f->ClearColor(empty, empty, empty, 0);
  f->ClearDepth(r->space.reversed ? 0 : 1);
  f->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  bool ok = draw_solids(r, shading, as_mean, err);
  if (ok && shading == RASTER_RADIANCE) {
    bool sky;
    ok = raster_pass_sky(r, &sky, err) && (!sky || draw_sky(r, err)) &&
         draw_sheets(r, err);
  }
  r->counts.resolves += r->many.draw != r->many.read;
  gl_target_resolve(r->g, &r->many);
  r->shown = &r->many;
  return ok;
}

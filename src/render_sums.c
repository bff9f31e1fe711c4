// render_sums.c

#include "render_sums.h"

render_sums render_sums_new(int width, int height, unsigned aovs, bool squares,
                            arena *mem) {
  render_sums s = {.color = film_new(mem, width, height, squares)};
  if (aovs & RENDER_AOV_NORMAL) s.normal = film_new(mem, width, height, false);
  if (aovs & RENDER_AOV_DEPTH) s.depth = film_new(mem, width, height, false);
  if (aovs & RENDER_AOV_ALBEDO) s.albedo = film_new(mem, width, height, false);
  return s;
}

void render_sums_add_first(render_sums *s, size_t i, const first_hit *f) {
  if (s->normal.sum != NULL) film_add(&s->normal, i, f->normal);
  if (s->albedo.sum != NULL) film_add(&s->albedo, i, f->albedo);
  if (s->depth.sum != NULL && f->found)
    film_add(&s->depth, i, vec3_all(f->depth));
}

// A picture of what the guide says of each pixel.
static image guided_image(const film *size, const void *self,
                          vec3 (*of)(const void *, size_t), arena *mem) {
  image out = image_new(mem, size->width, size->height);
  for (size_t i = 0; i < (size_t)size->width * (size_t)size->height; i++)
    out.pixels[i] = of(self, i);
  return out;
}

// Images in the order of the bits of aovs.
void render_sums_images(render_result *out, const render_sums *s, unsigned aovs,
                        const render_guide *guide, arena *mem) {
  const film *of[3] = {&s->normal, &s->depth, &s->albedo};
  const render_guide *g = guide;
  bool guided = g != NULL && g->mean != NULL;
  out->color = guided ? guided_image(&s->color, g->self, g->mean, mem)
                      : film_image(&s->color, mem);
  for (int i = 0; i < 3; i++)
    if (of[i]->sum != NULL) out->aov[i] = film_image(of[i], mem);
  if (aovs & RENDER_AOV_VARIANCE)
    out->aov[3] = guided ? guided_image(&s->color, g->self, g->variance, mem)
                         : film_variance_image(&s->color, mem);
  if (aovs & RENDER_AOV_SAMPLES) out->aov[4] = film_count_image(&s->color, mem);
}

void render_sums_counts(render_result *out, const render_sums *s,
                        int film_width) {
  const tally *t = &s->tally;
  out->rays = t->paths.rays;
  out->cut = t->paths.cut;
  out->paths = t->paths;
  out->squares = s->color.square != NULL;
  out->film_bytes = film_bytes(&s->color) + film_bytes(&s->normal) +
                    film_bytes(&s->depth) + film_bytes(&s->albedo);
  out->samples = t->samples;
  out->non_finite = t->non_finite;
  out->bad_x = (int)(t->bad_pixel % (uint64_t)film_width);
  out->bad_y = (int)(t->bad_pixel / (uint64_t)film_width);
  out->bad_sample = (int)t->bad_sample;
}

// plan_sight.c

#include "plan_sight.h"

// Whether all corners of a triangle are finite.
static bool is_finite(const mesh *m, size_t triangle) {
  const uint32_t *k = m->position_index + 3 * triangle;
  return vec3_finite(m->positions[k[0]]) && vec3_finite(m->positions[k[1]]) &&
         vec3_finite(m->positions[k[2]]);
}

// The triangles of a block that can be drawn; *edges grows by those that have
// no area, unless they count as well.
static size_t count_block(const mesh *m, const raster_block *b, bool all,
                          size_t *edges) {
  size_t n = 0;
  for (size_t t = b->first; t < (size_t)b->first + b->count; t++) {
    if (!is_finite(m, t)) continue;
    bool edge = !all && raster_is_edge(m, t);
    *edges += edge;
    n += !edge;
  }
  return n;
}

plan_sight plan_sight_of(const scene *s, const camera_view *v,
                         const int window[4], bool all, arena *mem) {
  size_t materials = s->material_count > 0 ? s->material_count : 1;
  plan_sight out = {.unseen = ARENA_NEW(mem, bool, materials)};
  arena scratch = {0};
  raster_blocks blocks = raster_blocks_of(s, &scratch);
  raster_frustum view = raster_frustum_of(v, window);
  for (size_t i = 0; i < materials; i++)
    out.unseen[i] = true;
  for (size_t i = 0; i < blocks.count; i++) {
    const raster_block *b = &blocks.items[i];
    size_t n = count_block(&s->mesh, b, all, &out.edges);
    out.triangles += n;
    if (n == 0 || (!all && raster_block_outside(b, &view))) continue;
    out.in_view += n;
    out.seen += out.unseen[b->material];
    out.unseen[b->material] = false;
  }
  arena_free(&scratch);
  return out;
}

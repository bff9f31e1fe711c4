// path_group.h — pixels whose paths are walked together, sample by sample.

#ifndef PATH_GROUP_H
#define PATH_GROUP_H

#include "camera.h"
#include "path_world.h"
#include "sampler.h"

// The film that the paths of pixels start from.
typedef struct path_film {
  const camera_view *view;
  int width, height;
} path_film;

// So many pixels are a group, and so many groups share a block of pixels, half
// of them either color of a chessboard; a tile of RENDER_TILE holds whole
// blocks.
enum { GROUP = 16, BLOCK_GROUPS = 4, BLOCK_WIDTH = 8, BLOCK_HEIGHT = 8 };

// No such pixel, or nobody who asked for it.
#define GROUP_NO_PIXEL UINT64_MAX
#define GROUP_NOBODY UINT32_MAX

// Groups one after the other, their members in order.
typedef struct path_groups {
  path_start starts[INTEGRATOR_BATCH];  // of pixel GROUP_NO_PIXEL: none
  uint32_t asked[INTEGRATOR_BATCH];     // by which start; GROUP_NOBODY
  size_t count;
  uint64_t name[INTEGRATOR_BATCH / GROUP];  // of each group
  uint32_t first_of[2 * INTEGRATOR_BATCH];  // by the hash of a group
} path_groups;

// The groups of some of n starts, from the first one on: all of their pixels on
// the film, whether they were asked for or not, so that what they find depends
// on nothing else.  How many starts have theirs; the places of by say where
// others start.
size_t path_groups_seat(path_groups *g, const path_film *film,
                        const integrator *by, const path_start *starts,
                        size_t n);

// The numbers that member i of the groups has in common with the others: of one
// sequence for all groups of a color in a block, in which those of each group
// follow each other, and so are even.
sampler path_groups_numbers(const path_groups *g, size_t i, sampler_kind kind,
                            uint64_t seed);

#endif

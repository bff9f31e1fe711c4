// light_lore.h — what questions to lights have brought: by place, by blocks of
// places, and in all.

#ifndef LIGHT_LORE_H
#define LIGHT_LORE_H

#include "light_part.h"

#include <stdint.h>

// What one question brought: the cell of the place (light_memory_key), whom it
// went to, and the irradiance from there over its density; 0 where something
// was in between.  weight: the density of that question over that and the one
// of scattered rays, together.
typedef struct light_record {
  uint32_t key, part;
  float found, weight;
} light_record;

// Cells along the longest side of the scene, and the sides that a surface may
// face.
enum { LIGHT_GRID = 24, LIGHT_SIDES = 6 };

// Cells, blocks of eight cells, blocks of eight blocks, and so on: grids of
// half as many along a side, down to 3.
enum { LIGHT_LEVELS = 4 };

// What is known of each part: sums over `asked` questions, of what they found,
// of its squares, and of those over the density of scattered rays.
typedef struct lore {
  float asked[LIGHT_PARTS_MOST], finds[LIGHT_PARTS_MOST];
  float squares[LIGHT_PARTS_MOST], alone[LIGHT_PARTS_MOST];
} lore;

// A row of lore: the first one for all of the scene, then one for each cell
// where there are records, below `cells`, then those of blocks.
typedef struct light_lore {
  lore *of;
  float unit;  // times which finds are, so that the largest is 1
  uint32_t cells, rows;
  uint32_t *visits;                // of cells, by row
  uint16_t *row_of[LIGHT_LEVELS];  // by key in that grid
} light_lore;

// That of n records, in scratch: each row with some of its block's.  share: the
// probabilities with which parts were asked.  row_of[0], in mem, knows a row
// for all keys: where there are no records it is that of the smallest block
// that has some.
light_lore light_lore_of(const light_record *records, size_t n,
                         const float *share, arena *mem, arena *scratch);

#endif

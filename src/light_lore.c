// light_lore.c

#include "light_lore.h"

#include "scalar.h"

#include <float.h>

enum { GRID = LIGHT_GRID, SIDES = LIGHT_SIDES, LEVELS = LIGHT_LEVELS };
enum { KEYS = GRID * GRID * GRID * SIDES };
_Static_assert(GRID >> (LEVELS - 1) << (LEVELS - 1) == GRID, "whole blocks");

// A cell adds so many records of its block to its own, a block as many of its
// own block, and so on up to the whole scene.
#define SHARED 3.0f

// The least quotient of the densities of scattered rays and of a question, and
// the least weight of a question.
#define LEAST_SCATTERED 0.01f
#define LEAST_WEIGHT 1e-6f

// Rows have 16 bits.  Where there are more cells than that leaves, the rest has
// only its block's.
enum { MOST_ROWS = 1 << 16, MOST_CELLS = MOST_ROWS - KEYS / 4 };

// A row's key in its grid, and the row of its block.
typedef struct kin {
  uint32_t key, above;
} kin;

// The key of the block in which a cell, or block, of a grid lies.
static uint32_t key_above(uint32_t key, uint32_t grid) {
  uint32_t side = key % SIDES, at = key / SIDES, half = grid / 2;
  uint32_t x = at % grid / 2, y = at / grid % grid / 2;
  uint32_t z = at / grid / grid / 2;
  return ((z * half + y) * half + x) * SIDES + side;
}

// The row of a key, which may be a new one.
static uint32_t row_at(light_lore *l, int level, uint32_t key, uint32_t most,
                       kin *kins) {
  uint16_t *row = &l->row_of[level][key];
  if (*row == 0 && l->rows < most) {
    kins[l->rows].key = key;
    *row = (uint16_t)l->rows++;
  }
  return *row;
}

// A block's row comes after those of what is in it.
static void number_rows(light_lore *l, const light_record *records, size_t n,
                        kin *kins) {
  l->rows = 1;
  for (size_t i = 0; i < n; i++)
    row_at(l, 0, records[i].key, MOST_CELLS, kins);
  l->cells = l->rows;
  uint32_t row = 1;
  for (int level = 1; level < LEVELS; level++)
    for (uint32_t end = l->rows; row < end; row++) {
      uint32_t key = key_above(kins[row].key, (uint32_t)GRID >> (level - 1));
      kins[row].above = row_at(l, level, key, MOST_ROWS, kins);
    }
}

// Cells and blocks without a row have their block's.
static void inherit(uint16_t *row_of, uint32_t grid, const uint16_t *above) {
  uint32_t half = grid / 2;
  for (uint32_t z = 0; z < grid; z++)
    for (uint32_t y = 0; y < grid; y++)
      for (uint32_t x = 0; x < grid; x++) {
        uint16_t *row = row_of + ((z * grid + y) * grid + x) * SIDES;
        const uint16_t *of_block =
            above + ((z / 2 * half + y / 2) * half + x / 2) * SIDES;
        for (uint32_t side = 0; side < SIDES; side++)
          if (row[side] == 0) row[side] = of_block[side];
      }
}

static void add(lore *restrict to, const lore *restrict l) {
  for (int k = 0; k < LIGHT_PARTS_MOST; k++) {
    to->asked[k] += l->asked[k];
    to->finds[k] += l->finds[k];
    to->squares[k] += l->squares[k];
    to->alone[k] += l->alone[k];
  }
}

static void add_some(lore *restrict to, const lore *restrict l) {
  for (int k = 0; k < LIGHT_PARTS_MOST; k++) {
    float times = SHARED / l->asked[k];
    times = l->asked[k] > 0 ? times : 0;
    to->asked[k] += times * l->asked[k];
    to->finds[k] += times * l->finds[k];
    to->squares[k] += times * l->squares[k];
    to->alone[k] += times * l->alone[k];
  }
}

// Blocks have the records of what is in them; then, from above, each row gets
// some of its block's.
static void share_lore(light_lore *l, const kin *kins) {
  for (uint32_t i = 1; i < l->rows; i++)
    add(&l->of[kins[i].above], &l->of[i]);
  for (uint32_t i = l->rows - 1; i > 0; i--)
    add_some(&l->of[i], &l->of[kins[i].above]);
}

static void note(const light_lore *l, const light_record *r, float share) {
  uint32_t row = l->row_of[0][r->key], k = r->part;
  lore *to = &l->of[row];
  float find = r->found * l->unit;
  float scattered = 1 / float_max(r->weight, LEAST_WEIGHT) - 1;
  l->visits[row]++;
  to->asked[k]++;
  to->finds[k] += find;
  to->squares[k] += find * find;
  to->alone[k] += find * find / (share * float_max(scattered, LEAST_SCATTERED));
}

static float unit_of(const light_record *records, size_t n) {
  float most = 0;
  for (size_t i = 0; i < n; i++)
    most = float_max(most, records[i].found);
  return most > FLT_MIN ? 1 / most : 1;
}

light_lore light_lore_of(const light_record *records, size_t n,
                         const float *share, arena *mem, arena *scratch) {
  light_lore l = {.unit = unit_of(records, n)};
  for (int level = 0; level < LEVELS; level++)
    l.row_of[level] =
        ARENA_NEW(level > 0 ? scratch : mem, uint16_t, KEYS >> 3 * level);
  kin *kins = ARENA_NEW(scratch, kin, MOST_ROWS);
  number_rows(&l, records, n, kins);
  l.visits = ARENA_NEW(scratch, uint32_t, l.cells);
  l.of = ARENA_NEW(scratch, lore, l.rows);
  for (size_t i = 0; i < n; i++)
    note(&l, &records[i], share[records[i].part]);
  share_lore(&l, kins);
  for (int level = LEVELS - 1; level > 0; level--)
    inherit(l.row_of[level - 1], (uint32_t)GRID >> (level - 1),
            l.row_of[level]);
  return l;
}

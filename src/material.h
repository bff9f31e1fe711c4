// material.h — which surface a face gets, decided once, by a printed table.

#ifndef MATERIAL_H
#define MATERIAL_H

#include "mtl.h"
#include "texture.h"

typedef enum material_kind {
  MATERIAL_BLINN_PHONG,
  MATERIAL_METAL_ROUGH,
  MATERIAL_MIRROR,
  MATERIAL_GLASS
} material_kind;

// A surface, ready to shade.  Colours are linear.
typedef struct material {
  const char *name;
  material_kind kind;
  int rule;         // 1..5, of the decision table of interface and book
  const char *why;  // "rule 2: Pr 0.3 at garden.mtl:12"
  vec3 kd, ks;      // albedo (base colour for metal-rough); specular colour
  vec3 ke;          // emitted radiance on the front side
  vec3 tf;          // share of light transmitted, metal-rough only, else 0
  float ns, ni, d;  // exponent, index of refraction, opacity
  float roughness, metallic;
  bool passes;  // some of it lets light straight through: d < 1 or map_d
  texture_map map_kd, map_ks, map_ke, map_ns, map_d, map_pr, map_pm;
  texture_map map_bump, map_norm;
  const mtl_material *source;  // what it was made from, NULL: grey default
} material;

// The names that decide.
typedef struct material_use {
  const char *object;            // NULL when none
  const char *name;              // usemtl, NULL when none
  const mtl_material *assigned;  // by rule 1, else NULL
  const char *assigned_at;       // "garden.scene:7", where assigned is set
  const mtl_material *written;   // of the MTL, else NULL: grey default
  bool name_rules;               // rule 4 in force
} material_use;

// Apply the table: first match wins.  1. assign: the kind is then what the
// assigned material says by rules 2 to 5 with its own name.  2. Pr, Pm or a map
// for one: metallic-roughness, where alone Tf counts.  3. illum 3, 5, 8 with a
// Ks that is not black: mirror; 6, 7 with Ni > 1: glass; 4, 9: Blinn-Phong seen
// through where d < 1.  4. The word glass or mirror in the object's name, else
// in the material's.  5. Blinn-Phong.  A mirror reflects ks.  Opacity below 1
// lets light pass under every rule but for glass, which is clear already.
// Textures are named in map_*.options, not loaded.
material material_decide(const material_use *use, arena *mem);

// Whether text contains word as a whole word: case-insensitive, split at _ .
// - blanks, digits.
bool material_has_word(const char *text, const char *word);

const char *material_kind_name(material_kind k);

// The texture statements of a material by number: kd, ks, ke, ns, d, pr, pm,
// bump, norm.
enum { MATERIAL_MAPS = 9 };
texture_map *material_map(material *m, int k);

// Which of them a surface of kind `as` looks at when it is shaded: bit k is
// statement k.  The others make no difference to any picture.
unsigned material_reads(const material *m, material_kind as);

#endif

// plan_word.c

#include "plan_word.h"

plan_verdict plan_verdict_of(const plan_line *l) {
  uint64_t did = l->counted ? l->did : l->need;
  if (did == 0) return PLAN_SKIPPED;
  return did < l->all && l->all != PLAN_ANY ? PLAN_REDUCED : PLAN_DONE;
}

bool plan_kept(const plan_line *l) {
  if (!l->told || !l->counted || l->need == PLAN_ANY) return true;
  return l->did == l->need || (l->at_most && l->did < l->need);
}

const char *plan_word(plan_verdict verdict) {
  static const char *const words[] = {"done", "reduced", "skipped"};
  return words[verdict];
}

// A stage, and what it counts.
typedef struct stage_words {
  const char *name, *unit;
} stage_words;

static const stage_words WORDS[PLAN_STAGES] = {
    [PLAN_TEXTURES] = {"textures", "files"},
    [PLAN_ENV_MAP] = {"environment map", "files"},
    [PLAN_TEXCOORDS] = {"texture coordinates", "pairs"},
    [PLAN_NORMALS] = {"normals", "vectors"},
    [PLAN_TRIANGLES] = {"triangles", "triangles"},
    [PLAN_MAPS] = {"texture uploads", "maps"},
    [PLAN_DRAW_LIST] = {"draw list", "triangles"},
    [PLAN_VISIBILITY] = {"visibility first", "passes"},
    [PLAN_KINDS] = {"programs", "kinds of surface"},
    [PLAN_LAMPS] = {"lamps", "lamps"},
    [PLAN_SHADOW_MAPS] = {"shadow maps", "layers"},
    [PLAN_SKY] = {"sky", "passes"},
    [PLAN_IBL] = {"light from around", "sums"},
    [PLAN_TABLE] = {"roughness table", "tables"},
    [PLAN_LEAN] = {"leaning lobes", "tables"},
    [PLAN_RESOLVE] = {"resolve", "passes"},
    [PLAN_TREE] = {"tree", "trees"},
    [PLAN_PATHS] = {"paths", "paths"},
    [PLAN_ENV_TABLE] = {"sky directions", "tables"},
    [PLAN_ASK] = {"light samples", "samples"},
    [PLAN_SHADOW_RAY] = {"shadow rays", "rays"},
    [PLAN_AIM] = {"aimed rays", "rays"},
    [PLAN_SHARE] = {"shared finds", "rays"},
    [PLAN_ALPHA] = {"alpha tests", "rays"},
    [PLAN_SEGMENTS] = {"segments", "a path"},
    [PLAN_FILMS] = {"other films", "films"},
    [PLAN_SQUARES] = {"variance", "films"},
    [PLAN_ESTIMATE] = {"error estimate", "estimates"},
    [PLAN_POST] = {"post", "passes"},
    [PLAN_PIXELS] = {"pixels", "pixels"},
};

const char *plan_name(plan_stage stage) {
  return WORDS[stage].name;
}

const char *plan_unit(plan_stage stage) {
  return WORDS[stage].unit;
}

// plan.h — what a picture needs, derived once from scene, camera and flags
// between reading and rendering.  Every stage asks the plan and nothing else,
// and tells it afterwards what it did.

#ifndef PLAN_H
#define PLAN_H

#include "ibl.h"
#include "path_world.h"
#include "plan_sight.h"
#include "render.h"

// The stages, in the order of their work.
typedef enum plan_stage {
  PLAN_TEXTURES,     // decoded
  PLAN_ENV_MAP,      // decoded
  PLAN_TEXCOORDS,    // kept
  PLAN_NORMALS,      // of corners, kept or made
  PLAN_TRIANGLES,    // uploaded, or in the tree
  PLAN_MAPS,         // textures in the memory of the context
  PLAN_DRAW_LIST,    // triangles drawn for the eye
  PLAN_VISIBILITY,   // found before anything is shaded
  PLAN_KINDS,        // of surface that have a program
  PLAN_LAMPS,        // point and directional lights
  PLAN_SHADOW_MAPS,  // layers
  PLAN_SKY,          // passes behind everything
  PLAN_IBL,          // sums of light from the environment
  PLAN_TABLE,        // of metallic-roughness
  PLAN_LEAN,         // of where its lobes look
  PLAN_RESOLVE,      // passes from samples to pixels
  PLAN_TREE,
  PLAN_PATHS,       // samples whose paths are followed
  PLAN_ENV_TABLE,   // of bright directions
  PLAN_ASK,         // light samples
  PLAN_SHADOW_RAY,  // of these
  PLAN_AIM,         // rays at mirrors and glass
  PLAN_SHARE,       // rays at what neighbours have found
  PLAN_ALPHA,       // blocked shadow rays that look for sheets
  PLAN_SEGMENTS,    // of a path, where they are limited
  PLAN_FILMS,       // beside the colour
  PLAN_SQUARES,     // of samples, for their variance
  PLAN_ESTIMATE,    // of the error
  PLAN_POST,        // passes over the finished picture
  PLAN_PIXELS,
  PLAN_STAGES
} plan_stage;

// As many as there are: nobody knows before.
#define PLAN_ANY UINT64_MAX

// One stage: what is needed of all that there might be, in its unit.
typedef struct plan_line {
  bool told;  // the stage belongs to this engine
  uint64_t need, all;
  bool at_most;     // need is a bound: the stage may find that less will do
  const char *why;  // in a few words
  bool counted;     // the stage has said what it did:
  uint64_t did;
  double seconds;  // below 0: not timed by itself
  double bytes;    // that it holds, or writes; 0 for none
} plan_line;

// What is asked for.
typedef struct plan_request {
  const scene *scene;  // textures found, perhaps not decoded
  camera_view view;    // of the whole film
  int width, height;   // of the film
  int window[4];       // x0, y0, x1, y1 of what is rendered
  bool path;           // by the path engine
  render_shading shading;
  unsigned aovs;         // bits of render.h
  bool lights, shadows;  // flags of those names
  bool naive;            // paths that do not look for light
  bool learns;           // paths that may remember what they see of the sky
  bool each;             // every triangle shaded where it is drawn
  bool split;            // lobes look along the mirror direction
  pbr_model model;
  int msaa, max_depth;
  uint64_t samples;         // in all, 0 where time or error ends the run
  bool estimate, adaptive;  // somebody hears of the error; it decides
  bool kept;                // sums are kept for another run
  uint64_t before;          // samples that another run took
  bool frosted;
  bool no_skip;  // everything counts as needed
} plan_request;

typedef struct plan {
  plan_request of;
  plan_line line[PLAN_STAGES];
  unsigned *maps;    // by material: bits of the textures that are looked at
  plan_sight sight;  // of the raster engine
  light *lamps;      // those that shine
  size_t lamp_count;
  bool black;       // the environment gives no light
  bool lamps_only;  // as path_world has it
} plan;

// Derive it, in mem.
plan plan_make(const plan_request *r, arena *mem);

// Whether a picture depends on normals; known before anything is read.
bool plan_shows_normals(render_shading shading, unsigned aovs);

// Whether a stage is needed at all.
bool plan_needs(const plan *p, plan_stage stage);

// Note what a stage did; seconds below 0: not timed.
void plan_note(plan *p, plan_stage stage, uint64_t did, double seconds,
               double bytes);

#endif

// cmd_tree.h — the tree that --bvh asks for.

#ifndef CMD_TREE_H
#define CMD_TREE_H

#include "cmd_shared.h"
#include "mesh.h"
#include "tree_cache.h"
#include "wide.h"

// A mesh made traceable, and what that cost.  The binary tree has its nodes
// only where it is what traces; its counts stay.
typedef struct cmd_tree {
  bvh binary;
  wide_tree wide;  // nodes NULL when it is not what traces
  tracer tracer;
  double seconds;       // to build or to load it
  double save_seconds;  // to put it into the cache; 0: it was not
  double rays;          // how many are expected
  const char *name;     // of the mesh, for the cache; NULL: do without
  bool paths;           // they leave surfaces, and say which
  bool from_cache;
  bool patches;  // were found for all triangles
} cmd_tree;

// How many rays a picture takes, roughly; spp 0: nobody knows.
double cmd_tree_rays(int width, int height, int spp);

// `rays`, `paths` and `name` of *out are given: rays tell auto whether cutting
// triangles pays, and for paths whether patches do.
void cmd_tree_build(cmd_tree *out, const options *o, const mesh *m, arena *mem,
                    pool *threads);

// Bytes of what rays read: nodes, and triangles or their numbers.
size_t cmd_tree_bytes(const cmd_tree *t);

// The members of the object "bvh".
void cmd_tree_json(json *j, const cmd_tree *t);

#endif

// cmd_output.h — where a rendered picture goes, decided before any work.

#ifndef CMD_OUTPUT_H
#define CMD_OUTPUT_H

#include "cmd_shared.h"
#include "picture.h"
#include "post.h"
#include "render.h"

// The places a picture and its companions are written to.
typedef struct output {
  const options *o;
  const char *path;  // "-" for standard output
  picture_format format;
  bool part;  // no picture: a part of one, with all that goes into it
  int depth;
  const char *aov[RENDER_AOV_COUNT];  // NULL where not asked for
  bool radiance;                      // which has exposure
  float exposure;                     // stops; set after the scene is read
  bool frosted;                       // behind this pane
  post_frost pane;                    // x0 and y0 set after the scene is read
} output;

// Whether a file can be created at path: 0, or errno.
int output_problem(const char *path, arena *mem);

// Name the companions, one for each bit.
void output_name_aovs(output *out, unsigned aovs, arena *mem);

// Decide all paths and check what can be checked before anything is read.
// Returns an exit code, having said what is wrong.
int output_plan(output *out, const options *o, arena *mem);

// Whether path, which may be NULL, leads to a file that would be written over:
// its name, or NULL.
const char *output_overwrites(const output *out, const char *path);

// Warn of options that this format has no use for.
void output_warn(const output *out, report *r);

// Whether something would be written over a file that s was read from: the
// exit code.
int output_protect_inputs(const output *out, const scene *s, arena *mem);

// Write the picture and its companions.  The picture itself is changed only
// in a copy.  False with the reason in err.
bool output_write(const output *out, const render_result *r, arena *mem,
                  error *err);

#endif

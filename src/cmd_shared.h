// cmd_shared.h — what all commands do alike: fail, warn, name files.

#ifndef CMD_SHARED_H
#define CMD_SHARED_H

#include "env.h"
#include "option.h"
#include "report.h"

#include "json.h"

#ifndef FACET_VERSION
// What --version prints, and parts of pictures are marked with.
#define FACET_VERSION "0.1"
#endif

// Exit codes, a contract with scripts.
enum {
  EXIT_DONE = 0,
  EXIT_NO = 1,         // finished, but the answer is no
  EXIT_USAGE = 2,      // the command line is wrong
  EXIT_INPUT = 3,      // input missing or malformed
  EXIT_OUTPUT = 4,     // output could not be written
  EXIT_RESOURCES = 5,  // no memory, no OpenGL
  EXIT_EARLY = 75      // stopped by a signal, the picture so far is written or
                       // can be gone on with
};

// Print "facet: error: ..." to stderr and return code.
int cmd_fail(const options *o, int code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// Print the warnings to stderr unless -q, and with -v the notes.
void cmd_remarks(const options *o, const report *r);

// The member "warnings": all remarks of that kind.
void cmd_json_warnings(json *j, const report *r);

// The threads that -j asks for, or the default.
int cmd_threads(const options *o);

// The last component of a path without its suffix, in mem.
char *cmd_stem(arena *mem, const char *path);

// Whether path ends with that suffix (".obj"), in any case.
bool cmd_has_suffix(const char *path, const char *suffix);

// The path of a file beside `path` with another suffix: a/b.obj, ".scene"
// gives a/b.scene.
char *cmd_beside(arena *mem, const char *path, const char *suffix);

// Sort n numbers and return the middle one.
double cmd_median(double *values, size_t n);

// The environment that text names: a picture, R,G,B, sky or none.
bool cmd_env_of(env *out, const char *text, arena *mem, report *r, error *err);

// The commands, each returning an exit code.
int cmd_render(const options *o);
int cmd_view(const options *o);
int cmd_info(const options *o);
int cmd_compare(const options *o);
int cmd_bench_load(const options *o);
int cmd_bench_rays(const options *o);
int cmd_bench_raster(const options *o);
int cmd_bench_error(const options *o);
int cmd_ibl(const options *o);
int cmd_bench_ibl(const options *o);
int cmd_merge(const options *o);
int cmd_cache(const options *o);
int cmd_help(const options *o);

// What `facet help` prints, to out.
void cmd_print_overview(FILE *out);

#endif

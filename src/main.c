// main.c — the program's entry: choose the command, and see to it that what
// was printed arrived.

#include "cmd_shared.h"

#include "clock.h"

#include <signal.h>
#include <string.h>

// A command by its bit.
static int run_command(const options *o) {
  switch (o->command->bit) {
  case CMD_RENDER: return cmd_render(o);
  case CMD_VIEW: return cmd_view(o);
  case CMD_INFO: return cmd_info(o);
  case CMD_COMPARE: return cmd_compare(o);
  case CMD_BENCH_LOAD: return cmd_bench_load(o);
  case CMD_BENCH_RAYS: return cmd_bench_rays(o);
  case CMD_BENCH_RASTER: return cmd_bench_raster(o);
  case CMD_BENCH_ERROR: return cmd_bench_error(o);
  case CMD_IBL: return cmd_ibl(o);
  case CMD_CACHE: return cmd_cache(o);
  case CMD_BENCH_IBL: return cmd_bench_ibl(o);
  case CMD_MERGE: return cmd_merge(o);
  default: return cmd_help(o);
  }
}

// `facet COMMAND --help` is `facet help COMMAND`.
static int help_about(const options *o) {
  char first[64];
  const char *space = strchr(o->command->name, ' ');
  snprintf(first, sizeof first, "%.*s",
           space ? (int)(space - o->command->name) : 63, o->command->name);
  const char *operands[2] = {first, space ? space + 1 : NULL};
  options asked = {.command = o->command,
                   .operands = operands,
                   .operand_count = space ? 2 : 1};
  return cmd_help(&asked);
}

// Flush standard output; a reader that is gone, or a full disk, turns success
// into failure.
static int finish(const options *o, int code) {
  bool bad = ferror(stdout) != 0;
  if (fclose(stdout) != 0) bad = true;
  if (!bad) return code;
  cmd_fail(o, EXIT_OUTPUT, "standard output could not be written");
  return code == EXIT_DONE || code == EXIT_NO ? EXIT_OUTPUT : code;
}

// What is asked without a command: true when it is done, with its exit code.
static bool run_bare(int argc, char **argv, int *code) {
  options none = {0};
  if (argc < 2) {
    cmd_print_overview(stderr);
    *code = EXIT_USAGE;
    return true;
  }
  bool bench = argc == 3 && strcmp(argv[1], "bench") == 0;
  const char *last = argv[bench ? 2 : 1];
  if (!bench && strcmp(last, "--version") == 0) {
    printf("facet %s\n", FACET_VERSION);
    *code = finish(&none, EXIT_DONE);
    return true;
  }
  if (strcmp(last, "--help") != 0 && strcmp(last, "-h") != 0) return false;
  const char *operands[1] = {"bench"};
  none.operands = operands;
  none.operand_count = bench ? 1 : 0;
  *code = finish(&none, cmd_help(&none));
  return true;
}

int main(int argc, char **argv) {
  double started = clock_seconds();
  // A closed pipe is an error of writing, with exit status 4, not a death; nor
  // is a file beyond the limit of the shell, which may be one of the cache.
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  int code;
  if (run_bare(argc, argv, &code)) return code;

  arena mem = {0};
  options o;
  error err;
  const char **operands = ARENA_NEW(&mem, const char *, (size_t)argc);
  if (!options_parse(&o, argc, argv, operands, &err)) {
    o = (options){0};
    code = cmd_fail(&o, EXIT_USAGE, "%s", err.text);
  } else {
    o.started = started;
    code = o.value[OPT_HELP].given ? help_about(&o) : run_command(&o);
    code = finish(&o, code);
  }
  arena_free(&mem);
  return code;
}

// cmd_help.c — help, the manual page: both are the option table, printed.

#include "cmd_shared.h"

#include <string.h>

// Columns of a line of help, and where the explanations start.
enum { HELP_WIDTH = 79, HELP_INDENT = 26 };

// Print text, wrapped, from column `at` on; later lines start at `indent`.  A
// newline in the text is a new paragraph.
static void print_wrapped(FILE *out, const char *text, int at, int indent) {
  while (*text != 0) {
    size_t n = strcspn(text, " \n");
    if (at > indent && at + 1 + (int)n > HELP_WIDTH) {
      fprintf(out, "\n%*s", indent, "");
      at = indent;
    } else if (at > indent) {
      fputc(' ', out);
      at++;
    }
    fwrite(text, 1, n, out);
    at += (int)n;
    text += n;
    if (*text == '\n') {
      fprintf(out, "\n%*s", indent, "");
      at = indent;
    }
    if (*text != 0) text++;
  }
  fputc('\n', out);
}

// "-o, --output FILE|-" into text.
static void write_flag(char *text, size_t size, const option *o) {
  char letter[8] = "";
  if (o->letter != 0) snprintf(letter, sizeof letter, "-%c, ", o->letter);
  snprintf(text, size, "%s--%s%s%s", letter, o->name,
           o->argument != NULL ? " " : "", o->argument ? o->argument : "");
}

// The explanation and the default.
static void write_help(char *text, size_t size, const option *o) {
  const char *fallback = o->fallback ? o->fallback : "";
  snprintf(text, size, "%s%s%s%s", o->help, o->fallback ? " (default: " : "",
           fallback, o->fallback ? ")" : "");
}

// One option: the flag, then the explanation and the default.
static void print_option(FILE *out, const option *o) {
  char flag[128], help[512];
  write_flag(flag, sizeof flag, o);
  write_help(help, sizeof help, o);
  int at = fprintf(out, "  %s", flag);
  if (at + 2 > HELP_INDENT) {
    fputc('\n', out);
    at = 0;
  }
  fprintf(out, "%*s", HELP_INDENT - at, "");
  print_wrapped(out, help, HELP_INDENT, HELP_INDENT);
}

// All of one command.
static void print_command(FILE *out, const command *c) {
  fprintf(out, "facet %s [OPTIONS] %s: %s.\n\n", c->name, c->operands,
          c->summary);
  if (c->details != NULL) {
    print_wrapped(out, c->details, 0, 0);
    fputc('\n', out);
  }
  for (int i = 0; i < OPTION_COUNT; i++)
    if ((option_table[i].commands & c->bit) != 0)
      print_option(out, &option_table[i]);
}

void cmd_print_overview(FILE *out) {
  fputs("facet renders Wavefront OBJ files.\n\n", out);
  for (const command *c = command_table; c->name != NULL; c++) {
    int at = fprintf(out, "  facet %s %s", c->name, c->operands);
    fprintf(out, "%*s%s\n", at < 30 ? 30 - at : 1, "", c->summary);
  }
  fputs(
      "  facet --version             print the version\n"
      "\n"
      "'facet help render' explains the options of render.\n"
      "Exit status: 0 done, 1 the answer is no, 2 usage, 3 input, 4 output,\n"
      "5 out of memory or no OpenGL, 75 stopped early with the picture so far\n"
      "written.\n",
      out);
}

// A text of the manual page: - and \ escaped, so that options can be copied.
static void print_roff(FILE *out, const char *text) {
  bool start = true;
  for (const char *s = text; *s != 0; s++) {
    if (start && (*s == '.' || *s == '\'')) fputs("\\&", out);
    start = *s == '\n';
    if (*s == '\n') fputs("\n.PP", out);
    if (*s == '-' || *s == '\\') fputc('\\', out);
    fputc(*s, out);
  }
  fputc('\n', out);
}

// The options of a command, as tagged paragraphs.
static void print_roff_command(FILE *out, const command *c) {
  fprintf(out, ".SS facet %s [OPTIONS] %s\n", c->name, c->operands);
  print_roff(out, c->details ? c->details : c->summary);
  for (int i = 0; i < OPTION_COUNT; i++) {
    const option *o = &option_table[i];
    if ((o->commands & c->bit) == 0 || o->commands == CMD_ALL) continue;
    char flag[128];
    write_flag(flag, sizeof flag, o);
    fputs(".TP\n.B ", out);
    print_roff(out, flag);
    char help[512];
    write_help(help, sizeof help, o);
    print_roff(out, help);
  }
}

// The whole manual page.
static void print_manual(FILE *out) {
  fputs(".TH FACET 1\n.SH NAME\nfacet \\- render Wavefront OBJ files\n"
        ".SH SYNOPSIS\n",
        out);
  for (const command *c = command_table; c->name != NULL; c++)
    fprintf(out, ".B facet %s\n[OPTIONS] %s\n.br\n", c->name, c->operands);
  fputs(".B facet \\-\\-version\n.SH COMMANDS\n", out);
  for (const command *c = command_table; c->name != NULL; c++)
    print_roff_command(out, c);
  fputs(
      ".SH EXIT STATUS\n"
      "0 done; 1 finished, but the answer is no; 2 usage; 3 input missing or\n"
      "malformed; 4 output could not be written; 5 out of memory, or no "
      "OpenGL\n"
      "for the raster engine; 75 stopped early, the picture so far is "
      "written;\n"
      "128+n ended by signal n.\n"
      ".SH ENVIRONMENT\n"
      "NO_COLOR and TERM=dumb turn colours off.  COLUMNS is the width of the\n"
      "progress bar's line.  SLURM_CPUS_PER_TASK limits the threads.  Mesa's\n"
      "software renderer draws with LP_NUM_THREADS threads, facet's number\n"
      "where that is not set.\n",
      out);
}

int cmd_help(const options *o) {
  if (o->value[OPT_MAN].given) print_manual(stdout);
  if (o->value[OPT_MAN].given) return EXIT_DONE;
  if (o->operand_count == 0) {
    cmd_print_overview(stdout);
    return EXIT_DONE;
  }
  // "bench" alone explains every command that starts with it.
  char name[128];
  int n = snprintf(name, sizeof name, "%s%s%s", o->operands[0],
                   o->operand_count > 1 ? " " : "",
                   o->operand_count > 1 ? o->operands[1] : "");
  bool found = false;
  for (const command *c = command_table; c->name != NULL; c++) {
    bool whole = strcmp(c->name, name) == 0;
    bool start = strncmp(c->name, name, (size_t)n) == 0 && c->name[n] == ' ';
    if (!whole && !start) continue;
    if (found) fputc('\n', stdout);
    print_command(stdout, c);
    found = true;
  }
  if (found) return EXIT_DONE;
  error err;
  char *argv[3] = {"", (char *)o->operands[0],
                   o->operand_count > 1 ? (char *)o->operands[1] : NULL};
  int words;
  command_of(o->operand_count + 1, argv, &words, &err);
  return cmd_fail(o, EXIT_USAGE, "%s", err.text);
}

// cmd_help.c — help: the option table, printed.

#include "cmd_manual.h"
#include "cmd_shared.h"
#include "help_text.h"

#include <string.h>

// Columns of a line of help, and where the explanations start: of options, of
// exit statuses.
enum { HELP_WIDTH = 79, HELP_INDENT = 26, HELP_SHORT = 10 };

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

// One option: the flag, then the explanation and the default.
static void print_option(FILE *out, const option *o) {
  char flag[128], help[1024];
  cmd_write_flag(flag, sizeof flag, o);
  cmd_write_help(help, sizeof help, o);
  int at = fprintf(out, "  %s", flag);
  if (at + 2 > HELP_INDENT) {
    fputc('\n', out);
    at = 0;
  }
  fprintf(out, "%*s", HELP_INDENT - at, "");
  print_wrapped(out, help, HELP_INDENT, HELP_INDENT);
}

// The examples of the commands whose bits are given.
static void print_examples(FILE *out, unsigned commands) {
  bool any = false;
  for (const help_example *e = help_examples; e->line != NULL; e++) {
    if ((e->command & commands) == 0) continue;
    if (!any) fputs("\nExamples:\n", out);
    any = true;
    fprintf(out, "  %s\n%*s", e->line, HELP_INDENT, "");
    print_wrapped(out, e->what, HELP_INDENT, HELP_INDENT);
  }
}

// All of one command.
static void print_command(FILE *out, const command *c) {
  fprintf(out, "facet %s [OPTIONS] %s: %s.\n", c->name, c->operands,
          c->summary);
  if (c->details != NULL) {
    fputc('\n', out);
    print_wrapped(out, c->details, 0, 0);
  }
  const char *group = NULL;
  for (int i = 0; i < OPTION_COUNT; i++) {
    if ((option_table[i].commands & c->bit) == 0) continue;
    const char *title = cmd_group_of((option_id)i);
    if (title != group) fprintf(out, "\n%s:\n", title);
    group = title;
    print_option(out, &option_table[i]);
  }
  print_examples(out, c->bit);
}

void cmd_print_overview(FILE *out) {
  fputs("facet renders Wavefront OBJ files.\n\nCommands:\n", out);
  for (const command *c = command_table; c->name != NULL; c++) {
    int at = fprintf(out, "  facet %s %s", c->name, c->operands);
    fprintf(out, "%*s%s\n", at < 30 ? 30 - at : 1, "", c->summary);
  }
  fputs("  facet --version             print the version\n"
        "\n"
        "'facet help COMMAND' or 'facet COMMAND --help' explains its options,\n"
        "'facet help --man' prints the manual.\n",
        out);
  print_examples(out, CMD_RENDER);
  fputs("\nExit status:\n", out);
  const help_item *i = help_items;
  do {
    int at = fprintf(out, "  %s", i->term);
    fprintf(out, "%*s", HELP_SHORT - at, "");
    print_wrapped(out, i->text, HELP_SHORT, HELP_SHORT);
    i++;
  } while (i->title == NULL && i->term != NULL);
}

// "bench rays" from one or two operands.
static void write_asked(char *text, size_t size, const options *o) {
  bool two = o->operand_count > 1;
  snprintf(text, size, "%s%s%s", o->operands[0], two ? " " : "",
           two ? o->operands[1] : "");
}

// Say that nothing explains what was asked for.
static int fail_unknown(const options *o) {
  error err;
  char *argv[3] = {"", (char *)o->operands[0],
                   o->operand_count > 1 ? (char *)o->operands[1] : NULL};
  int words;
  command_of(o->operand_count + 1, argv, &words, &err);
  return cmd_fail(o, EXIT_USAGE, "%s", err.text);
}

// The manual page that was asked for.
static int print_page(const options *o) {
  char name[128] = "";
  if (o->operand_count > 0) write_asked(name, sizeof name, o);
  if (name[0] == 0) cmd_print_manual(stdout, NULL);
  if (name[0] == 0) return EXIT_DONE;
  for (const command *c = command_table; c->name != NULL; c++) {
    if (strcmp(c->name, name) != 0) continue;
    cmd_print_manual(stdout, c);
    return EXIT_DONE;
  }
  return fail_unknown(o);
}

int cmd_help(const options *o) {
  const option_value *shell = &o->value[OPT_COMPLETION];
  if (shell->given) cmd_print_completion(stdout, shell->text);
  if (shell->given) return EXIT_DONE;
  if (o->value[OPT_MAN].given) return print_page(o);
  if (o->operand_count == 0) {
    cmd_print_overview(stdout);
    return EXIT_DONE;
  }
  // "bench" alone explains every command that starts with it.
  char name[128];
  write_asked(name, sizeof name, o);
  size_t n = strlen(name);
  bool found = false;
  for (const command *c = command_table; c->name != NULL; c++) {
    bool whole = strcmp(c->name, name) == 0;
    bool start = strncmp(c->name, name, n) == 0 && c->name[n] == ' ';
    if (!whole && !start) continue;
    if (found) fputc('\n', stdout);
    print_command(stdout, c);
    found = true;
  }
  return found ? EXIT_DONE : fail_unknown(o);
}

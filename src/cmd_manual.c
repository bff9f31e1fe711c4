// cmd_manual.c — pages for man(1).

#include "cmd_manual.h"

#include "cmd_shared.h"
#include "help_text.h"

#include <ctype.h>
#include <string.h>

void cmd_write_flag(char *text, size_t size, const option *o) {
  char letter[8] = "";
  if (o->letter != 0) snprintf(letter, sizeof letter, "-%c, ", o->letter);
  snprintf(text, size, "%s--%s%s%s", letter, o->name,
           o->argument != NULL ? " " : "", o->argument ? o->argument : "");
}

void cmd_write_help(char *text, size_t size, const option *o) {
  const char *fallback = o->fallback ? o->fallback : "";
  snprintf(text, size, "%s%s%s%s", o->help, o->fallback ? " (default: " : "",
           fallback, o->fallback ? ")" : "");
}

const char *cmd_group_of(option_id id) {
  const char *title = help_groups[0].title;
  for (const help_group *g = help_groups; g->title != NULL; g++)
    if (g->first <= id) title = g->title;
  return title;
}

// What a character of a text is in roff: signs that man would turn into
// typographic ones, so that they could not be copied, have names.
static const char *roff_of(char c) {
  switch (c) {
  case '-': return "\\-";
  case '\\': return "\\(rs";
  case '\'': return "\\(aq";
  case '`': return "\\(ga";
  case '^': return "\\(ha";
  case '~': return "\\(ti";
  case '"': return "\\(dq";
  default: return NULL;
  }
}

// A text of the manual page; a newline in it is a new paragraph.
static void print_roff(FILE *out, const char *text) {
  bool start = true;
  for (const char *s = text; *s != 0; s++) {
    if (start && *s == '.') fputs("\\&", out);
    start = *s == '\n';
    const char *name = roff_of(*s);
    if (start) fputs("\n.PP", out);
    if (name != NULL)
      fputs(name, out);
    else
      fputc(*s, out);
  }
  fputc('\n', out);
}

// A paragraph behind a bold term.
static void print_tagged(FILE *out, const char *term, const char *text) {
  fputs(".TP\n.B ", out);
  print_roff(out, term);
  print_roff(out, text);
}

// The options of a command; those that every command has only where it stands
// alone.  Groups have headings there.
static void print_roff_options(FILE *out, const command *c, bool alone) {
  const char *group = NULL;
  for (int i = 0; i < OPTION_COUNT; i++) {
    const option *o = &option_table[i];
    if ((o->commands & c->bit) == 0) continue;
    if (!alone && o->commands == CMD_ALL) continue;
    char flag[128], help[1024];
    cmd_write_flag(flag, sizeof flag, o);
    cmd_write_help(help, sizeof help, o);
    if (alone && cmd_group_of((option_id)i) != group) {
      group = cmd_group_of((option_id)i);
      fputs(".SS ", out);
      print_roff(out, group);
    }
    print_tagged(out, flag, help);
  }
}

// The examples of the commands whose bits are given.
static void print_roff_examples(FILE *out, unsigned commands) {
  fputs(".SH EXAMPLES\n", out);
  for (const help_example *e = help_examples; e->line != NULL; e++)
    if ((e->command & commands) != 0) print_tagged(out, e->line, e->what);
}

// "facet-bench-rays" into text.
static void write_page_name(char *text, size_t size, const command *c) {
  snprintf(text, size, "facet%s%s", c ? "-" : "", c ? c->name : "");
  for (char *s = text; *s != 0; s++)
    if (*s == ' ') *s = '-';
}

// The head of a page, with its name in capitals.
static void print_head(FILE *out, const command *c, const char *summary) {
  char name[64], title[64];
  write_page_name(name, sizeof name, c);
  for (size_t i = 0; i < sizeof name; i++)
    title[i] = (char)toupper((unsigned char)name[i]);
  fprintf(out, ".TH %s 1 \"\" \"facet %s\" \"User Commands\"\n.SH NAME\n",
          title, FACET_VERSION);
  print_roff(out, name);
  fputs("\\- ", out);
  print_roff(out, summary);
  fputs(".SH SYNOPSIS\n", out);
}

// One command's line of the synopsis.
static void print_synopsis(FILE *out, const command *c) {
  fputs(".B facet ", out);
  print_roff(out, c->name);
  fputs("[OPTIONS] ", out);
  print_roff(out, c->operands);
}

// What holds for all commands; only the exit statuses unless `whole`.
static void print_items(FILE *out, bool whole) {
  for (const help_item *i = help_items; i->term != NULL; i++) {
    if (!whole && i > help_items && i->title != NULL) break;
    if (i->title != NULL) fprintf(out, ".SH %s\n", i->title);
    print_tagged(out, i->term, i->text);
  }
}

// The pages of all commands but one.
static void print_see_also(FILE *out, const command *but) {
  fputs(".SH SEE ALSO\n", out);
  if (but != NULL) fputs(".BR facet (1)", out);
  bool first = but == NULL;
  for (const command *c = command_table; c->name != NULL; c++) {
    char name[64];
    if (c == but) continue;
    write_page_name(name, sizeof name, c);
    fputs(first ? ".BR " : ",\n.BR ", out);
    for (const char *s = name; *s != 0; s++)
      fputs(*s == '-' ? "\\-" : (char[]){*s, 0}, out);
    fputs(" (1)", out);
    first = false;
  }
  fputc('\n', out);
}

// facet(1): every command with all of its options, then the rest.
static void print_whole_manual(FILE *out) {
  print_head(out, NULL, "render Wavefront OBJ files");
  for (const command *c = command_table; c->name != NULL; c++) {
    print_synopsis(out, c);
    fputs(".br\n", out);
  }
  fputs(".B facet \\-\\-version\n.SH DESCRIPTION\n", out);
  print_roff(out,
             "facet turns triangles into pictures, by OpenGL or by following "
             "the paths of light.  Options stand before or behind operands, as "
             "--name VALUE or --name=VALUE; the last one wins; -- ends them.");
  fputs(".SH COMMANDS\n", out);
  for (const command *c = command_table; c->name != NULL; c++) {
    fputs(".SS facet ", out);
    print_roff(out, c->name);
    print_roff(out, c->details ? c->details : c->summary);
    print_roff_options(out, c, false);
  }
  print_items(out, true);
  print_roff_examples(out, CMD_ALL);
  print_see_also(out, NULL);
}

void cmd_print_manual(FILE *out, const command *c) {
  if (c == NULL) {
    print_whole_manual(out);
    return;
  }
  print_head(out, c, c->summary);
  print_synopsis(out, c);
  fputs(".SH DESCRIPTION\n", out);
  print_roff(out, c->details ? c->details : c->summary);
  fputs(".SH OPTIONS\n", out);
  print_roff_options(out, c, true);
  print_items(out, c->bit == CMD_RENDER);
  print_roff_examples(out, c->bit);
  print_see_also(out, c);
}

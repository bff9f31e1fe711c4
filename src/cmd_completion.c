// cmd_completion.c — what shells need to know to complete a command line.

#include "cmd_manual.h"

#include <string.h>

// What can be offered for the argument of an option.
typedef enum offer {
  OFFER_NOTHING,  // a number, or a name that only the user knows
  OFFER_FILES,
  OFFER_WORDS,  // one of the words of the argument
  OFFER_LIST    // some of them, split at commas
} offer;

static offer offer_of(const option *o) {
  if (o->kind == OPTION_WORD) return OFFER_WORDS;
  if (o->kind == OPTION_WORDS) return OFFER_LIST;
  if (o->kind != OPTION_TEXT) return OFFER_NOTHING;
  bool dotted = strchr(o->argument, '.') != NULL;
  return strncmp(o->argument, "FILE", 4) == 0 || dotted ? OFFER_FILES
                                                        : OFFER_NOTHING;
}

// The words of an argument, each followed by a blank.
static void print_words(FILE *out, const option *o) {
  for (const char *s = o->argument; *s != 0; s++)
    fputc(*s == '|' || *s == ',' ? ' ' : *s, out);
}

// The beginning of a sentence, up to where it explains itself; inside single
// quotes of a shell, with \ before the characters that `special` names.
static void print_short(FILE *out, const char *text, const char *special) {
  for (const char *s = text; *s != 0; s++) {
    if (*s == ';' || (*s == '.' && s[1] == ' ')) break;
    if (*s == ' ' && s[1] == '(') break;
    if (*s == '\'')
      fputs("'\\''", out);
    else
      fprintf(out, "%s%c", strchr(special, *s) ? "\\" : "", *s);
  }
}

// Each option of a command, by what the caller does with it.
static void each_option(FILE *out, const command *c,
                        void (*print)(FILE *, const option *)) {
  for (int i = 0; i < OPTION_COUNT; i++)
    if ((option_table[i].commands & c->bit) != 0) print(out, &option_table[i]);
}

// bash: the name of an option, for a list.
static void bash_flag(FILE *out, const option *o) {
  fprintf(out, " --%s", o->name);
}

// bash: what to do behind an option that takes a value.
static void bash_value(FILE *out, const option *o) {
  if (o->kind == OPTION_SWITCH) return;
  fputs("    ", out);
  if (o->letter != 0) fprintf(out, "-%c|", o->letter);
  fprintf(out, "--%s) ", o->name);
  switch (offer_of(o)) {
  case OFFER_FILES: fputs("kind=files", out); break;
  case OFFER_NOTHING: fputs("kind=nothing", out); break;
  case OFFER_WORDS: fputs("kind=words words='", out); break;
  case OFFER_LIST: fputs("kind=list words='", out); break;
  }
  if (offer_of(o) == OFFER_WORDS || offer_of(o) == OFFER_LIST) {
    print_words(out, o);
    fputc('\'', out);
  }
  fputs(" ;;\n", out);
}

// A command's first or only word, once for commands that share it.
static void print_first_words(FILE *out) {
  for (const command *c = command_table; c->name != NULL; c++) {
    size_t n = strcspn(c->name, " ");
    bool again = c > command_table && strncmp(c->name, c[-1].name, n) == 0;
    if (!again) fprintf(out, "%.*s ", (int)n, c->name);
  }
}

// The second words behind a first one.
static void print_second_words(FILE *out, const char *first) {
  for (const command *c = command_table; c->name != NULL; c++) {
    size_t n = strlen(first);
    if (strncmp(c->name, first, n) == 0 && c->name[n] == ' ')
      fprintf(out, "%s ", c->name + n + 1);
  }
}

static void print_bash(FILE *out) {
  fputs(
      "# facet(1) completion for bash; made by 'facet help --completion'\n"
      "_facet() {\n"
      "  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]}\n"
      "  local command=${COMP_WORDS[1]} kind=files words= flags= at=2\n"
      "  COMPREPLY=()\n"
      "  # --name=VALUE comes as three words.\n"
      "  if [ \"$cur\" = = ]; then cur=\n"
      "  elif [ \"$prev\" = = ]; then prev=${COMP_WORDS[COMP_CWORD-2]}; fi\n"
      "  if [ \"$command\" = bench ]; then command=\"bench "
      "${COMP_WORDS[2]}\" at=3; fi\n"
      "  if [ \"$COMP_CWORD\" = 1 ]; then kind=words words='",
      out);
  print_first_words(out);
  fputs("--version --help'\n"
        "  elif [ \"$COMP_CWORD\" -lt $at ]; then kind=words words='",
        out);
  print_second_words(out, "bench");
  fputs("'\n  else case $command in\n", out);
  for (const command *c = command_table; c->name != NULL; c++) {
    fprintf(out, "  '%s')\n    flags='", c->name);
    each_option(out, c, bash_flag);
    fputs("'\n    case $prev in\n", out);
    each_option(out, c, bash_value);
    if (c->bit == CMD_HELP) {
      fputs("    *) kind=words words='", out);
      print_first_words(out);
      fputs("' ;;\n", out);
    }
    fputs("    esac ;;\n", out);
  }
  fputs("  esac; fi\n"
        "  case $kind,$cur in\n"
        "  files,-?*|words,--*) COMPREPLY=($(compgen -W \"$flags $words\" -- "
        "\"$cur\")) ;;\n"
        "  files,*) ;; # by readline's own way\n"
        "  nothing,*) compopt +o default ;;\n"
        "  list,*) words=\" $words\"\n"
        "    case $cur in *,*) words=${words// / ${cur%,*},} ;; esac\n"
        "    COMPREPLY=($(compgen -W \"$words\" -- \"$cur\")) ;;\n"
        "  *) COMPREPLY=($(compgen -W \"$words\" -- \"$cur\")) ;;\n"
        "  esac\n"
        "}\n"
        "complete -o default -F _facet facet\n",
        out);
}

// zsh: an option as _arguments wants it.
static void zsh_option(FILE *out, const option *o) {
  const char *equals = o->kind == OPTION_SWITCH ? "" : "=";
  fputs("    '", out);
  if (o->letter != 0)
    fprintf(out, "(-%c --%s)'{-%c", o->letter, o->name, o->letter);
  if (o->letter != 0 && *equals != 0) fputc('+', out);
  fprintf(out, "%s--%s%s%s[", o->letter != 0 ? "," : "", o->name, equals,
          o->letter != 0 ? "}'" : "");
  print_short(out, o->help, "[]:\\");
  fputc(']', out);
  if (o->kind != OPTION_SWITCH) fprintf(out, ":%s:", o->name);
  switch (offer_of(o)) {
  case OFFER_NOTHING: break;
  case OFFER_FILES: fputs("_files", out); break;
  case OFFER_WORDS:
    fputc('(', out);
    print_words(out, o);
    fputc(')', out);
    break;
  case OFFER_LIST:
    fprintf(out, "_values -s , %s ", o->name);
    print_words(out, o);
    break;
  }
  fputs("'\n", out);
}

// zsh: a command's or second word's line for _describe.
static void zsh_word(FILE *out, const char *word, size_t n, const char *what) {
  fprintf(out, "    '%.*s:", (int)n, word);
  print_short(out, what, ":\\");
  fputs("'\n", out);
}

static void print_zsh(FILE *out) {
  fputs("#compdef facet\n"
        "# facet(1) completion for zsh; made by 'facet help --completion'\n"
        "_facet() {\n"
        "  local -a verbs benches specs\n"
        "  verbs=(\n",
        out);
  bool bench = false;
  for (const command *c = command_table; c->name != NULL; c++) {
    if (strchr(c->name, ' ') == NULL)
      zsh_word(out, c->name, strlen(c->name), c->summary);
    else if (!bench)
      zsh_word(out, "bench", 5, "measure");
    bench = bench || strchr(c->name, ' ') != NULL;
  }
  fputs("  )\n  benches=(\n", out);
  for (const command *c = command_table; c->name != NULL; c++)
    if (strncmp(c->name, "bench ", 6) == 0)
      zsh_word(out, c->name + 6, strlen(c->name + 6), c->summary);
  fputs("  )\n"
        "  local command=$words[2] skip=1\n"
        "  if (( CURRENT == 2 )); then _describe command verbs; return; fi\n"
        "  if [[ $command == bench ]]; then\n"
        "    if (( CURRENT == 3 )); then _describe measurement benches; return;"
        " fi\n"
        "    command=\"bench $words[3]\" skip=2\n"
        "  fi\n"
        "  case $command in\n",
        out);
  for (const command *c = command_table; c->name != NULL; c++) {
    fprintf(out, "  '%s') specs=(\n", c->name);
    each_option(out, c, zsh_option);
    fputs(c->bit == CMD_HELP ? "    '*:command:(" : "    '*:file:_files'\n",
          out);
    if (c->bit == CMD_HELP) print_first_words(out);
    if (c->bit == CMD_HELP) fputs(")'\n", out);
    fputs("  ) ;;\n", out);
  }
  fputs("  esac\n"
        "  shift $skip words\n"
        "  (( CURRENT -= skip ))\n"
        "  _arguments -s -S $specs\n"
        "}\n"
        "_facet \"$@\"\n",
        out);
}

// fish: the condition that a command is what is typed.
static void fish_when(FILE *out, const command *c) {
  fprintf(out, "complete -c facet -n '__facet_is %s'", c->name);
}

// fish: an option.
static void fish_option(FILE *out, const command *c, const option *o) {
  fish_when(out, c);
  if (o->letter != 0) fprintf(out, " -s %c", o->letter);
  fprintf(out, " -l %s", o->name);
  offer what = offer_of(o);
  if (what == OFFER_FILES) fputs(" -r -F", out);
  if (what == OFFER_NOTHING && o->kind != OPTION_SWITCH) fputs(" -x", out);
  if (what == OFFER_WORDS || what == OFFER_LIST) {
    fprintf(out, " -x -a '%s", what == OFFER_LIST ? "(__fish_append , " : "");
    print_words(out, o);
    fprintf(out, "%s'", what == OFFER_LIST ? ")" : "");
  }
  fputs(" -d '", out);
  print_short(out, o->help, "\\");
  fputs("'\n", out);
}

static void print_fish(FILE *out) {
  fputs("# facet(1) completion for fish; made by 'facet help --completion'\n"
        "function __facet_is\n"
        "  set -l typed (commandline -opc)\n"
        "  set -e typed[1]\n"
        "  string match -q -- \"$argv *\" \"$typed \"\n"
        "end\n"
        "function __facet_at\n"
        "  test (count (commandline -opc)) -eq $argv[1]\n"
        "end\n",
        out);
  for (const command *c = command_table; c->name != NULL; c++) {
    const char *second = strchr(c->name, ' ');
    fprintf(out, "complete -c facet -f -n '__facet_%s' -a %s -d '",
            second ? "at 2; and __facet_is bench" : "at 1",
            second ? second + 1 : c->name);
    print_short(out, c->summary, "\\");
    fputs("'\n", out);
  }
  fputs("complete -c facet -f -n '__facet_at 1' -a bench -d 'measure'\n"
        "complete -c facet -f -n '__facet_is help' -a '",
        out);
  print_first_words(out);
  fputs("'\n", out);
  for (const command *c = command_table; c->name != NULL; c++)
    for (int i = 0; i < OPTION_COUNT; i++)
      if ((option_table[i].commands & c->bit) != 0)
        fish_option(out, c, &option_table[i]);
}

void cmd_print_completion(FILE *out, const char *shell) {
  if (strcmp(shell, "bash") == 0) print_bash(out);
  if (strcmp(shell, "zsh") == 0) print_zsh(out);
  if (strcmp(shell, "fish") == 0) print_fish(out);
}

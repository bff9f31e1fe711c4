// main.c — the table: stress [short|full|long] [SLICE] [PART...]
//
// SLICE is a number that changes the random numbers; PART is one of the names
// below.  Exit status 1 when a row is wrong.

#include "stress.h"

#include <string.h>

static const struct {
  const char *name;
  void (*run)(stress *);
} PARTS[] = {
    {"watertight", stress_watertight}, {"geometry", stress_geometry},
    {"scatter", stress_scatter},       {"light", stress_light},
    {"pictures", stress_pictures},     {"twice", stress_twice},
};

enum { PART_COUNT = sizeof PARTS / sizeof *PARTS };

// 3e+07 as 3e7, small whole numbers as they are.
static void write_number(char text[24], double x) {
  if (x != x)
    snprintf(text, 24, "%s", "");
  else if (fabs(x) < 10000 && x == floor(x))
    snprintf(text, 24, "%.0f", x);
  else
    snprintf(text, 24, "%.2g", x);
}

void stress_print(stress *s, stress_row r) {
  bool good = r.wrong == 0 && !(r.worst > r.allowed) &&
              (isnan(r.allowed) || !isnan(r.worst));
  char tried[24], wrong[24], worst[24], allowed[24];
  write_number(tried, r.tried);
  write_number(wrong, r.wrong);
  write_number(worst, r.worst);
  write_number(allowed, r.allowed);
  printf("| %-60s | %7s | %5s | %7s | %7s | %s |%s\n", r.what, tried, wrong,
         worst, allowed, r.elsewhere, good ? "" : " WRONG");
  fflush(stdout);
  s->failed += !good;
}

int main(int argc, char **argv) {
  arena mem = {0};
  stress s = {.size = STRESS_FULL};
  int at = 1;
  if (at < argc && strcmp(argv[at], "short") == 0) s.size = STRESS_SHORT;
  if (at < argc && strcmp(argv[at], "long") == 0) s.size = STRESS_LONG;
  if (at < argc) at++;
  if (at < argc) s.slice = strtoull(argv[at++], NULL, 10);
  s.threads = pool_new(&mem, pool_default_threads());
  puts("| what | tried | wrong | worst | allowed | elsewhere |\n"
       "|---|---|---|---|---|---|");
  for (int i = 0; i < PART_COUNT; i++) {
    bool asked = at == argc;
    for (int k = at; k < argc; k++)
      asked = asked || strcmp(argv[k], PARTS[i].name) == 0;
    if (asked) PARTS[i].run(&s);
  }
  pool_free(s.threads);
  arena_free(&mem);
  if (s.failed > 0) printf("%d rows are wrong\n", s.failed);
  return s.failed > 0;
}

// expectation.h — test data whose first line says what is right:
//
//   # expect: ok faces=6 area=24 warning="text"
//   # expect: error line=7 text="index 0"

#ifndef EXPECTATION_H
#define EXPECTATION_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <dirent.h>

// One word of the first line: name=value, or a name alone.
typedef struct expectation {
  char name[32], value[256];
} expectation;

// Take the next word at *at; false at the end of the line.
static inline bool expectation_next(const char **at, expectation *e) {
  const char *p = *at;
  size_t n = 0;
  *e = (expectation){0};
  while (*p == ' ')
    p++;
  for (; strchr("= \r\n", *p) == NULL && n + 1 < sizeof e->name; p++)
    e->name[n++] = *p;
  if (n == 0) return false;
  n = 0;
  if (*p == '=') {
    bool quoted = *++p == '"';
    for (p += quoted; n + 1 < sizeof e->value && *p != '\0'; p++) {
      if (*p == (quoted ? '"' : ' ') || *p == '\n' || *p == '\r') break;
      if (*p == '\\' && p[1] == '"') p++;
      e->value[n++] = *p;
    }
    p += quoted && *p == '"';
  }
  *at = p;
  return true;
}

// The numbers of a value "1,2.5,3"; returns how many.
static inline int expectation_numbers(const expectation *e, double x[3]) {
  int n = 0;
  for (const char *p = e->value; *p != '\0' && n < 3; n++) {
    char *end;
    x[n] = strtod(p, &end);
    p = *end == ',' ? end + 1 : end;
  }
  return n;
}

// Whether a test with this name and content is right; run for each file of a
// folder by expectation_run.
typedef bool (*expectation_check)(const char *path, const char *expected);

// Run check on every file of the folder whose name ends in suffix; fails when
// one fails or fewer than `least` are there.
static inline void expectation_run(const char *folder, const char *suffix,
                                   int least, expectation_check check) {
  int count = 0, failed = 0;
  DIR *d = opendir(folder);
  assert_non_null(d);
  for (struct dirent *e; (e = readdir(d)) != NULL;) {
    char path[512], first[1024] = {0};
    size_t n = strlen(e->d_name), m = strlen(suffix);
    if (n < m || strcmp(e->d_name + n - m, suffix) != 0) continue;
    snprintf(path, sizeof path, "%s/%.200s", folder, e->d_name);
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    first[fread(first, 1, sizeof first - 1, f)] = '\0';
    fclose(f);
    const char *expected = strstr(first, "# expect: ");
    assert_non_null(expected);
    if (!check(path, expected + strlen("# expect: "))) {
      print_message("# in %s\n", path);
      failed++;
    }
    count++;
  }
  closedir(d);
  assert_true(count >= least);
  assert_int_equal(failed, 0);
}

// Whether some remark of a report holds the text.
#define REPORT_HAS(report, wanted, found) \
  do { \
    for (report_line *line_ = (report)->first; line_ != NULL && !(found); \
         line_ = line_->next) \
      (found) = strstr(line_->text, (wanted)) != NULL; \
  } while (0)

#endif

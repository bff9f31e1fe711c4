// cpu_quota.c

#include "cpu_quota.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { QUOTA_PATH_MAX = 4096 };

int cpu_count_of(const char *text) {
  if (text == NULL || *text == '\0') return 0;
  int n = 0;
  for (; *text != '\0'; text++) {
    if (*text < '0' || *text > '9' || n > 99999) return 0;
    n = n * 10 + (*text - '0');
  }
  return n;
}

// A whole number at the start of *s, which moves behind it and the blanks
// after it; -1 when there is none ("max" and "-1" mean no limit).
static double quota_number(const char **s) {
  const char *p = *s;
  double value = 0;
  if (*p < '0' || *p > '9') return -1;
  for (; *p >= '0' && *p <= '9'; p++)
    value = value * 10 + (*p - '0');
  while (*p == ' ' || *p == '\n')
    p++;
  *s = p;
  return value;
}

// The first line of root/group/name in text, false when it cannot be read.
static bool quota_line(char text[128], const char *root, const char *group,
                       const char *name) {
  char path[2 * QUOTA_PATH_MAX];
  snprintf(path, sizeof path, "%s%s/%s", root, group, name);
  FILE *f = fopen(path, "r");
  if (f == NULL) return false;
  bool got = fgets(text, 128, f) != NULL;
  fclose(f);
  return got;
}

// What one group grants: "QUOTA PERIOD" in microseconds in one file of version
// 2, in two files of version 1.
static double quota_of_group(const char *root, const char *group) {
  char text[128], period[128];
  const char *s = text, *t = period;
  if (quota_line(text, root, group, "cpu.max")) {
    double used = quota_number(&s);
    double of = quota_number(&s);
    return used > 0 && of > 0 ? used / of : HUGE_VAL;
  }
  if (quota_line(text, root, group, "cpu.cfs_quota_us") &&
      quota_line(period, root, group, "cpu.cfs_period_us")) {
    double used = quota_number(&s);
    double of = quota_number(&t);
    return used > 0 && of > 0 ? used / of : HUGE_VAL;
  }
  return HUGE_VAL;
}

// The least quota of group and of the groups above it; group is cut short on
// the way.  A container often sees its own group at the root of the mount.
static double quota_up(const char *root, char *group) {
  double least = quota_of_group(root, "");
  for (char *slash = group; slash != NULL && *group != '\0';) {
    least = fmin(least, quota_of_group(root, group));
    slash = strrchr(group, '/');
    if (slash != NULL) *slash = '\0';
  }
  return least;
}

// One line of the cgroup file: "ID:CONTROLLERS:PATH".  Version 2 has ID 0 and
// no controllers; version 1 mounts each set of controllers by itself.
static double quota_of_line(char *line, const char *root) {
  line[strcspn(line, "\n")] = '\0';
  char *controllers = strchr(line, ':');
  char *group = controllers != NULL ? strchr(controllers + 1, ':') : NULL;
  if (group == NULL) return HUGE_VAL;
  controllers++;
  *group++ = '\0';
  size_t length = strlen(group);
  if (length > 0 && group[length - 1] == '/') group[length - 1] = '\0';
  if (*controllers == '\0') return quota_up(root, group);
  if (strcmp(controllers, "cpu") != 0 && strncmp(controllers, "cpu,", 4) != 0 &&
      strstr(controllers, ",cpu,") == NULL)
    return HUGE_VAL;
  char mount[QUOTA_PATH_MAX];
  snprintf(mount, sizeof mount, "%s/cpu", root);
  return quota_up(mount, group);
}

double cpu_quota(const char *cgroup_file, const char *root) {
  FILE *f = fopen(cgroup_file, "r");
  if (f == NULL) return HUGE_VAL;
  double least = HUGE_VAL;
  char line[QUOTA_PATH_MAX];
  while (fgets(line, sizeof line, f) != NULL)
    least = fmin(least, quota_of_line(line, root));
  fclose(f);
  return least;
}

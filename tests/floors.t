#!/bin/sh
# Each module includes only headers of modules before it in the Makefile's
# list, every source file is in that list, only the pool knows pthreads, only
# the arena allocates, only the command line prints to stdout or exits, and only
# what draws by OpenGL includes its headers.
echo 1..5
: "${MODULES:?run by make test}"
awk -v order="$MODULES" '
BEGIN { n = split(order, m, " "); for (i = 1; i <= n; i++) floor[m[i]] = i }
FNR == 1 {
  me = FILENAME; sub(/.*\//, "", me); sub(/\.[ch]$/, "", me)
  if (!(me in floor)) { print "# " FILENAME " is not in MODULES"; bad = 1 }
}
/^#include "/ {
  split($0, q, "\""); it = q[2]; sub(/\.h$/, "", it)
  if (it != me && floor[it] > floor[me]) {
    printf "# %s:%d: %s stands below %s\n", FILENAME, FNR, me, it; bad = 1
  }
}
END { exit bad }' src/*.[ch] && echo "ok 1 - floors" || echo "not ok 1 - floors"

only() { # NUMBER WHAT PATTERN ALLOWED
  found=$(grep -nE "$3" src/*.[ch] | grep -vE "^src/($4)\.[ch]:" |
    grep -vE '^[^:]*:[0-9]+: *//')
  if [ -z "$found" ]; then echo "ok $1 - $2"
  else echo "not ok $1 - $2"; echo "$found" | sed 's/^/# /'; fi
}
only 2 "only pool includes pthread.h" 'include <pthread' pool
only 3 "only arena allocates" '\b(malloc|calloc|realloc|strdup|free)\(' arena
only 4 "only the command line prints or exits" \
  '\b(printf|puts|putchar|exit|_exit|abort)\(|\b(stdout|stderr)\b' \
  "main|cmd_.*|option.*|progress|json|arena|picture"
only 5 "only gl, raster and view include GL headers" \
  'include (<(GL|EGL|GLFW|KHR)/|"gl_(api|make)\.h"|"glsl\.h")' \
  "gl|gl_.*|glsl|raster|raster_.*|view|view_.*|post"

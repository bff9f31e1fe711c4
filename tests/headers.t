#!/bin/sh
# Every header compiles alone.
set -- src/*.h
echo "1..$#"
n=0
for h; do
  n=$((n + 1))
  if ${CC:-cc} -std=c11 -D_POSIX_C_SOURCE=200809L -Wall -Wextra -Werror \
    -fsyntax-only -iquote src -x c "$h" 2>build/headers.log
  then echo "ok $n - $h"
  else echo "not ok $n - $h"; sed 's/^/# /' build/headers.log; fi
done

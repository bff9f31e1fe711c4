#!/bin/sh
# The source is laid out by clang-format 14, functions have at most 60 lines,
# a .c at most 400 and a .h at most 120.
echo 1..2
if command -v clang-format-14 >/dev/null; then
  if clang-format-14 --dry-run -Werror src/*.[ch] tests/*.[ch] chapters/*.h \
    chapters/*/figures.c 2>build/format.log
  then echo "ok 1 - format"
  else echo "not ok 1 - format"; head -20 build/format.log | sed 's/^/# /'; fi
else echo "ok 1 - format # SKIP no clang-format-14"
fi
long=$(awk '
FNR == 1 { start = 0 }
/^[A-Za-z].*\)[ ]*\{$|^ .*\)[ ]*\{$/ { if (!start) start = FNR }
/^}/ { if (start && FNR - start > 60)
         print FILENAME ":" start ": function of " FNR - start + 1 " lines"
       start = 0 }
FILENAME ~ /\.c$/ && FNR == 401 { print FILENAME ": over 400 lines" }
FILENAME ~ /\.h$/ && FNR == 121 { print FILENAME ": over 120 lines" }
' src/*.[ch])
if [ -z "$long" ]; then echo "ok 2 - sizes"
else echo "not ok 2 - sizes"; echo "$long" | sed 's/^/# /'; fi

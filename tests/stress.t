#!/bin/sh
# A slice of the table of `make stress`, a line each: what breaks in a few
# thousand tries breaks here.
. tests/tap.sh
build/release/stress short >"$T/table" 2>"$T/err"
code=$?
sed -n '3,$s/^| *\([^|]*[^| ]\) *|[^|]*|[^|]*|[^|]*|[^|]*|[^|]*|\(.*\)/\2\t\1/p' "$T/table" >"$T/rows"
tab=$(printf '\t')
while IFS="$tab" read -r bad name; do
  [ -n "$name" ] || { name=$bad bad=; }
  if [ -z "$bad" ]; then pass "$name"; else grep -F "$name" "$T/table" >"$T/said"; fail "$name"; fi
done <"$T/rows"
if [ "$code" = 0 ] && [ "$n" -gt 25 ]; then pass "all rows"; else fail "$n rows, exit status $code"; fi
finish

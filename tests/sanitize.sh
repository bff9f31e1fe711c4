#!/bin/sh
# sanitize.sh BUILD... — all unit tests, shortened, and the scripts that run
# threads and files, by builds under sanitizers; then a picture under valgrind.
# Prints a line a failure and a count; exit status 1 when there is one.
bad=0 good=0
export FACET_QUICK=1
export LSAN_OPTIONS=suppressions=tests/leaks.supp:print_suppressions=0
export TSAN_OPTIONS=halt_on_error=1
log=build/sanitize-long.log
check() { # NAME COMMAND...
  name=$1
  shift
  if "$@" >"$log" 2>&1 && ! grep -q '^not ok' "$log"; then good=$((good + 1))
  else bad=$((bad + 1)); echo "FAILED $name"; tail -20 "$log"; fi
}
for build; do
  for source in tests/test_*.c; do
    test=$(basename "$source" .c)
    check "$build $test" "$build/tests/$test"
  done
  for script in cli render part compare info ibl; do
    [ -f "tests/$script.t" ] && FACET=$build/facet check "$build $script.t" sh "tests/$script.t"
  done
done
check valgrind valgrind -q --error-exitcode=9 --leak-check=full \
  build/release/facet render scenes/cornell.scene --engine path -r 24x16 \
  --spp 2 -j 2 -q -o build/valgrind.png
echo "$good passed, $bad failed"
[ "$bad" = 0 ]

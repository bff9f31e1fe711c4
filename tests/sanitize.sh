#!/bin/sh
# sanitize.sh BUILD... — all unit tests, shortened, and the scripts that run
# threads and files, by builds under sanitizers; the table of hostile files by
# the one that sees memory; then a picture under valgrind.  Prints a line each
# with its seconds, what failed, and a count; exit status 1 when something did.
bad=0 good=0
here=$(pwd)
export FACET_QUICK=1
export LSAN_OPTIONS="suppressions=$here/tests/leaks.supp:print_suppressions=0"
export TSAN_OPTIONS="halt_on_error=1:suppressions=$here/tests/races.supp"
log=build/sanitize-long.log
check() { # NAME COMMAND...
  name=$1
  shift
  start=$(date +%s)
  if "$@" >"$log" 2>&1 && ! grep -q '^not ok' "$log"; then good=$((good + 1)) word=ok
  else bad=$((bad + 1)) word=FAILED; fi
  echo "$word $name, $(($(date +%s) - start)) s"
  [ $word = ok ] || { grep -A 12 '^not ok' "$log"; tail -40 "$log"; }
}
for build; do
  export FACET_SANITIZED="$build"
  for source in tests/test_*.c; do
    test=$(basename "$source" .c)
    check "$build $test" "$build/tests/$test"
  done
  for script in cli render raster part plan compare info ibl cache; do
    FACET=$build/facet check "$build $script.t" sh "tests/$script.t"
  done
  case $build in *address*) # its limits of memory leave room for this one
    FACET=$build/facet check "$build hostile.t" tests/hostile.t ;;
  esac
done
check valgrind valgrind -q --error-exitcode=9 --leak-check=full \
  build/release/facet render scenes/cornell.scene --engine path -r 24x16 \
  --spp 2 -j 2 -q -o build/valgrind.png
echo "$good passed, $bad failed"
[ "$bad" = 0 ]

#!/bin/sh
# Every reader of strangers' files under libFuzzer, with AddressSanitizer and
# UndefinedBehaviorSanitizer, 20 s each (FUZZ_SECONDS), from the seeds on:
# `make fuzz` is the long run.
targets=$(sed -n 's/^FUZZ  *:= *//p' tests/fuzz/fuzz.mk)
# shellcheck disable=SC2086
set -- $targets
if [ -z "$(ls /usr/lib/llvm-14/lib/clang/*/lib/linux/libclang_rt.fuzzer-*.a 2>/dev/null)" ] ||
  ! command -v clang-14 >/dev/null; then
  echo "1..0 # SKIP no clang-14 with libFuzzer: apt-get install clang-14 libclang-rt-14-dev"
  exit 0
fi
echo "1..$#"
MAKEFLAGS='' make -s -j "$(nproc)" fuzz-build >build/fuzz-build.log 2>&1 || {
  tail -20 build/fuzz-build.log | sed 's/^/# /'
  echo "Bail out! the fuzzers do not build"
  exit 1
}
tests/fuzz/run "${FUZZ_SECONDS:-20}" "$@" >build/fuzz.log 2>&1
n=0
for target; do
  n=$((n + 1))
  said=$(grep "^$target: " build/fuzz.log)
  case $said in
  *"nothing found") echo "ok $n - $said" ;;
  *) echo "not ok $n - ${said:-$target: did not run}"; sed 's/^/# /' build/fuzz.log ;;
  esac
done

#!/bin/sh
# The wide tree's kernel and builder compile for a processor without AVX, where
# there is a cross compiler.
echo 1..1
cross=aarch64-linux-gnu-gcc
if ! command -v $cross >/dev/null; then
  echo "ok 1 - aarch64 # SKIP no $cross"
  exit 0
fi
bad=
for file in src/wide*.c src/build*.c src/simd_runs.c src/slab.c src/triangle.c src/bvh.c; do
  $cross -std=c11 -D_POSIX_C_SOURCE=200809L -Wall -Wextra -Wconversion -Werror -O2 \
    -ffp-contract=off -iquote src -c "$file" -o build/arm.o 2>build/arm.log ||
    { bad=1; sed 's/^/# /' build/arm.log; }
done
if [ -z "$bad" ]; then echo "ok 1 - aarch64"; else echo "not ok 1 - aarch64"; fi

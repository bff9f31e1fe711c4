#!/bin/sh
# The path engine holds little more than what it traces: at most 2.5 times the
# positions, normals and indices of a matt mesh and its tree.
. tests/tap.sh
XDG_CACHE_HOME=$T
export XDG_CACHE_HOME
${CC:-cc} -O1 tests/bench/make_grid.c -lm -o "$T/make_grid"
for form in v vn; do
  "$T/make_grid" 1000000 "$form" >"$T/grid.obj"
  "$facet" info --json "$T/grid.obj" >"$T/info.json" 2>"$T/err"
  # Asked for twice: built, then kept.  Both forms have the same tree.
  rm -rf "$T/facet"
  for how in built kept; do
    "$facet" render "$T/grid.obj" --engine path --env 1,1,1 -r 64x64 --spp 1 \
      -q --json -o "$T/grid.png" >"$T/render.json" 2>"$T/err"
    ok "$form, its tree $how" awk '
      # The number that follows a member of that name.
      function number(name, after) {
        if (!match($0, "\"" name "\": [0-9.]+")) exit bad = 1
        return substr($0, RSTART + length(name) + 4, RLENGTH) + 0
      }
      NR == 1 {
        kinds = number("normals") > 0 ? 2 : 1
        need = 12 * (number("positions") + number("normals"))
        need += 12 * kinds * number("triangles")
      }
      NR == 2 {
        need += number("bytes")
        peak = number("peak_bytes")
        printf "%.1f MB of %.1f\n", peak / 1e6, need / 1e6
        good = need > 6e7 && peak <= 2.5 * need
      }
      END { exit !good || bad }' "$T/info.json" "$T/render.json"
    sed 's/^/# /' "$T/said"
  done
done
finish

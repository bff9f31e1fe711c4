#!/bin/sh
# agree.sh FACET... — whether these builds of facet draw the same bytes: every
# scene by paths, each integrator, sampler and tree, and what is derived from
# an environment.  Prints the count; exit status 1 when something differs.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
first=$1 same=0 differ=0

# all NAME WORDS...: run every build, compare what it writes to NAME.
all() {
  name=$1
  shift
  for facet; do
    # shellcheck disable=SC2086
    XDG_CACHE_HOME="$out/cache" "$facet" $words -o "$out/$name" >/dev/null 2>"$out/err" ||
      { echo "$facet $words:"; cat "$out/err"; }
    rm -rf "$out/cache"
    [ -f "$out/$name" ] || (cd "$out" && cat "$name"/*.pfm >joined && rm -r "$name" && mv joined "$name")
    [ "$facet" = "$first" ] && rm -f "$out/want" && mv "$out/$name" "$out/want" && continue
    if cmp -s "$out/want" "$out/$name"; then same=$((same + 1))
    else differ=$((differ + 1)); echo "differ: $facet $words"; fi
    rm -f "$out/$name"
  done
}
for scene in cornell cornell-balls furnace garden materials terminator; do
  words="render scenes/$scene.scene --engine path -r 96x64 --spp 4 -q"
  all "$scene.pfm" "$@"
done
words="render scenes/garden.obj --engine path -r 96x64 --spp 2 -q --depth 16"
all garden.png "$@"
for how in "--integrator naive" "--sampler random" "--bvh binary" "--bvh fast" \
  "--bvh high" "--pbr-model report" "--normals smooth --crease 40" "--post frosted" \
  "--tonemap aces --exposure 1.5" "--max-depth 3 --seed 9" "--error 0.5"; do
  words="render scenes/materials.scene --engine path -r 96x64 --spp 4 -q $how"
  all materials.png "$@"
done
words="ibl scenes/sky.hdr -q"
all ibl "$@"
echo "$same pictures the same, $differ not"
[ "$differ" = 0 ] && [ "$same" -gt 0 ]

#!/bin/sh
# facet ibl: answers as a render would see them, files that say how to read
# them, and a cache that changes nothing.
. tests/tap.sh
cd "$T" || exit 1
XDG_CACHE_HOME=$T/cache
export XDG_CACHE_HOME
cat >questions <<'END'
irradiance 0 2 0

radiance 0.3 -0.4 1 0.35   # any length of direction
radiance 0 0 -1 0
dfg 1 0
dfg 0.5 0.5
END
exits 0 "questions about a white sky" "$facet" ibl 1,1,1 --eval questions
ok "are answered: pi, 1, 1, and the table" python3 - <<'E'
import math
lines = [[float(x) for x in line.split()] for line in open("out")]
assert [len(l) for l in lines] == [3, 3, 3, 2, 2]
assert all(abs(x - math.pi) < 1e-5 for x in lines[0])
assert all(abs(x - 1) < 1e-5 for l in lines[1:3] for x in l)
assert lines[3] == [1, 0]
assert abs(lines[4][0] - .8349) < 1e-3 and abs(lines[4][1] - .0223) < 1e-3
E
"$facet" ibl 1,1,1 --pbr-model report --eval - <questions >report.txt 2>"$T/err"
ok "the report's table is another, from standard input" sh -c '! cmp -s out report.txt && [ "$(wc -l <report.txt)" = 5 ]'
exits 0 "questions about a map" "$facet" ibl "$root/scenes/dusk.hdr" --eval questions
cp out first
ok "leave a file in the cache" sh -c 'ls cache/facet/ibl-*.bin'
exits 0 "asked again" "$facet" ibl "$root/scenes/dusk.hdr" --eval questions
ok "the answers are the same bytes" cmp first out
for f in cache/facet/*.bin; do printf x >"$f"; done
exits 0 "with a broken cache" "$facet" ibl "$root/scenes/dusk.hdr" --eval questions
ok "the same again" cmp first out
XDG_CACHE_HOME=/dev/null
exits 0 "with no place for a cache" "$facet" ibl "$root/scenes/dusk.hdr" --eval questions
ok "the same still" cmp first out
exits 0 "everything into a folder" "$facet" ibl sky -o all
ok "whose index names what is there" python3 - <<'E'
import json, os
index = json.load(open("all/ibl.json"))
files = [level["file"] for level in index["levels"]] + [index["dfg"]["file"]]
assert "irradiance.pfm" in files and "radiance-0.1.pfm" in files and len(files) > 10
for level in index["levels"]:
    head = open("all/" + level["file"], "rb").read(40).split()
    assert [int(head[1]), int(head[2])] == [level["width"], level["height"]]
assert sorted(os.listdir("all")) == sorted(files + ["ibl.json"])
E
exits 2 "neither folder nor questions" "$facet" ibl sky
exits 3 "a missing environment" "$facet" ibl missing.hdr --eval questions
exits 3 "a missing list" "$facet" ibl sky --eval missing
for bad in "radiance 0 1 0" "irradiance 0 0 0" "dfg 2 0.5" "dfg 0.5 nan" \
  "radiance 0 1 0 1.5" "light 0 1 0" "irradiance 0 1 0 1"; do
  printf 'dfg 0 0\n%s\n' "$bad" >bad
  exits 3 "'$bad' is refused" "$facet" ibl 1,1,1 --eval bad
  says "bad:2" "with its line"
done
printf x >file
exits 4 "a file in the folder's place" "$facet" ibl 1,1,1 -o file
finish

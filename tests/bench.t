#!/bin/sh
# facet bench: it measures what it says, in the files that others read.
. tests/tap.sh
cd "$T" || exit 1
write_obj a.obj
exits 0 "bench load" "$facet" bench load a.obj --repeat 3
ok "names every stage" sh -c 'for s in parse merge triangulate normals; do grep -q "$s .* MB/s" out || exit; done'
"$facet" bench load --json --repeat 2 a.obj >load.json
"$facet" bench rays --json --repeat 2 -j 1 a.obj --kind random >rays.json
# Rays down on the quad, past it, and on the triangle above; and the same for
# any hit.
python3 - <<'E'
import struct
rays = [(-.5, 5, .5, 0, 0, -1, 0, float("inf")), (3, 5, 0, 0, 0, -1, 0, 9.0), (0, .5, 9, 0, 0, 0, -1, float("inf")),
        (-.5, 5, .5, 0, 0, -1, 0, 4.0)]
for name, flags in ("closest", 0), ("any", 1):
    open(name + ".rays", "wb").write(b"RAYS" + struct.pack("<IQ", flags, len(rays)) +
                                     b"".join(struct.pack("<8f", *r) for r in rays))
E
for question in closest any; do
  exits 0 "rays from a file: $question" "$facet" bench rays a.obj --rays $question.rays --hits $question.hits --repeat 1
  "$facet" bench rays a.obj --rays $question.rays --hits brute.hits --repeat 1 --bvh brute >"$T/out"
  ok "the list finds the same" cmp $question.hits brute.hits
done
ok "their hits, and the numbers as JSON" python3 - <<'E'
import json, math, struct
def hits(name):
    d = open(name, "rb").read()
    magic, flags, n = struct.unpack("<4sIQ", d[:16])
    assert magic == b"HITS" and len(d) == 16 + 8 * n
    return flags, [struct.unpack("<fi", d[16 + 8 * i:24 + 8 * i]) for i in range(n)]
flags, closest = hits("closest.hits")
assert flags == 0
assert closest[0][0] == 5 and closest[0][1] in (0, 1)
assert closest[1] == (9, -1)
assert closest[2][1] == 2 and abs(closest[2][0] - 9) < 1e-5
assert closest[3] == (4, -1)
flags, any_hit = hits("any.hits")
assert flags == 1 and [p for _, p in any_hit] == [0, -1, 0, -1] and any_hit[1][0] == 9 and math.isinf(any_hit[0][0])
j = json.load(open("rays.json"))
assert j["kind"] == "random" and j["triangles"] == 3 and j["threads"] == 1 and 0 < j["hits"] < j["rays"]
assert j["mrays_per_second"] > 0 and j["sah_cost"] > 0 and j["bytes_per_triangle"] > 0 and j["build_seconds"] >= 0
j = json.load(open("load.json"))
assert set(j["seconds"]) == {"read_parse", "merge", "triangulate", "normals", "total"} == set(j["mb_per_second"])
assert j["triangles"] == 3 and j["bytes"] > 50
E
for kind in primary ao aod bounce; do
  ok "--kind $kind" "$facet" bench rays a.obj --kind $kind --repeat 1
done
exits 3 "a missing mesh" "$facet" bench rays missing.obj
exits 3 "a missing ray file" "$facet" bench rays a.obj --rays missing.rays
echo RAYS >short.rays
exits 3 "a short ray file" "$facet" bench rays a.obj --rays short.rays
exits 4 "hits that cannot be written" "$facet" bench rays a.obj --kind random --repeat 1 --hits missing/x.hits
exits 3 "bench load of nothing" "$facet" bench load missing.obj
finish

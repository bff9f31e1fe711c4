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
# Frames of two sizes: the table, and the same as JSON and CSV.
bench() { "$facet" bench raster a.obj -r 64x48,32x16 --frames 5 --repeat 2 "$@"; }
exits 0 "bench raster" bench
ok "a line for each size" sh -c 'grep -c "^64x48 \|^32x16 " out | grep -qx 2 && grep -q "5 frames" out'
bench --json --msaa 1 >raster.json
bench --csv >raster.csv
ok "frames, passes and who draws, for machines" python3 - <<'E'
import csv, json
j = json.load(open("raster.json"))
assert j["frames"] == 5 and j["triangles"] == 3 and j["msaa"] == 1 and j["gl"]["renderer"]
assert [(s["width"], s["height"]) for s in j["sizes"]] == [(64, 48), (32, 16)]
rows = list(csv.DictReader(open("raster.csv")))
assert [(r["width"], r["height"]) for r in rows] == [("64", "48"), ("32", "16")]
for s in j["sizes"] + rows:
    assert set(s) >= {"shadow_ms", "surface_ms", "sky_ms", "resolve_ms", "read_ms"}
    assert 0 < float(s["seconds"]) and abs(float(s["seconds"]) * 200 / float(s["ms_per_frame"]) - 1) < 1e-3
    assert float(s["shadow_ms"]) == 0 < float(s["read_ms"])
E
cat >lit.scene <<'E'
mesh a.obj
light point 0 3 0 intensity 20 20 20
E
"$facet" bench raster lit.scene --json -r 32x16 --frames 2 >shadow.json
"$facet" bench raster lit.scene --json -r 32x16 --frames 2 --shadows off >none.json
ok "a light has shadow maps, unless they are off" python3 -c '
import json
on, off = [json.load(open(f))["sizes"][0]["shadow_ms"] for f in ("shadow.json", "none.json")]
assert on > 0 == off, (on, off)'
exits 2 "no size" "$facet" bench raster a.obj -r 64x48,
exits 2 "half a size" "$facet" bench raster a.obj -r 64x48,32
exits 3 "bench raster of nothing" "$facet" bench raster missing.obj
for kind in primary ao aod bounce; do
  ok "--kind $kind" "$facet" bench rays a.obj --kind $kind --repeat 1
done
# Error: against a reference that is given, and one that facet makes.
"$facet" render a.obj --engine path -r 24x16 --spp 256 --seed 9 -q -o ref.pfm
error() { "$facet" bench error a.obj -r 24x16 --spp 4,16 "$@"; }
exits 0 "bench error" error --reference ref.pfm
ok "a line for raster and each number of samples" sh -c 'grep -c "^raster  *- \|^path  *4 \|^path  *16 " out | grep -qx 3'
error --reference ref.pfm --repeat 3 --seed 5 --methods naive --json -o e.png >error.json
error --repeat 2 --methods path,flat,adaptive --csv -o e.svg >error.csv
ok "numbers, runs and a plot, for machines" python3 - <<'E'
import csv, json, math, xml.dom.minidom
j = json.load(open("error.json"))
assert (j["width"], j["height"], j["repeat"]) == (24, 16, 3) and j["reference"]["file"] == "ref.pfm"
assert [(p["method"], p["spp"]) for p in j["points"]] == [("naive", 4), ("naive", 16)]
for p in j["points"]:
    runs = p["runs"]
    assert [r["seed"] for r in runs] == [5, 6, 7] and len({r["relmse"] for r in runs}) == 3
    assert math.isclose(p["relmse"], sum(r["relmse"] for r in runs) / 3, rel_tol=1e-9)
    assert math.isclose(p["error"] ** 2, p["relmse"], rel_tol=1e-9) and p["estimated_error"] > 0
    assert all(0 < r["seconds"]["render"] < r["seconds"]["total"] for r in runs)
assert j["points"][1]["relmse"] < j["points"][0]["relmse"]
rows = list(csv.DictReader(open("error.csv")))
assert [r["method"] for r in rows] == ["path"] * 4 + ["flat"] * 2 + ["adaptive"] * 4
assert rows[4]["estimated_error"] == "" and float(rows[0]["estimated_error"]) > 0
assert xml.dom.minidom.parse("e.svg").documentElement.getAttribute("width") == "640"
assert open("e.png", "rb").read(4) == b"\x89PNG"
E
"$facet" render a.obj --engine path --integrator naive -r 24x16 --spp 4 --seed 5 -q -o four.pfm
"$facet" compare four.pfm ref.pfm --metric relmse --fail 1e9 --json >four.json
ok "the same error as compare's" python3 -c '
import json
a, b = json.load(open("four.json"))["relmse"], json.load(open("error.json"))["points"][0]["runs"][0]["relmse"]
assert abs(a / b - 1) < 1e-6, (a, b)'
exits 2 "bench error: adaptive without path" error --methods adaptive
exits 2 "bench error: no samples" error --spp 4,
exits 2 "bench error: a plot that is no picture" error -o plot.txt
exits 2 "bench error: a reference of another size" "$facet" bench error a.obj -r 8x8 --spp 1 --reference ref.pfm
exits 3 "bench error: no reference" error --reference missing.pfm
exits 3 "bench error of nothing" "$facet" bench error missing.obj
exits 4 "bench error: a plot that cannot be written" error --reference ref.pfm --spp 1 -o missing/x.png
mkdir left
TMPDIR=$PWD/left error --reference ref.pfm --spp 1 >/dev/null
ok "nothing is left behind" rmdir left
exits 3 "a missing mesh" "$facet" bench rays missing.obj
exits 3 "a missing ray file" "$facet" bench rays a.obj --rays missing.rays
echo RAYS >short.rays
exits 3 "a short ray file" "$facet" bench rays a.obj --rays short.rays
exits 4 "hits that cannot be written" "$facet" bench rays a.obj --kind random --repeat 1 --hits missing/x.hits
exits 3 "bench load of nothing" "$facet" bench load missing.obj
finish

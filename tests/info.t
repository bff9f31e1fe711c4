#!/bin/sh
# facet info: counts, bounds, area and decisions, as JSON that any reader takes.
. tests/tap.sh
cd "$T" || exit 1
cat >b.mtl <<'E'
newmtl steel
Kd 0.5 0.5 0.5
Pr 0.25
Pm 1
newmtl window
illum 7
Ni 1.5
newmtl lamp
Kd 0 0 0
Ke 4 5 6
E
{
  printf 'mtllib b.mtl\no box\ng one\ng two\no caf\351\nusemtl steel\n'
  printf 'v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\n'
  printf 'vn 0 0 1\nvt 0 0\nf 1 2 3 4\nusemtl w\366lf\nf 1 2 5\n'
  printf 'usemtl \303\244pfel "rot"\nf 1 2 5\nusemtl window\nf 3 4 5\n'
  printf 'usemtl lamp\nf 1 4 5\nl 1 2\n'
} >b.obj
"$facet" info --json b.obj >b.json 2>"$T/err"
ok "the object is valid JSON in UTF-8, and right" python3 - <<'E'
import json
j = json.loads(open("b.json", "rb").read().decode("utf-8", "strict"))
for k, v in dict(positions=5, normals=1, texcoords=1, faces=5, triangles=6, objects=2, groups=2,
                 materials=5, lines=1).items():
    assert j[k] == v, (k, j[k])
assert j["bbox"] == [[0, 0, 0], [2, 2, 2]]
assert abs(j["area"] - (4 + 2 + 2 + 8 ** .5 + 2)) < 1e-6, j["area"]
assert j["triangles_by_material"] == {"steel": 2, "w\u00f6lf": 1, "\u00e4pfel \"rot\"": 1, "window": 1,
                                      "lamp": 1}, j["triangles_by_material"]
by = {d["name"]: d for d in j["decisions"]}
assert by["steel"]["rule"] == 2 and by["steel"]["roughness"] == .25 and by["steel"]["metallic"] == 1
assert by["window"]["rule"] == 3 and by["window"]["ni"] == 1.5
assert by["lamp"]["rule"] == 5 and by["lamp"]["ke"] == [4, 5, 6]
assert sum(d["triangles"] for d in j["decisions"]) == 6
assert isinstance(j["warnings"], list) and any("b.obj:" in w for w in j["warnings"]), j["warnings"]
E
exits 0 "for people" "$facet" info b.obj
says "warning: b.obj:" "with the warnings"
ok "and the decisions" grep -q "^material steel: 2 triangles" out
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl\nf 1 2 3\n' >c.obj
ok "triangles without a material, or a nameless one" sh -c "
  '$facet' info --json c.obj | grep -q '\"triangles_by_material\": {\"(none)\": 1, \"(empty)\": 1}'"
cat >s.scene <<'E'
mesh b.obj scale 2
camera left
eye -9 1 1
target 1 1 1
fov 35
light point 0 5 0 intensity 1 2 3
light dir 0 -1 0 irradiance 3 2 1
env constant 0.5 0.5 0.5
film 64 48
newmtl gold
Pr 0.1
assign gold material steel
E
"$facet" info --json s.scene >s.json 2>"$T/err"
ok "a scene: cameras, lights, environment, assignments" python3 - <<'E'
import json
j = json.load(open("s.json"))
assert j["bbox"] == [[0, 0, 0], [4, 4, 4]] and j["triangles"] == 6
assert [c["name"] for c in j["cameras"]] == ["left"] and j["cameras"][0]["fov"] == 35
assert [l["kind"] for l in j["lights"]] == ["point", "dir"] and j["lights"][0]["intensity"] == [1, 2, 3]
assert j["env"] == "constant" and j["film"] == [64, 48]
assert any(d["rule"] == 1 and d["triangles"] == 2 for d in j["decisions"]), j["decisions"]
E
exits 0 "--scene prints a scene" "$facet" info --scene s.scene
cp out again.scene
"$facet" render --engine path -q s.scene --spp 2 -r 32x24 -o one.pfm
"$facet" render --engine path -q again.scene --spp 2 -r 32x24 -o two.pfm
ok "that renders to the same picture" cmp one.pfm two.pfm
"$facet" info --json one.pfm b.obj one.pfm >lines 2>"$T/err"
ok "several files are JSON lines" python3 -c "
import json
assert len([json.loads(l) for l in open('lines')]) == 3"
exits 0 "a picture" "$facet" info one.pfm
ok "with its size and range" grep -q "^PFM, 32 x 24" out
printf 'PF\n2 1\n-1\n\0\0\200\177\0\0\0\0\0\0\0\0\0\0\200\77\0\0\0\0\0\0\0\0' >inf.pfm
ok "what is not finite is counted" sh -c "'$facet' info --json inf.pfm | grep -q '\"non_finite\": 1'"
exits 3 "neither" "$facet" info "$root/Makefile"
exits 3 "missing" "$facet" info missing.obj
exits 3 "one of several is missing" "$facet" info --json missing.obj b.obj
ok "the others are still told" grep -q '"positions": 5' out
: >empty.obj
"$facet" info --json empty.obj >"$T/out" 2>"$T/err"
case $? in 0|3) pass "an empty file" ;; *) fail "an empty file" ;; esac
exits 0 "standard input" sh -c "'$facet' info --json - <b.obj"
ok "is counted, too" grep -q '"faces": 5' out
finish

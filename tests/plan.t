#!/bin/sh
# The rules of the plan, by pairs of scenes: one that needs a stage, and one
# that does not.  Of the second the stage's own counter is 0 or no more than
# was needed, and with --no-skip, which does the stage all the same, the
# picture is the same bytes.  What that saves is printed.
. tests/tap.sh
cd "$T" || exit 1

# One material a file; a floor, something on it, and what stands aside.
cat >all.mtl <<'END'
newmtl matt
Kd 0.6 0.5 0.4
newmtl shiny
Kd 0 0 0
Ks 0.8 0.8 0.8
Ns 80
newmtl rough
Kd 0.7 0.6 0.2
Pr 0.4
Pm 1
newmtl looking
Ks 0.9 0.9 0.9
illum 5
newmtl clear
Ni 1.5
illum 7
map_Kd paint.tga
newmtl painted
Kd 1 1 1
map_Kd paint.tga
newmtl other
Kd 1 1 1
map_Kd other.tga
newmtl lace
Kd 0.8 0.8 0.8
d 0.5
newmtl lamp
Kd 0 0 0
Ke 5 5 5
END
python3 - <<'END'
import array, struct
for name, colour in (("paint", (40, 90, 200)), ("other", (200, 40, 90))):
    with open(name + ".tga", "wb") as f:
        f.write(struct.pack("<BBBHHBHHHHBB", 0, 0, 2, 0, 0, 0, 0, 0, 64, 64, 24, 0x20))
        for i in range(64 * 64):
            f.write(bytes(c if (i // 8 + i // 512) % 2 else 255 - c for c in colour))
with open("sky.pfm", "wb") as f:
    f.write(b"PF\n128 64\n-1.0\n")
    array.array("f", [0.2 + (i % 128 == 20) * (i // 128 == 50) * 900 for i in range(128 * 64) for _ in range(3)]).tofile(f)

def obj(name, parts, faces=""):
    """A floor of the first material, boxes of the others, all with vt and s 1."""
    v, f = [], []
    def box(lo, hi, material, of):
        n = len(v)
        f.append("o %s\nusemtl %s\ns 1" % (of, material))
        for i in range(8):
            v.append(tuple((hi if i >> k & 1 else lo)[k] for k in range(3)))
        for q in ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)):
            f.append("f " + " ".join("%d/%d" % (n + k + 1, i + 1) for i, k in enumerate(q)))
    box((-3, -0.2, -3), (3, 0, 3), parts[0], "floor")
    for i, m in enumerate(parts[1:]):
        box((-0.9 + i * 1.1, 0, -0.5), (-0.1 + i * 1.1, 0.9, 0.5), m, "box%d" % i)
    with open(name + ".obj", "w") as out:
        out.write("mtllib all.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n")
        out.write("".join("v %g %g %g\n" % p for p in v) + "\n".join(f) + "\n" + faces)

camera = "camera c\neye 1.5 2.5 6\ntarget 0 0.4 0\nfov 40\nfilm 64 48\n"
lamp = "light point 2 4 3 intensity 40 40 40\n"
def scene(name, mesh, what):
    with open(name + ".scene", "w") as out:
        out.write("mesh %s.obj\n" % mesh + camera + what)
obj("matt", ["matt", "matt"])
obj("kinds", ["matt", "rough", "looking", "clear"])
obj("paint", ["painted", "matt"])
obj("glass", ["clear", "looking"])
obj("rough", ["matt", "rough"])
obj("shiny", ["shiny", "shiny"])
obj("lace", ["matt", "lace"])
obj("glow", ["matt", "lamp"])
obj("edges", ["matt", "matt"], "".join("f 1/1 2/2 1/1\n" for _ in range(9)))
# Two painted things, of which one stands behind the camera.
obj("aside", ["matt", "painted"], "o far\nusemtl other\n" + "".join(
    "v %g %g %g\n" % p for p in ((20, 0, 30), (21, 0, 30), (21, 1, 30))) + "f 17/1 18/2 19/3\n")
for name, mesh, what in (
        ("night", "matt", "env none\n"), ("day", "matt", "env sky\n"), ("grey", "matt", "env constant 1 1 1\n"),
        ("lit", "matt", "env none\n" + lamp), ("map", "matt", "env sky.pfm\n"), ("black", "matt", "env sky.pfm scale 0\n" + lamp),
        ("out", "matt", "env constant 1 1 1\nlight point 2 4 3 intensity 0 0 0\n"),
        ("kinds", "kinds", "env sky\n"), ("paint", "paint", "env constant 1 1 1\n"),
        ("glass", "glass", "env sky\n" + lamp), ("rough", "rough", "env sky\n"), ("roughgrey", "rough", "env constant 1 1 1\n"),
        ("shiny", "shiny", "env none\n" + lamp), ("lace", "lace", "env none\n" + lamp), ("glow", "glow", "env none\n" + lamp),
        ("edges", "edges", "env constant 1 1 1\n"), ("aside", "aside", "env constant 1 1 1\n")):
    scene(name, mesh, what)
# A room with the camera in it.
with open("room.obj", "w") as out:
    out.write("mtllib all.mtl\nusemtl matt\n")
    for i in range(8):
        out.write("v %g %g %g\n" % tuple((9 if i >> k & 1 else -9) for k in range(3)))
    for q in ((1, 3, 7, 5), (2, 6, 8, 4), (1, 5, 6, 2), (3, 4, 8, 7), (1, 2, 4, 3), (5, 7, 8, 6)):
        out.write("f %d %d %d %d\n" % q)
scene("room", "room", "env sky.pfm\n")
scene("shut", "room", "env none\nlight point 2 4 3 intensity 40 40 40\n")
# A lamp that shines at a mirror.
with open("shown.obj", "w") as out:
    out.write("mtllib all.mtl\n")
    for i, (m, quad) in enumerate((
            ("matt", ((-3, 0, 3), (3, 0, 3), (3, 0, -3), (-3, 0, -3))),
            ("looking", ((-1, 0, 1), (-1, 0, -1), (-1, 2, -1), (-1, 2, 1))),
            ("lamp", ((0, 0.8, -0.1), (0, 0.8, 0.1), (0, 1, 0.1), (0, 1, -0.1))))):
        out.write("".join("v %g %g %g\n" % p for p in quad))
        out.write("usemtl %s\nf -4 -3 -2 -1\n" % m)
scene("shown", "shown", "env none\n")
END

# run NAME ARGUMENTS...: NAME.pfm and NAME.json
run() {
  name=$1
  shift
  "$facet" render -q "$@" --json -o "$name.pfm" >"$name.json" 2>"$name.err" ||
    { cat "$name.err"; return 1; }
}
# rule ENGINE STAGE LEFT -- NEED... -- SPARED...: a render that needs the stage,
# and one that does it LEFT times: a number, or "fewer" than all.
rule() {
  engine=$1 stage=$2 left=$3
  shift 4
  need=
  while [ "$1" != -- ]; do need="$need $1"; shift; done
  shift
  # shellcheck disable=SC2086
  ok "$engine, $stage" pair "$need" "$*"
  sed 's/^/# /' said
}
pair() {
  # shellcheck disable=SC2086
  run need --engine "$engine" $1 && run spared --engine "$engine" $2 &&
    run forced --engine "$engine" $2 --no-skip &&
    cmp spared.pfm forced.pfm && python3 judge.py "$stage" "$left"
}
cat >judge.py <<'END'
import json, sys
stage, left = sys.argv[1:]
runs = {name: json.load(open(name + ".json")) for name in ("need", "spared", "forced")}
line = {}
for name, run in runs.items():
    lines = {l["stage"]: l for l in run["plan"]}
    broken = [l for l in run["plan"] if not l["kept"]]
    assert not broken, (name, broken)
    line[name] = lines[stage]
need, spared, forced = (line[n] for n in ("need", "spared", "forced"))
assert need["did"] > 0, need
if left == "fewer":
    assert 0 < spared["did"] < spared["all"], spared
else:
    assert spared["did"] == int(left), spared
assert spared["verdict"] == ("skipped" if spared["did"] == 0 else "reduced" if spared["did"] < (spared["all"] or 1e18) else "done"), spared
total = [runs[n]["seconds"]["total"] for n in ("spared", "forced")]
def number(l, key):
    return l[key] or 0
print("%s: %s of %s, forced %s; %.4f s and %d bytes saved (all stages %.3f s)" % (
    spared["verdict"], spared["did"], spared["all"], forced["did"],
    number(forced, "seconds") - number(spared, "seconds"),
    number(forced, "bytes") - number(spared, "bytes"), total[1] - total[0]))
END

rule raster textures 0 -- paint.scene -- paint.scene --shading normal
rule raster textures 1 -- paint.scene -- aside.scene
rule path textures 0 -- paint.scene --spp 1 -- glass.scene --spp 1
rule raster "environment map" 0 -- map.scene -- black.scene
rule path "environment map" 0 -- map.scene --spp 1 -- map.scene --spp 1 --shading depth
rule path "texture coordinates" 0 -- paint.scene --spp 1 -- grey.scene --spp 4
rule path normals 0 -- grey.scene --spp 1 -- grey.scene --spp 2 --shading depth
rule raster triangles 24 -- grey.scene -- edges.scene
rule raster "draw list" fewer -- grey.scene -- aside.scene
rule raster programs 1 -- kinds.scene -- grey.scene
rule raster lamps 0 -- lit.scene -- out.scene
rule raster "shadow maps" 0 -- lit.scene -- glass.scene
rule raster "shadow maps" fewer -- lit.scene -- black.scene
rule raster sky 0 -- day.scene -- room.scene --eye 1,1,1 --target 0,0,0
rule raster "light from around" 0 -- day.scene -- glass.scene
rule raster "light from around" 0 -- day.scene -- grey.scene
rule raster "light from around" fewer -- rough.scene -- rough.scene --crop 0,0,20,20
rule raster "roughness table" 0 -- rough.scene -- day.scene
rule raster "leaning lobes" 0 -- rough.scene -- roughgrey.scene
rule raster resolve 0 -- paint.scene -- paint.scene --msaa 1
rule raster tree 0 -- day.scene --engine path --spp 1 -- day.scene
rule path "roughness table" 0 -- rough.scene --spp 1 -- day.scene --spp 2
rule path paths 0 -- lit.scene --spp 1 -- night.scene --spp 2
rule path lamps 0 -- lit.scene --spp 1 -- glass.scene --spp 2
rule path "sky directions" 0 -- map.scene --spp 1 -- grey.scene --spp 4
rule path "light samples" 0 -- lit.scene --spp 1 -- grey.scene --spp 4
rule path "shadow rays" fewer -- lit.scene --spp 1 -- shiny.scene --spp 4
rule path "aimed rays" 0 -- shown.scene --spp 1 -- glow.scene --spp 4
rule path "aimed rays" 0 -- shown.scene --spp 1 -- glass.scene --env 1,1,1 --spp 4
rule path "shared finds" 0 -- shut.scene --spp 1 -- shut.scene --max-depth 2 --spp 4
rule path "shared finds" 0 -- shut.scene --spp 1 -- day.scene --spp 4
# A lamp in the picture is no reason not to.
rule path "shared finds" 0 -- "$root/scenes/cornell.scene" --spp 1 -- day.scene --spp 4
rule path "alpha tests" 0 -- lace.scene --spp 4 -- lit.scene --spp 4
rule path segments 2 -- glow.scene --max-depth 3 --spp 1 -- lit.scene --max-depth 3 --spp 4
rule path segments 2 -- glow.scene --max-depth 3 --spp 1 -- lace.scene --max-depth 3 --spp 4
rule path segments 2 -- glow.scene --max-depth 3 --spp 1 -- lace.scene --max-depth 3 --spp 4 --integrator naive
rule path "other films" 0 -- lit.scene --spp 1 --aov normal,depth -- lit.scene --spp 4
rule raster "other films" 0 -- lit.scene --aov albedo -- lit.scene
rule path variance 0 -- lit.scene --spp 2 --aov variance -- lit.scene --spp 4
rule raster post 0 -- lit.scene --post frosted -- lit.scene

# Rays that are not traced.
run a --engine path lit.scene --max-depth 3 --spp 8
run b --engine path lit.scene --max-depth 3 --spp 8 --no-skip
ok "spared segments are fewer rays" python3 -c "
import json
a, b = (json.load(open(n + '.json'))['rays'] for n in 'ab')
assert a < 0.9 * b, (a, b)"
run a --engine path night.scene --spp 8
ok "no ray in the dark" grep -q '"rays": 0,' a.json

# Nobody hears of the error: no estimate, and a film without squares.
"$facet" render -q --explain --engine path lit.scene --spp 4 -o a.pfm 2>err
ok "error estimate: skipped with -q" grep -q '^error estimate *skipped' err
ok "variance: skipped with it" grep -q '^variance *skipped' err
"$facet" render --explain --engine path lit.scene --spp 4 -o b.pfm 2>err
ok "done when somebody does" grep -q '^error estimate *done' err
ok "and the picture does not know" cmp a.pfm b.pfm

# Of a picture that is gone on with, it counts what this run did, and says so.
"$facet" render -q --engine path lit.scene --spp 2 --checkpoint c.part -o c.pfm
"$facet" render --explain --engine path lit.scene --spp 6 --checkpoint c.part --resume \
  --json -o c.pfm >c.json 2>err
ok "after --resume: this run's counts" python3 -c "
import json
run = json.load(open('c.json'))
paths = [l for l in run['plan'] if l['stage'] == 'paths'][0]
assert (paths['did'], paths['all']) == (4 * 3072, 4 * 3072), paths
assert (run['checkpoint']['before'], run['samples']) == (2 * 3072, 6 * 3072)"
ok "of how many samples before, is said" grep -qx \
  'counts are of this run, which went on from 6144 samples' err

# A crop is its own pixels, and for paths those of the whole picture.
run whole --engine path lit.scene --spp 2
run crop --engine path lit.scene --spp 2 --crop 10,5,30,25
ok "a crop: 400 of 3072 pixels, the same as in the whole" python3 - <<'END'
import array, json
def pfm(name):
    f = open(name, "rb")
    f.readline(); w, h = map(int, f.readline().split()); f.readline()
    return w, h, array.array("f", f.read())
lines = {l["stage"]: l for l in json.load(open("crop.json"))["plan"]}
assert (lines["pixels"]["did"], lines["pixels"]["all"]) == (400, 3072)
assert lines["paths"]["did"] == 800
w, h, whole = pfm("whole.pfm")
cw, ch, crop = pfm("crop.pfm")
rows = [whole[3 * (w * (h - 25 + y) + 10):][:60] for y in range(20)]
assert b"".join(r.tobytes() for r in rows) == crop.tobytes()
END

# What is not decoded is still checked; what is, is found damaged.
cp all.mtl good.mtl
sed -i 's/other.tga/nowhere.tga/' all.mtl
exits 0 "a missing texture out of view" "$facet" render aside.scene -o a.png
says "nowhere.tga" "is a warning, looked at or not"
cp good.mtl all.mtl
head -c 100 paint.tga >cut && mv cut paint.tga
exits 0 "a texture cut short that glass does not look at" "$facet" render glass.scene -r 32x24 -o a.png --strict
exits 1 "and one that is looked at" "$facet" render paint.scene -r 32x24 -o a.png --strict
says "paint.tga" "is a warning"
exits 1 "or with --no-skip" "$facet" render glass.scene -r 32x24 -o a.png --strict --no-skip

# info has the plan without rendering, and no counts.
exits 0 "info" "$facet" info kinds.scene
ok "the plan of both engines" sh -c "grep -c '^plan of the' out | grep -qx 2"
exits 0 "info --json" "$facet" info --json kinds.scene
ok "the plan in it" python3 -c "
import json
p = json.load(open('out'))['plan']
assert {l['stage']: l['need'] for l in p['raster']}['programs'] == 4
assert all('did' not in l for e in p.values() for l in e) and len(p['path']) > 15"
finish

#!/bin/sh
# facet render from end to end: what it writes, and what it does to the files,
# the clock and the signals around it.
. tests/tap.sh
cd "$T" || exit 1
write_obj a.obj
# Paths, whose numbers can be told in advance; raster.t has the other engine.
path="--engine path"
render() { "$facet" render -q $path -r 48x32 --spp 4 "$@"; }

exits 0 "no option at all" "$facet" render a.obj
"$facet" info --json a.png >"$T/out"
ok "a.png in this folder, 1280x720, 8 bit" \
  grep -q '"PNG", "width": 1280, "height": 720, "channels": 3, "depth": 8' out

# The same bytes, whatever the threads, the passes and the tree.
render a.obj -j 1 -o j1.pfm
for j in 2 7; do
  render a.obj -j $j -o "j$j.pfm"
  ok "-j $j: the bytes of -j 1" cmp j1.pfm "j$j.pfm"
done
render a.obj --bvh brute -o brute.pfm
ok "the list finds what the tree finds" cmp j1.pfm brute.pfm
render - -o stdin.pfm <a.obj
ok "an OBJ on standard input" cmp j1.pfm stdin.pfm
render a.obj --format pfm -o - >stdout.pfm
ok "a picture on standard output" cmp j1.pfm stdout.pfm
render a.obj --seed 1 -o seed.pfm
exits 1 "another seed, another picture" cmp -s j1.pfm seed.pfm

# The crop of a picture is a part of it.
render a.obj --crop 5,7,29,20 -o crop.pfm
ok "a crop is a part of the picture" python3 - <<'E'
def pfm(path):
    f = open(path, "rb")
    assert f.readline() == b"PF\n"
    w, h = map(int, f.readline().split())
    assert float(f.readline()) < 0
    rows = [f.read(12 * w) for _ in range(h)]
    return w, h, rows[::-1]
w, h, full = pfm("j1.pfm")
cw, ch, crop = pfm("crop.pfm")
assert (w, h, cw, ch) == (48, 32, 24, 13)
assert crop == [row[12 * 5:12 * 29] for row in full[7:20]]
E

# Formats say the same.
render a.obj -o f8.png
render a.obj --depth 16 -o f16.png
render a.obj -o f.hdr
ok "16 bits" sh -c "'$facet' info --json f16.png | grep -q '\"depth\": 16'"
ok "8 and 16 bits differ by rounding" "$facet" compare --metric max --fail 0.001962 f8.png f16.png
render a.obj --env 0.5,0.5,0.5 --depth 16 -o dim.png
render a.obj --env 0.5,0.5,0.5 -o dim.pfm
ok "PNG is the sRGB code of the PFM" "$facet" compare --metric max --fail 2e-5 dim.png dim.pfm
ok "HDR rounds to 8 bits of the largest" "$facet" compare --metric relmse --fail 1e-5 f.hdr j1.pfm
render a.obj --format hdr -o odd.name
ok "--format decides, not the suffix" cmp odd.name f.hdr

# Exposure and curves are for pictures that screens show.
render a.obj --env 0.25,0.25,0.25 --exposure 1 -o exposed.png
render a.obj --env 0.5,0.5,0.5 -o brighter.png
ok "one stop is a factor of two" cmp exposed.png brighter.png
"$facet" render $path -r 48x32 --spp 4 a.obj --exposure 1 -o exposed.pfm 2>"$T/err"
says "--exposure has no effect" "a PFM keeps radiance, and that is said"
ok "it does" cmp exposed.pfm j1.pfm
white() { # CURVE CODE: of radiance 1
  render a.obj --env 1,1,1 --eye 0,50,0 --target 0,60,0 --up 1,0,0 --tonemap "$1" -o t.png
  python3 -c "
import json, subprocess
i = json.loads(subprocess.check_output(['$facet', 'info', '--json', 't.png']))
assert i['min'] == i['max'] and round(255 * i['max'][0]) == $2, i"
}
# sRGB codes of 1, 1 / 2 and 2.54 / 3.16.
ok "no curve: white is white" white none 255
ok "Reinhard: radiance 1 becomes 1/2" white reinhard 188
ok "ACES: radiance 1 becomes 0.804" white aces 232

# Beside the picture.
render a.obj --aov normal,depth,albedo,variance,samples -o aov.png
for kind in normal depth albedo variance samples; do
  ok "--aov $kind" test -s aov.$kind.pfm
done
ok "every pixel has its samples" sh -c "'$facet' info aov.samples.pfm | grep -qx 'min  4 4 4' &&
  '$facet' info aov.samples.pfm | grep -qx 'max  4 4 4'"
for shading in blinn-phong pbr normal depth albedo; do
  ok "--shading $shading" render a.obj --shading $shading -o "s-$shading.pfm"
done
ok "the albedo is Kd" sh -c "'$facet' info s-albedo.pfm | grep -qx 'max  0.8 0.8 0.8'"

# A z-test sees no difference between seeds, and one between skies.
"$facet" render $path -q a.obj -r 48x32 --spp 64 --aov variance -o z0.pfm
"$facet" render $path -q a.obj -r 48x32 --spp 64 --aov variance --seed 1 -o z1.pfm
"$facet" render $path -q a.obj -r 48x32 --spp 64 --aov variance --env-scale 1.1 -o z2.pfm
exits 0 "z-test: another seed is equal" "$facet" compare z1.pfm z0.pfm --z-test z0.variance.pfm
exits 1 "z-test: another sky is not" "$facet" compare z2.pfm z0.pfm --z-test z0.variance.pfm

# The scene file, and flags over it.
cat >a.scene <<'E'
film 20 10
camera top
eye 0 6 0.01
target 0 0 0
camera side
eye 0 1 6
target 0 0 0
fov 30
light point 0 3 0 intensity 20 20 20
env constant 0.1 0.1 0.1
E
small() { "$facet" render -q $path --spp 4 "$@"; }
small a.obj -o top.pfm
small a.scene -o top2.pfm
small a.obj --camera side -o side.pfm
small a.obj --camera top --eye 0,1,6 --fov 30 -o side2.pfm
small a.obj --lights off -o dark.pfm
small a.obj -r 24x12 -o big.pfm
ok "an OBJ brings its scene file" cmp top.pfm top2.pfm
ok "film gives the size" sh -c "'$facet' info top.pfm | grep -q '20 x 10'"
ok "a flag comes before film" sh -c "'$facet' info big.pfm | grep -q '24 x 12'"
exits 1 "--camera chooses" cmp -s top.pfm side.pfm
ok "flags move a camera" cmp side.pfm side2.pfm
exits 1 "--lights off" cmp -s top.pfm dark.pfm
exits 2 "a misspelt camera" "$facet" render a.obj --camera sied
says "the nearest is side" "and the nearest"
rm a.scene

# JSON at the end.
render a.obj --json -o j.png >j.json
ok "--json" python3 - <<'E'
import json
j = json.load(open("j.json"))
assert j["triangles"] == 3 and j["spp"] == 4 and j["samples"] == 4 * 48 * 32
assert (j["width"], j["height"]) == (48, 32) and j["rays"] >= j["samples"]
assert j["warnings"] == [] and j["non_finite"] == 0 and j["seed"] == 0
assert j["bvh"]["nodes"] >= 1 and j["bvh"]["dropped"] == 0
s = j["seconds"]
assert set(s) >= {"total", "render", "load", "build", "textures", "write"}
assert s["total"] >= s["render"] + s["write"] and j["peak_bytes"] > 1e6
assert 0 < j["error"] < 1 and j["materials"] >= 1 and j["threads"] >= 1
E

# Stop rules.
ok "--time ends in time" sh -c "
  '$facet' render -q $path a.obj -r 64x40 --time 1 --json -o time.png | python3 -c '
import json, sys
j = json.load(sys.stdin)
assert 0.3 < j[\"seconds\"][\"total\"] < 1.3 and j[\"spp\"] > 1, j'"
ok "--error ends when it is small" sh -c "
  '$facet' render -q $path a.obj -r 48x32 --error 0.05 --json -o error.png | python3 -c '
import json, sys
j = json.load(sys.stdin)
assert 0 < j[\"error\"] <= 0.05 and j[\"spp\"] >= 4, j'"

for threads in 1 2 7; do
  "$facet" render -q $path a.obj -r 40x24 --error 0.005 -j $threads --aov samples -o e$threads.pfm \
    --json | grep -o '"error": [^}]*}' >e$threads.told
done
ok "--error: the same bytes for any threads" sh -c "cmp e1.pfm e2.pfm && cmp e1.pfm e7.pfm"
ok "and told the same of the error and its jury" sh -c "
  grep -q jury e1.told && cmp e1.told e2.told && cmp e1.told e7.told"
"$facet" render -q $path a.obj -r 40x24 --error 0.005 --json -o e1.pfm >e.json
ok "samples go where they are needed, and are counted" python3 - <<'E'
import array, json
data = open("e1.samples.pfm", "rb").read().split(b"\n", 3)[3]
counts = array.array("f", data)[::3]
j = json.load(open("e.json"))
assert sum(counts) == j["samples"] and min(counts) >= 16 and max(counts) > 1.2 * min(counts), (min(counts), max(counts))
assert abs(j["spp"] - sum(counts) / len(counts)) <= 0.5
E
exits 0 "--spp limits --error" "$facet" render -q $path a.obj -r 40x24 --error 1e-9 --spp 20 --json -o e.pfm
ok "and on average it is kept" python3 -c 'import json; assert 18 <= json.load(open("'"$T/out"'"))["spp"] <= 21'

# Warnings.
{ echo "mtllib nowhere.mtl"; cat a.obj; } >w.obj
exits 0 "a missing library is a warning" "$facet" render $path w.obj -r 8x8 --spp 1
says "warning: w.obj:" "with its place"
says "nowhere.mtl" "and what was looked for"
says "1 warning" "and counted"
rm -f w.png
exits 1 "--strict makes it an error" "$facet" render $path w.obj -r 8x8 --spp 1 --strict
exits 1 "and nothing is written" test -e w.png
printf 'v 0 0 0\nv 1 0 0\n' >none.obj
exits 3 "an OBJ without faces" "$facet" render none.obj

# What is there stays there.
echo old >old.png
exits 4 "a full device" "$facet" render $path a.obj -q -r 320x200 --spp 1 --format pfm -o /dev/full
exits 4 "a file that cannot grow" sh -c "trap '' XFSZ; ulimit -f 8
  exec '$facet' render $path a.obj -q -r 320x200 --spp 1 -o old.png"
ok "the old file is whole" grep -qx old old.png
ok "and no other is left" sh -c '! ls -A | grep -q "tmp\|old.png."'
exits 3 "a malformed input" "$facet" render missing.obj -o old.png
ok "leaves the old file" grep -qx old old.png
if [ "$(id -u)" != 0 ]; then
  mkdir closed && chmod a-w closed
  exits 4 "a folder that is closed" "$facet" render a.obj -o closed/x.png
else skip "a folder that is closed" "root writes everywhere"; fi
cp j1.pfm e.pfm
ln e.pfm link.pfm
exits 2 "the environment as output" "$facet" render a.obj --env e.pfm -o e.pfm
exits 2 "also by another name" "$facet" render a.obj --env e.pfm -o link.pfm
exits 2 "the OBJ as output" "$facet" render a.obj --format png -o ./a.obj
ok "all of them unharmed" sh -c 'cmp e.pfm j1.pfm && grep -q "^f 4 3 2 1" a.obj'
# shellcheck disable=SC2086
out_of_memory 500000 "no memory" "$facet" render $path a.obj -j 1 -r 40000x40000

# Signals.  env gives back the SIGINT that a shell takes from what runs with &.
start() { env --default-signal=INT "$facet" render $path a.obj -q "$@" 2>"$T/err" & pid=$!; }
for signal in INT TERM; do
  start -r 160x100 --time 20 -o $signal.png
  renders $pid
  kill -$signal $pid
  wait $pid
  code=$?
  if [ $code = 75 ] && "$facet" info $signal.png >"$T/out"
  then pass "SIG$signal: the picture so far, exit 75"
  else fail "SIG$signal: exit $code"; fi
done
start -r 3000x3000 --time 20 -o twice.png
renders $pid
stop_twice $pid
wait $pid
code=$?
if [ $code = 143 ] && [ ! -e twice.png ]; then pass "a second signal ends it at once"
else fail "a second signal: exit $code"; fi
start -r 160x100 --time 20 -o usr1.png
renders $pid
kill -USR1 $pid
for _ in $(seq 50); do [ -e usr1.png ] || sleep 0.3; done
if [ -e usr1.png ] && kill -0 $pid; then pass "SIGUSR1: the picture so far, and on it goes"
else fail "SIGUSR1"; fi
kill -TERM $pid
wait $pid
finish

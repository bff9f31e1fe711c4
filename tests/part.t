#!/bin/sh
# A picture by many runs: killed, stopped, cut up and put together, it is the
# picture of one run, byte for byte; and whatever fails leaves what was there.
. tests/tap.sh
cd "$T" || exit 1

# A scene with a file of every kind.
cat >a.obj <<'E'
mtllib a.mtl
v -1 0 -1
v 1 0 -1
v 1 0 1
v -1 0 1
v 0 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
usemtl floor
f 4/4 3/3 2/2 1/1
usemtl fin
f 1 3 5
E
cat >a.mtl <<'E'
newmtl floor
Kd 0.5 0.6 0.7
map_Kd a.pfm
newmtl fin
Kd 0.7 0.5 0.3
Pr 0.3
E
cat >a.scene <<'E'
film 72 40
camera front
eye 2 2 4
target 0 0.4 0
fov 40
env sky.pfm
light point 1 3 1 intensity 12 11 10
exposure 0.5
E
python3 - <<'E'
import array
def pfm(path, w, h, f):
    data = array.array("f", [f(x, y, c) for y in range(h) for x in range(w) for c in range(3)])
    open(path, "wb").write(b"PF\n%d %d\n-1.0\n" % (w, h) + data.tobytes())
pfm("a.pfm", 4, 4, lambda x, y, c: 0.2 + 0.6 * ((x + y) % 2))
pfm("sky.pfm", 16, 8, lambda x, y, c: 0.2 + (9 if (x, y) == (4, 6) else 0.05 * (x + c)))
E
render() { "$facet" render a.scene --engine path -q "$@"; }
merge() { "$facet" merge -q "$@"; }
no_litter() { ! ls -A "${1:-.}" | grep -q '[.]tmp$'; }
# ends PID CODE NAME: the process has ended with that status.
ends() {
  wait "$1" 2>/dev/null
  code=$?
  if [ $code = "$2" ]; then pass "$3"; else fail "$3 (exit $code, not $2)"; fi
}

# Cut up and put together.
all="--spp 9 --aov normal,depth,albedo,variance,samples"
# shellcheck disable=SC2086
render $all -o one.png && render $all -o one.pfm
# shellcheck disable=SC2086
for shards in 1 2 3 8; do
  rm -f s?.part
  for i in $(seq $shards); do render $all -j $((1 + i % 3)) --shard $i/$shards -o s$i.part; done
  merge s?.part -o m.png && merge s?.part -o m.pfm
  differ=
  for f in png pfm normal.pfm depth.pfm albedo.pfm variance.pfm samples.pfm; do
    cmp -s one.$f m.$f || differ="$differ $f"
  done
  if [ -z "$differ" ]; then pass "$shards shards merged: the bytes of one run, with all AOVs"
  else fail "$shards shards merged: other bytes in$differ"; fi
done
develop="--exposure -1 --tonemap aces --depth 16 --post frosted=3"
# shellcheck disable=SC2086
render --spp 9 $develop --crop 9,5,70,37 -o one.png
for i in 0 1 2; do render --spp 9 --crop 9,5,70,37 --shard $i/3 -o s$i.part; done
# shellcheck disable=SC2086
merge s0.part s1.part s2.part $develop -o m.png
ok "exposure, curve, depth and glass are the merge's" cmp one.png m.png
render --spp 3 --shading depth -o one.png
for i in 1 2; do render --spp 3 --shading depth --shard $i/2 -o s$i.part; done
merge s1.part s2.part -o m.png
ok "depths have no exposure, merged or not" cmp one.png m.png
render --error 0.05 -o one.png
render --error 0.05 -o e.part
merge e.part -o m.png
ok "a picture in two halves, as a part" cmp one.png m.png
render --spp 1 --shard 2/5
ok "the name of a shard that has none" test -e a.2-of-5.part

# One shard is killed, one comes twice, and one was stopped.
render --spp 64 -o one.pfm
for i in 1 3; do render --spp 64 --shard $i/3 -o t$i.part; done
"$facet" render a.scene --engine path -q --spp 9000000 --shard 2/3 -o t2.part &
sleep 0.5
kill -9 $!
ends $! 137 "a shard is killed"
exits 3 "and has left nothing" merge t1.part t2.part t3.part -o late.pfm
exits 1 "a killed shard is a hole" merge t1.part t3.part -o late.pfm
says "of shard 2/3 are missing" "which is named"
exits 1 "another shard twice does not fill it" merge t1.part t3.part t1.part -o late.pfm
says "t1.part: 5 of its 5 tiles are in t1.part, too" "and is named, too"
says "of shard 2/3 are missing" "with the hole"
"$facet" render a.scene --engine path -q --spp 9000000 --shard 2/3 -o t2.part &
renders $!
kill -TERM $!
ends $! 75 "a stopped shard exits with 75"
ok "and leaves what it has" test -s t2.part
exits 1 "which was to have more samples" merge t1.part t2.part t3.part -o late.pfm
says "its spp is 9000000, not 64" "says why"
"$facet" render a.scene --engine path -q --spp 64 --shard 2/3 --checkpoint c2.part --every 0.01 -o t2.part &
sleep 0.2
kill -9 $! 2>/dev/null
wait $! 2>/dev/null
exits 0 "sent again, it goes on" render --spp 64 --shard 2/3 --checkpoint c2.part --resume -o t2.part
exits 0 "and nothing is missing" merge t3.part t2.part t1.part -o late.pfm
ok "the picture is that of a single run" cmp one.pfm late.pfm
"$facet" info --json t2.part >"$T/out"
ok "info says of what it is a part" python3 -c '
import json
j = json.load(open("out"))
assert (j["shard"], j["shards"], j["spp"], j["complete"], j["tiles"], j["samples_a_pixel"]) == (2, 3, 64, True, 5, 64), j
assert j["window"] == [0, 0, 72, 40] and j["key"]["seed"] == "0" and j["key"]["film"] == "72x40"'
exits 3 "shard 1 cannot go on from shard 2" render --spp 64 --shard 1/3 --checkpoint c2.part --resume -o x.part
says "it is shard 2/3, not 1/3" "says why"
exits 2 "a part is not written over" merge t1.part t2.part t3.part -o t1.part

# Killed at twenty moments.
run() { "$facet" render a.scene --engine path -q --spp 700 "$@"; }
run -o one.png
start=$(date +%s%N)
run --checkpoint k.part --every 0.02 -o k.png
took=$((($(date +%s%N) - start) / 1000000))
awk -v t="$took" 'BEGIN { srand(16); for (i = 0; i < 20; i++) printf "%.3f\n", rand() * 0.8 * t / 1000 }' >moments
same=0 killed=0 resumed=0 litter=0
while read -r moment; do
  code=0
  # A run that was over before its moment, as others made room, is killed sooner.
  while [ $code != 137 ] && [ "$moment" != 0.000 ]; do
    rm -f k.part k.png
    "$facet" render a.scene --engine path -q --spp 700 --checkpoint k.part --every 0.02 -o k.png &
    sleep "$moment"
    kill -9 $! 2>/dev/null
    wait $! 2>/dev/null
    code=$?
    moment=$(awk -v t="$moment" 'BEGIN { printf "%.3f", t / 2 }')
  done
  [ $code = 137 ] && killed=$((killed + 1))
  no_litter || litter=$((litter + 1))
  [ -e k.part ] && resumed=$((resumed + 1))
  run --checkpoint k.part --resume -o k.png
  cmp -s k.png one.png && same=$((same + 1))
done <moments
echo "# $killed of 20 killed in time, $resumed had a checkpoint, $litter left a temporary file"
ok "20 times killed and resumed: the same bytes" test $same = 20
ok "most of them in the middle" test $killed -ge 12 -a $resumed -ge 5
ok "the next run sweeps up" no_litter
touch .k.part.$$-0.tmp .k.part.99999999-0.tmp .k.part.99999999-0x.tmp
run --checkpoint k.part --resume -o k.png
ok "but takes nothing of the living" sh -c "
  [ -e .k.part.$$-0.tmp ] && [ ! -e .k.part.99999999-0.tmp ] && [ -e .k.part.99999999-0x.tmp ]"
rm -f .k.part.*

# Three kills in a row, of a picture whose samples go where they help.
adaptive() { "$facet" render a.scene --engine path -q --error 0.008 --aov samples "$@"; }
adaptive --json -o one.pfm >one.json
for moment in 0.3 0.5 0.7; do
  "$facet" render a.scene --engine path -q --error 0.008 --checkpoint h.part --every 0.02 --resume \
    --aov samples -o e.pfm &
  sleep $moment
  kill -9 $! 2>/dev/null
  wait $! 2>/dev/null
done
adaptive --checkpoint h.part --resume --json -o e.pfm >e.json
ok "--error, three times killed: the same bytes" cmp e.pfm one.pfm
ok "and the same samples everywhere" cmp e.samples.pfm one.samples.pfm
ok "and told the same of the error, by a jury that was not kept" python3 -c '
import json
a, b = json.load(open("one.json")), json.load(open("e.json"))
assert a["error"] == b["error"] and a["jury"]["samples"] >= b["jury"]["samples"] > 0, (a["error"], a["jury"], b["error"], b["jury"])'

# More samples.
render --spp 40 -o one.png --json >one.json
render --spp 7 --checkpoint m.part -o m.png
render --spp 40 --checkpoint m.part --resume -o m.png --json >m.json
ok "7 samples are the beginning of 40" cmp one.png m.png
ok "counts and error are those of one run" python3 -c '
import json
a, b = json.load(open("one.json")), json.load(open("m.json"))
for k in "rays", "samples", "spp", "error", "non_finite": assert a[k] == b[k] and a[k] is not None, k
assert b["checkpoint"]["resumed"] and b["checkpoint"]["writes"] >= 1'
exits 2 "40 are not the beginning of 39" render --spp 39 --checkpoint m.part --resume -o m.png
says "has 40 samples a pixel already" "says why"
for i in 1 2; do render --spp 7 --shard $i/2 -o s$i.part; done
merge s1.part s2.part -o whole.part
render --spp 40 --checkpoint whole.part --resume -o m.png
ok "they need not be of one run" cmp one.png m.png

# What is of another picture.
mkdir here && mv a.obj a.mtl a.scene a.pfm sky.pfm here && cd here || exit 1
render --spp 2 --checkpoint o.part -o o.png
# other NAME COMMAND SAID [OPTION]: after that command in a copy of the scene,
# resume refuses, and says so.
other() {
  rm -rf ../there && cp -r ../here ../there && rm -f ../there/o.png
  # shellcheck disable=SC2086
  (cd ../there && eval "$2" && render --spp 3 --checkpoint o.part --resume $4 -o x.png) >"$T/out" 2>"$T/err"
  code=$?
  if [ $code = 3 ] && grep -q "of another picture: its $3" "$T/err" && [ ! -e ../there/x.png ]
  then pass "$1"; else fail "$1: exit $code"; fi
}
other "one digit of the OBJ" "sed -i 's/^v 0 1 0/v 0 1 0.0001/' a.obj" geometry
other "one digit of the MTL" "sed -i 's/0.7 0.5 0.3/0.7 0.5 0.31/' a.mtl" materials
other "one digit of the scene" "sed -i 's/intensity 12/intensity 13/' a.scene" lamps
other "another camera" "sed -i 's/eye 2/eye 2.001/' a.scene" camera
other "one byte of a texture" "printf '\\001' | dd of=a.pfm bs=1 seek=40 conv=notrunc 2>/dev/null" textures
other "one byte of the sky" "printf '\\001' | dd of=sky.pfm bs=1 seek=40 conv=notrunc 2>/dev/null" environment
for words in "seed 3" "max-depth 4" "sampler random" "integrator naive" "integrator mis" "lights off" "pbr-model report" \
  "shading albedo" "aov normal"; do
  other "--$words" : "${words%% *} is" "--$words"
done
other "another size" : film "-r 71x40"
other "a crop" : window "--crop 0,0,16,16"
other "--error" : "halves is no, not yes" "--error 0.1"
echo "# a comment" >>a.mtl
exits 0 "a comment may change" render --spp 3 --checkpoint o.part --resume -o o.png
ok "the format is as described, and of one version" python3 - "$facet" <<'E'
import array, struct, subprocess, sys
M = (1 << 64) - 1
def digest(data, d=0x66616365742e3136):
    for i in range(0, len(data), 8):
        d = (d ^ int.from_bytes(data[i:i + 8], "little")) * 0x9e3779b97f4a7c15 & M
        d ^= d >> 29
    d = (d ^ len(data)) * 0x9e3779b97f4a7c15 & M
    return d ^ d >> 29
data = open("o.part", "rb").read()
assert data[:8] == b"FACETPRT"
form, w, h, x0, y0, x1, y1, shard, shards, spp, complete, films, aovs, radiance, length = struct.unpack_from("<15I", data, 8)
assert (form, w, h, x1, y1, shard, shards, spp, complete, films) == (2, 72, 40, 72, 40, 0, 1, 3, 1, 1 | 64)
*counts, tiles = struct.unpack_from("<7Q", data, 72)
assert counts[2] == 3 * w * h and tiles == 5 * 3
key = data[128:128 + length]
assert key.startswith(b"version ")
assert struct.unpack_from("<Q", data, 128 + length)[0] == digest(data[:128 + length])
at = 128 + length + 8
table = data[at:at + 52 * tiles]
assert struct.unpack_from("<Q", data, at + 52 * tiles)[0] == digest(table)
at += 52 * tiles + 8
subprocess.check_call([sys.argv[1], "merge", "-q", "o.part", "-o", "o.pfm"])
floats = array.array("f", open("o.pfm", "rb").read().split(b"\n", 3)[3])
for t in range(tiles):
    number, taken, _, _, _, _, _, _, seal = struct.unpack_from("<5IQ2dQ", table, 52 * t)
    left, top = number % 5 * 16, number // 5 * 16
    across, down = min(16, w - left), min(16, h - top)
    assert number == t and taken == 3 and seal == digest(data[at:at + across * down * 76])
    for i in range(across * down):
        v = struct.unpack_from("<6dI", data, at + 52 * i)
        x, y = left + i % across, top + i // across
        for c in range(3):
            assert floats[3 * ((h - 1 - y) * w + x) + c] == struct.unpack("f", struct.pack("f", v[c] / v[6]))[0]
    at += across * down * 76
assert at == len(data)
old = key.replace(b"version ", b"version 9.9.", 1)[:length]
head = data[:128] + old
open("old.part", "wb").write(head + struct.pack("<Q", digest(head)) + data[128 + length + 8:])
r = subprocess.run([sys.argv[1], "render", "a.scene", "--engine", "path", "--spp", "3", "--checkpoint", "old.part", "--resume"], stderr=subprocess.PIPE)
assert r.returncode == 3 and b"its version is 9.9." in r.stderr, r
E

# Signals.  env gives back the SIGINT that a shell takes from what runs with &.
start() { env --default-signal=INT "$facet" render a.scene --engine path -q --spp 9000000 "$@" 2>"$T/err" & pid=$!; }
for signal in INT TERM; do
  rm -f c.part
  start --checkpoint c.part -o $signal.png
  renders $pid
  kill -$signal $pid
  ends $pid 75 "SIG$signal: exit 75"
  ok "with a checkpoint instead of a picture" test -s c.part -a ! -e $signal.png
done
exits 1 "that is no picture yet" merge c.part -o x.png
says "c.part: is not finished" "says why"
cp c.part before.part
start --checkpoint c.part --resume -o x.png
renders $pid
kill -USR1 $pid
for _ in $(seq 50); do [ -e x.png ] || sleep 0.3; done
ok "SIGUSR1: the picture so far" test -s x.png
kill -9 $pid
ends $pid 137 "and on it went"
ok "with the checkpoint of before, until another is due" cmp c.part before.part
start -r 3000x2000 --checkpoint twice.part -o twice.png
renders $pid
stop_twice $pid
ends $pid 143 "a second signal ends it at once"
ok "with neither picture nor checkpoint" test ! -e twice.png -a ! -e twice.part
rm -f .twice.part*

# What cannot be written.
echo old >old.png
render --spp 2 --checkpoint c.part -o c.png
cp c.part before.part
exits 4 "a checkpoint that cannot grow" sh -c "trap '' XFSZ; ulimit -f 80
  exec '$facet' render a.scene --engine path -q --spp 30 --checkpoint c.part --every 0.01 -o d.png"
ok "the old one is whole" cmp c.part before.part
ok "the picture is written nevertheless" test -s d.png
ok "and nothing else is left" no_litter
exits 4 "a part that cannot grow" sh -c "trap '' XFSZ; ulimit -f 80
  exec '$facet' render a.scene --engine path -q --spp 2 -o c.part"
exits 4 "a picture that cannot grow" sh -c "trap '' XFSZ; ulimit -f 1
  exec '$facet' merge -q before.part --format pfm -o old.png"
exits 4 "a full device for a part" render --spp 2 --format part -o /dev/full
exits 4 "for a merged picture" merge before.part --format png -o /dev/full
exits 4 "for the checkpoint" render --spp 2 --checkpoint /dev/full -o e.png
exits 4 "a closed pipe" sh -c "{ sleep 0.3; '$facet' merge -q before.part --format pfm -o - 2>err; echo \$? >code; } | true
  exit \$(cat code)"
exits 4 "a folder that is a file" render --spp 2 --checkpoint a.obj/c.part -o e.png
exits 4 "or is not there" render --spp 2 --checkpoint nowhere/c.part -o e.png
exits 4 "a merge into such a one" merge before.part -o a.obj/m.png
mkdir disk
if [ "$(id -u)" = 0 ] && mount -t tmpfs -o size=400k none disk 2>/dev/null; then
  cp c.part disk && head -c 100000 /dev/zero >disk/rest
  exits 4 "a full disk" render --spp 30 --checkpoint disk/c.part --every 0.01 -o d.png
  ok "with the old checkpoint on it" cmp disk/c.part before.part
  ok "and nothing more" no_litter disk
  mount -o remount,ro disk
  exits 4 "a disk for reading only" render --spp 30 --checkpoint disk/c.part --resume -o d.png
  umount disk
else skip "a full disk, and one for reading only" "no right to mount one"; fi
out_of_memory 500000 "no memory for a render" "$facet" render a.scene -q --engine path \
  -j 1 -r 9000x9000 --checkpoint c.part -o old.png
render -r 900x900 --spp 1 -o big.part
out_of_memory 60000 "no memory for a merge" "$facet" merge big.part -o old.png
mkdir fake
for lib in libOSMesa.so.8 libOSMesa.so.6 libOSMesa.so libEGL.so.1 libEGL.so; do : >fake/$lib; done
exits 5 "no OpenGL" env LD_LIBRARY_PATH="$PWD/fake" "$facet" render a.scene -q -o old.png
exits 0 "which paths do not miss" env LD_LIBRARY_PATH="$PWD/fake" "$facet" render a.scene -q --engine path --spp 2 --checkpoint c2.part -o n.png
ok "old files are untouched" sh -c 'grep -qx old old.png && cmp c.part before.part'
ok "nothing is left behind" no_litter
finish

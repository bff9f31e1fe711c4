#!/bin/bash
# facet view: scripts replayed without a window (tests/window.t opens one).
. tests/tap.sh
scene=$root/scenes/materials.scene
cd "$T" || exit 1
view() { "$facet" view -q "$scene" -r 96x64 "$@"; }

cat >fly.txt <<'END'
frame start.png
key w down
wait 1
key w up
frame there.png
key shift
frame frosted.png
key shift
mouse 40 10
frame turned.png
key p
END
exits 0 "a script is replayed" view --script fly.txt
cp out line
mkdir again && cp fly.txt again
(cd again && view --script fly.txt >/dev/null)
for name in start there frosted turned; do
  ok "$name.png is the same again" cmp $name.png again/$name.png
done
differ() { # A B
  exits 1 "$1 and $2 differ" "$facet" compare --fail 0.02 "$1.png" "$2.png"
}
differ start there
differ there frosted
differ there turned

# What P prints makes the same picture: by rays to the bit; by OpenGL up to
# what differs between environments prepared for every roughness, as the viewer
# needs them, and for those of the scene's materials.
run_line() { # FILE OPTIONS: run the line in FILE
  line=$(sed "s,^facet,\"$facet\"," "$1")
  shift
  sh -c "$line $*"
}
ok "p prints a command" grep -q "^facet render .*materials.scene.* -r 96x64 .*--eye=" line
ok "that command runs" run_line line -q -o command.png
ok "it is the view" "$facet" compare --fail 0.004 command.png turned.png
cat >rays.txt <<'END'
key a down
wait 0.37
key a up
mouse 31 -7
key space
spp 2
frame rays.pfm
key p
END
view --script rays.txt >line
ok "a command for rays" run_line line --spp 2 -q -o command.pfm
ok "it is the view, to the bit" cmp command.pfm rays.pfm

# The path tracer, its samples, and exposure.
cat >paths.txt <<'END'
key space
spp 3
frame paths.pfm
frame paths.png
key 0
frame balls.png
END
exits 0 "by the path tracer" view --script paths.txt --exposure 1
"$facet" render -q "$scene" -r 96x64 --engine path --spp 3 -o render.pfm
ok "its frame is facet render's, to the bit" cmp paths.pfm render.pfm
"$facet" render -q "$scene" -r 96x64 --engine path --spp 3 --exposure 1 -o render.png
ok "exposed as facet render does" cmp paths.png render.png
differ paths balls
view --script fly.txt --post frosted=20 >/dev/null
"$facet" render -q "$scene" -r 96x64 --post frosted=20 -o render.png
ok "the pane of --post" "$facet" compare --fail 0.004 start.png render.png

# No number of metallic and roughness makes a pixel black or not a number, on
# surfaces as files have them at their worst: triangles without area, normals of
# length 0 or turned round, maps without texture coordinates, a floor that the
# eye looks along.
mkdir worst && cp "$root/scenes/materials-tile.png" worst/tile.png
python3 - worst <<'P'
import math, sys
o, out = [], open(sys.argv[1] + "/worst.obj", "w")
o += ["mtllib worst.mtl", "o ball", "usemtl plain"]
rows, cols = 12, 24
def ball(cx):
    for j in range(rows + 1):
        for i in range(cols):
            t, p = math.pi * j / rows, 2 * math.pi * i / cols
            n = math.sin(t) * math.cos(p), math.cos(t), math.sin(t) * math.sin(p)
            o.append("v %g %g %g" % (cx + n[0], 1 + n[1], n[2]))
            k = (j * cols + i) % 7
            n = [0, 0, 0] if k == 0 else [-c for c in n] if k == 1 else n
            o.append("vn %g %g %g" % tuple(n))
def faces(first):
    for j in range(rows):
        for i in range(cols):
            a, b = first + j * cols + i, first + j * cols + (i + 1) % cols
            o.append("f " + " ".join("%d//%d" % (k, k) for k in (a, b, b + cols, a + cols)))
ball(-1.05), faces(1)
o += ["o mapped", "usemtl mapped"]
ball(1.05), faces(1 + (rows + 1) * cols)
o += ["v 0 0 0", "v 1 1 0", "v 2 2 0", "v 1 1 0", "o nothing", "usemtl plain", "f -4 -3 -2", "f -3 -3 -1"]
o += ["v -9 0 5", "v 9 0 5", "v 9 0 -9", "v -9 0 -9", "o floor", "f -4 -3 -2 -1"]
out.write("\n".join(o) + "\n")
m = "newmtl %s\nKd .7 .5 .3\nPr 0.5\nPm 0.5\n"
maps = "map_Kd tile.png\nnorm tile.png\nmap_Bump tile.png\n"
open(sys.argv[1] + "/worst.mtl", "w").write(m % "plain" + m % "mapped" + maps)
open(sys.argv[1] + "/worst.scene", "w").write(
    "mesh worst.obj\ncamera c\neye 0 0.03 4.4\ntarget 0 0.9 0\nfov 50\nenv sky\n"
    "light point 2 4 3 intensity 40 40 40\n")
keys = ["key 1"] * 10 + ["key 3"] * 10
for metallic in range(3):
    for rough in range(11):
        keys += ["frame %d-%d.pfm" % (metallic, rough), "key 4"]
    keys += ["key 3"] * 11 + ["key 2"] * 5
open(sys.argv[1] + "/keys.txt", "w").write("\n".join(keys) + "\n")
P
for o in "--pbr-model ggx" "--pbr-model report" "--pbr-model ggx --msaa 1" "--shade triangles"; do
  rm -f worst/*.pfm
  # shellcheck disable=SC2086
  exits 0 "keys 1 to 4, $o" env -C worst "$facet" view -q worst.scene -r 72x54 --script keys.txt $o
  ok "no pixel is black, and all are numbers: $o" python3 - worst <<'P'
import array, glob, math, sys
files = glob.glob(sys.argv[1] + "/*.pfm")
assert len(files) == 33, files
for name in files:
    f = open(name, "rb")
    f.readline(), f.readline(), f.readline()
    a = array.array("f", f.read())
    assert all(map(math.isfinite, a)), name
    low = min(max(a[i:i + 3]) for i in range(0, len(a), 3))
    assert low > 0.01, (name, low)
P
done

# What is wrong is said.
exits 2 "--post foggy" view --post foggy
says "frosted=RADIUS" "that names what there is"
exits 3 "a script that is missing" view --script none.txt
echo "key w dwn" >bad.txt
exits 3 "a script that is wrong" view --script bad.txt
says "bad.txt:1: expected key NAME" "with its line"
echo "frame a.jpg" >bad.txt
exits 3 "a frame in no format" view --script bad.txt
says "bad.txt:1: a.jpg" "with its line, too"
echo "frame none/a.png" >bad.txt
exits 4 "a frame into no folder" view --script bad.txt

# No display; then no library, by a file of that name that is none.
exits 5 "no display" env -u DISPLAY -u WAYLAND_DISPLAY "$facet" view -q "$scene"
says "--script" "that says what to do"
mkdir fake && echo none >fake/libglfw.so.3 && cp fake/libglfw.so.3 fake/libglfw.so
exits 5 "no library" env -u DISPLAY LD_LIBRARY_PATH="$T/fake" "$facet" view -q "$scene"
says "libglfw3" "that names the package"
finish

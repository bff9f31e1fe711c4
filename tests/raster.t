#!/bin/sh
# facet render by the raster engine: who draws, what is said when nobody can,
# and that its pictures are those of the path engine where both know the
# answer.
. tests/tap.sh
cd "$T" || exit 1
write_obj a.obj
draw() { "$facet" render -q -r 64x48 "$@"; }

exits 0 "no option: the raster engine" "$facet" render a.obj -r 64x48
says "a.png: 64x48, raster, " "and that is said"
draw a.obj --json -o j.png >j.json
ok "--json: who drew, and every stage" python3 - <<'END'
import json
j = json.load(open("j.json"))
assert j["engine"] == "raster" and j["msaa"] >= 1 and j["warnings"] == []
assert j["gl"]["backend"] in ("OSMesa", "EGL") and j["gl"]["renderer"]
assert (j["width"], j["height"]) == (64, 48) and j["triangles"] == 3
assert j["rays"] == j["samples"] == j["spp"] == j["non_finite"] == 0 and "bvh" not in j
s = j["seconds"]
assert set(s) >= {"total", "load", "gl", "compile", "upload", "shadow", "draw", "read", "render", "write"}
assert s["total"] >= s["gl"] + s["render"] + s["write"]
END

# Both back ends, and the same twice.
for gl in osmesa egl; do
  draw a.obj --gl $gl -o $gl.pfm
  draw a.obj --gl $gl -o again.pfm
  ok "--gl $gl: the same twice" cmp $gl.pfm again.pfm
  draw a.obj --gl $gl --json -o who.png >who.json
  ok "--gl $gl: it is the one" grep -qi "\"backend\": \"$gl\"" who.json
done
ok "both draw the same" "$facet" compare --metric max --fail 1e-5 osmesa.pfm egl.pfm
draw a.obj -j 1 -o j1.pfm
draw a.obj -j 3 -o j3.pfm
ok "whatever the threads" cmp j1.pfm j3.pfm

# A library that cannot be loaded: files of that name which are none.
mkdir fake
for lib in libOSMesa.so.8 libOSMesa.so.6 libOSMesa.so libEGL.so.1 libEGL.so; do : >fake/$lib; done
without() { env LD_LIBRARY_PATH="$T/fake" "$@"; }
rm -f a.png
exits 5 "no library" without "$facet" render a.obj -r 64x48
says libosmesa6 "names the package"
says libegl1 "and the other"
says "--engine path" "and the engine that needs none"
exits 1 "and nothing is written" test -e a.png
exits 5 "--gl osmesa without it" without "$facet" render a.obj --gl osmesa
exits 5 "--gl egl without it" without "$facet" render a.obj --gl egl
exits 5 "bench raster without any" without "$facet" bench raster a.obj
exits 0 "--engine path needs none" without "$facet" render a.obj -q --engine path -r 64x48 --spp 1
exits 0 "--engine auto takes path" without "$facet" render a.obj -v --engine auto -r 64x48 --spp 1 --json
says "takes path" "and says so"
ok "in JSON, too" grep -q '"engine": "path"' out
rm fake/libEGL*
exits 0 "--gl auto takes EGL where OSMesa is missing" without "$facet" render a.obj -q --json -r 64x48
ok "and says so" grep -q '"backend": "EGL"' out
exits 5 "EGL without a driver" env LIBGL_DRIVERS_PATH=/missing "$facet" render a.obj --gl egl
says libgl1-mesa-dri "names the package of the driver"
exits 0 "--engine auto with a library takes raster" "$facet" render a.obj --engine auto -q -r 64x48 --json
ok "and says that" grep -q '"engine": "raster"' out
exits 0 "but not where paths are asked for" "$facet" render a.obj --engine auto -q -r 8x8 --aov variance -o v.png
ok "which it then has" test -s v.variance.pfm
exits 2 "--engine raster has no variance" "$facet" render a.obj --engine raster --aov depth,samples
says "--engine path" "and who has it"

# Flags of the other engine are said to be in vain.
useless=
for flag in "--spp 3" "--time 1" "--error 0.1" "--max-depth 2" "--seed 1" \
  "--integrator naive" "--sampler random" "--bvh brute"; do
  # shellcheck disable=SC2086
  "$facet" render a.obj -r 8x8 $flag 2>"$T/err"
  grep -q -- "warning: ${flag% *} has no effect with --engine raster" "$T/err" || useless="$useless $flag"
done
for flag in "--msaa 4" "--gl auto" "--shadows on" "--shade pixels"; do
  # shellcheck disable=SC2086
  "$facet" render a.obj -r 8x8 --spp 1 --engine path $flag 2>"$T/err"
  grep -q -- "warning: ${flag% *} has no effect with --engine path" "$T/err" || useless="$useless $flag"
done
if [ -z "$useless" ]; then pass "flags of the other engine bring a warning"
else fail "no warning:$useless"; fi
exits 1 "--strict makes it an error" "$facet" render a.obj -r 8x8 --spp 3 --strict

# A floor and a roof above it, of the two models, and both kinds of light.
cat >s.obj <<'END'
mtllib s.mtl
v -4 0 -4
v 4 0 -4
v 4 0 4
v -4 0 4
v -1 1 -1
v 1 1 -1
v 1 1 1
v -1 1 1
usemtl floor
f 4 3 2 1
usemtl roof
f 8 7 6 5
END
cat >s.mtl <<'END'
newmtl floor
Kd 0.6 0.5 0.4
Ks 0.2 0.2 0.2
Ns 20
newmtl roof
Kd 0.2 0.5 0.7
Pr 0.4
Pm 0.3
END
cat >s.scene <<'END'
film 64 48
camera top
eye 2 7 4
target 0 0 0
light point 1 4 1 intensity 40 40 40
light dir 1 -3 0 irradiance 1 1 0.5
env none
END
"$facet" render -q s.obj -o whole.pfm
"$facet" render -q s.obj --crop 5,7,41,30 -o crop.pfm
ok "a crop is a part of the picture" python3 - <<'END'
import array
def pfm(path):
    f = open(path, "rb")
    assert f.readline() == b"PF\n"
    w, h = map(int, f.readline().split())
    assert float(f.readline()) < 0
    rows = [array.array("f", f.read(12 * w)) for _ in range(h)]
    return w, h, rows[::-1]
w, h, full = pfm("whole.pfm")
cw, ch, crop = pfm("crop.pfm")
assert (w, h, cw, ch) == (64, 48, 36, 23)
moved = sum(abs(a - b) > 1e-3 for y in range(ch) for a, b in zip(crop[y], full[7 + y][15:123]))
assert moved <= 0.01 * 3 * cw * ch, moved  # a sample at an edge may fall on its other side
END

# Direct light is that of paths of two segments.  Only the pixels that an edge
# or the border of a shadow crosses may differ, by where their samples lie.
agree() { # TITLE OBJ SHARE, then options
  title=$1 scene=$2 share=$3
  shift 3
  "$facet" render -q "$scene" --msaa 1 -o raster.pfm "$@"
  "$facet" render -q "$scene" --engine path --integrator naive --max-depth 2 --spp 16 -o path.pfm "$@"
  ok "$title: both engines agree" python3 - "$share" <<'END'
import array, sys
def pfm(path):
    f = open(path, "rb")
    f.readline(), f.readline(), f.readline()
    return array.array("f", f.read())
a, b = pfm("raster.pfm"), pfm("path.pfm")
assert max(a) > 0.1 and len(a) == len(b)
n = len(a) // 3
bad = sum(any(abs(a[3 * i + k] - b[3 * i + k]) > 0.01 * (0.4 + b[3 * i + k]) for k in range(3)) for i in range(n))
print(bad / n)
assert bad <= float(sys.argv[1]) * n, bad / n
END
}
# A floor and a ramp beside it: nothing is between them and the lights.
sed 's/^v -1 1 -1/v 4 0 -3/; s/^v 1 1 -1/v 8 2 -3/; s/^v 1 1 1/v 8 2 3/; s/^v -1 1 1/v 4 0 3/' s.obj >ramp.obj
cp s.scene ramp.scene
agree "direct light" ramp.obj 0.04
agree "Blinn-Phong" ramp.obj 0.04 --shading blinn-phong
agree "metallic-roughness" ramp.obj 0.04 --shading pbr
agree "that of the report" ramp.obj 0.04 --shading pbr --pbr-model report
agree "albedo" ramp.obj 0.04 --shading albedo
agree "normals" ramp.obj 0.04 --shading normal
agree "depth" ramp.obj 0.04 --shading depth
agree "shadows" s.obj 0.08
"$facet" render -q s.obj --shadows off -o lit.pfm
exits 1 "--shadows off" cmp -s lit.pfm whole.pfm
"$facet" render -q s.obj --pbr-model report -o report.pfm
exits 1 "--pbr-model report" cmp -s report.pfm whole.pfm
"$facet" render -q s.obj --lights off -o off.pfm
ok "--lights off, and no sky: night" sh -c "'$facet' info off.pfm | grep -qx 'max  0 0 0'"
"$facet" render -q s.obj --msaa 1 --shade triangles -o each.pfm
"$facet" render -q s.obj --msaa 1 -o one.pfm
ok "--shade: the same picture" "$facet" compare -q --metric max --fail 0.002 each.pfm one.pfm
exits 1 "--msaa smooths edges" cmp -s one.pfm whole.pfm
sed 's/intensity 40 40 40/intensity 80 80 80/; s/irradiance 1 1 0.5/irradiance 2 2 1/; 1i mesh s.obj' s.scene >t.scene
"$facet" render -q t.scene -o e0.png
"$facet" render -q s.obj --exposure 1 -o e1.png
ok "one stop is a factor of two" "$facet" compare --metric max --fail 0.005 e1.png e0.png

# Beside the picture, as the path engine has it.
"$facet" render -q s.obj --aov normal,depth,albedo -o r.png
"$facet" render -q s.obj --engine path --aov normal,depth,albedo -o p.png
for kind in normal depth albedo; do
  ok "--aov $kind" "$facet" compare --metric relmse --fail 0.01 r.$kind.pfm p.$kind.pfm
done

# A frame ends before a signal does.
"$facet" render s.obj -q -r 2000x1500 -o signal.png &
pid=$!
sleep 0.05
kill -TERM $pid
wait $pid
code=$?
if { [ $code = 0 ] && "$facet" info signal.png >"$T/out"; } ||
  { [ $code = 143 ] && [ ! -e signal.png ]; }
then pass "SIGTERM: a whole picture or none"
else fail "SIGTERM: exit $code"; fi
finish

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
# Two environments whose light is a formula, as maps; each answer beside a
# hundred thousand lights drawn from the lobe: D V nl seen head-on is what half
# vectors drawn by D nh get with the weight V nl 4 oh / nh.
cat >lobes.py <<'END'
import array, math, random, sys

W, H = 1024, 512
AXIS = (0.48, 0.6, -0.64)

def gradient(x, y, z):
    return 1 + 0.9 * y

def cosine_lobe(x, y, z):
    return max(0.0, 0.48 * x + 0.6 * y - 0.64 * z)

SKIES = {"gradient": gradient, "cosine_lobe": cosine_lobe}

def write_map(name):
    with open(name + ".pfm", "wb") as f:
        f.write(b"PF\n%d %d\n-1\n" % (W, H))
        for j in reversed(range(H)):
            row, v = array.array("f"), math.pi * (j + 0.5) / H
            for i in range(W):
                u = 2 * math.pi * ((i + 0.5) / W - 0.5)
                s = math.sin(v)
                row.extend([SKIES[name](s * math.sin(u), math.cos(v), -s * math.cos(u))] * 3)
            f.write(row.tobytes())

def frame(n):
    x, y, z = n
    a = (0, 1, 0) if abs(y) < 0.9 else (1, 0, 0)
    t = (a[1] * z - a[2] * y, a[2] * x - a[0] * z, a[0] * y - a[1] * x)
    m = math.hypot(*t)
    t = tuple(c / m for c in t)
    return t, (y * t[2] - z * t[1], z * t[0] - x * t[2], x * t[1] - y * t[0])

def mean(light, n, roughness, count=100000):
    """roughness None: irradiance, by the cosine."""
    t, b = frame(n)
    a2 = (roughness or 0) ** 4
    num = den = 0.0
    for k in range(count):
        u1, u2 = (k + 0.5) / count, (k * 0.6180339887498949) % 1
        c2 = 1 - u1 if roughness is None else (1 - u1) / (1 + (a2 - 1) * u1)
        c, w = math.sqrt(c2), 1.0
        if roughness is not None:
            w, cl = c, 2 * c2 - 1  # nh; the light is where wo = n is mirrored
            if cl <= 0:
                continue
            w = 4 * 0.5 / (cl + math.sqrt(a2 + (1 - a2) * cl * cl)) * cl
            c = cl
        s, p = math.sqrt(max(0, 1 - c * c)), 2 * math.pi * u2
        x, y = s * math.cos(p), s * math.sin(p)
        d = [x * t[i] + y * b[i] + c * n[i] for i in range(3)]
        num += w * light(*d)
        den += w
    return math.pi * num / count if roughness is None else num / den

ROUGHNESS = (0.1, 0.2, 0.35, 0.5, 0.6, 0.75, 1)
NEAR = tuple(c / math.hypot(0.5, 0.66, -0.56) for c in (0.5, 0.66, -0.56))
NORMALS = (AXIS, NEAR, (0.0, -0.28, 0.96))

if sys.argv[1] == "ask":
    for name in SKIES:
        write_map(name)
    for n in NORMALS:
        print("irradiance %r %r %r" % n)
        for r in ROUGHNESS:
            print("radiance %r %r %r" % n, r)
else:
    name = sys.argv[2]
    got = [float(line.split()[0]) for line in open(name + ".answers")]
    want = [mean(SKIES[name], n, r) for n in NORMALS for r in (None,) + ROUGHNESS]
    worst = 0
    for k in range(8):
        peak = max(want[k::8])
        worst = max([worst] + [abs(g - w) / peak for g, w in zip(got[k::8], want[k::8])])
    print(name, "%.2g" % worst)
    assert worst < 5e-4, (got, want)
END
python3 lobes.py ask >lobes
for sky in gradient cosine_lobe; do
  "$facet" ibl $sky.pfm --eval lobes >$sky.answers
  ok "$sky: a hundred thousand lights of each lobe agree" python3 lobes.py check $sky
done
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

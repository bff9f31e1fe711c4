#!/bin/sh
# facet compare: its numbers against the definitions, computed here by other
# means, and its verdicts.
. tests/tap.sh
cd "$T" || exit 1
python3 - <<'E'
import random, struct, zlib
random.seed(1)
W, H = 40, 30
def pfm(name, pixels):
    rows = [pixels[y * W:(y + 1) * W] for y in range(H)]
    flat = [c for row in reversed(rows) for p in row for c in p]
    open(name, "wb").write(b"PF\n%d %d\n-1\n" % (W, H) + struct.pack("<%df" % len(flat), *flat))
def png(name, w, h, codes):
    raw = b"".join(b"\0" + bytes(c for p in codes[y * w:(y + 1) * w] for c in p) for y in range(h))
    chunk = lambda k, d: struct.pack(">I", len(d)) + k + d + struct.pack(">I", zlib.crc32(k + d))
    open(name, "wb").write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", w, h, 8, 2, 0, 0, 0))
                           + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))
a = [[random.random() * 3 for _ in "rgb"] for _ in range(W * H)]
b = [[c + random.gauss(0, .01) for c in p] for p in a]
b[17 * W + 23][1] += 2
pfm("a.pfm", a), pfm("b.pfm", b)
codes = [[random.randrange(256) for _ in "rgb"] for _ in range(W * H)]
other = [list(p) for p in codes]
other[5 * W + 7] = [codes[5 * W + 7][0] ^ 1, *codes[5 * W + 7][1:]]
png("a.png", W, H, codes), png("b.png", W, H, other), png("small.png", 4, 4, codes[:16])
decode = lambda c: c / 12.92 if c <= .04045 else ((c + .055) / 1.055) ** 2.4
pfm("decoded.pfm", [[decode(c / 255) for c in p] for p in codes])
nan = [list(p) for p in a]
nan[2 * W + 3][2] = float("nan")
pfm("nan.pfm", nan)
E
"$facet" compare --json a.pfm b.pfm >j.json 2>"$T/err"
ok "the numbers are those of their definitions" python3 - <<'E'
import json, math, struct
def pfm(name):
    d = open(name, "rb").read().split(b"\n", 3)[3]
    f = struct.unpack("<3600f", d)
    rows = [f[y * 120:(y + 1) * 120] for y in range(30)]
    return [c for row in reversed(rows) for c in row]
a, b = pfm("a.pfm"), pfm("b.pfm")
d = [x - y for x, y in zip(a, b)]
mse = sum(x * x for x in d) / 3600
want = {"mse": mse, "rmse": math.sqrt(mse), "mae": sum(map(abs, d)) / 3600, "mean": sum(d) / 3600,
        "max": max(map(abs, d)), "psnr": -10 * math.log10(mse),
        "relmse": sum(x * x / (y * y + .01) for x, y in zip(d, b)) / 3600}
got = json.load(open("j.json"))
for k, v in want.items():
    assert abs(got[k] - v) <= 2e-5 * abs(v), (k, got[k], v)
assert got["worst"] == [23, 17] and got["equal"] is False and got["unit"] == "linear"
peaks = sorted(max(abs(x) for x in d[i:i + 3]) for i in range(0, 3600, 3))
assert peaks[-4] <= got["p99.9"] <= peaks[-1], (got["p99.9"], peaks[-4:])
E
exits 0 "a picture equals itself" "$facet" compare a.png a.png
exits 1 "one code apart" "$facet" compare a.png b.png
ok "the worst pixel is named" grep -q "^max .* at 7,5:" out
exits 1 "one code apart" "$facet" compare a.png b.png
ok "the verdict comes last" sh -c 'tail -1 "$0" | grep -q "^DIFFERENT: rmse "' out
exits 0 "within --fail" "$facet" compare --metric max --fail 0.003922 a.png b.png
exits 1 "beyond --fail" "$facet" compare --metric max --fail 0.003921 a.png b.png
exits 0 "the named metric decides" "$facet" compare --metric p99.9 --fail 0 a.png b.png
exits 0 "psnr: more is better" "$facet" compare --metric psnr --fail 60 a.png b.png
exits 1 "psnr: too little" "$facet" compare --metric psnr --fail 99 a.png b.png
exits 0 "PNG against PFM: the PNG is decoded" "$facet" compare --metric max --fail 1e-6 a.png decoded.pfm
exits 1 "-q decides" "$facet" compare -q a.png b.png
if [ ! -s out ] && [ ! -s err ]; then pass "and says nothing"; else fail "and says nothing"; fi
exits 2 "sizes differ" "$facet" compare a.png small.png
exits 1 "not a number" "$facet" compare nan.pfm a.pfm
says "nan.pfm: pixel 3,2" "is said with its place"
exits 1 "nor in the reference" "$facet" compare a.pfm nan.pfm
exits 3 "a missing picture" "$facet" compare a.png missing.png
exits 3 "no picture" "$facet" compare a.png "$root/Makefile"
exits 1 "--diff" "$facet" compare a.png b.png --diff d.png
if grep -q "^diff .* times 128$" out
then pass "amplified to half of white and more, by a factor that is printed"
else fail "amplified to half of white and more, by a factor that is printed"; fi
ok "black but for the pixel" python3 -c "
import json, subprocess
i = json.loads(subprocess.check_output(['$facet', 'info', '--json', 'd.png']))
assert i['min'] == [0, 0, 0] and round(255 * i['max'][0]) == 128, i
assert abs(i['mean'][0] - 128 / 255 / 1200) < 1e-6 and i['max'][1] == 0, i"
exits 4 "--diff that cannot be written" "$facet" compare a.png b.png --diff missing/d.png
exits 2 "--diff is a PNG" "$facet" compare a.png b.png --diff d.hdr
exits 4 "numbers on a full disk" sh -c "'$facet' compare a.png a.png >/dev/full"
finish

#!/usr/bin/env python3
"""Does facet know its error?  Renders scenes with many seeds and compares what
each run printed with how far its picture is from the truth.

    tests/bench/calibration.py [--seeds 50] [--first-seed 0] [--size 96x60]
        [--facet build/facet] [--scenes cornell,...]
        [--settings "--error 0.1;--spp 64;..."] [--truth SPP] [--folder scenes]

The truth is the mean of all other seeds' pictures at all settings, weighted by
their samples; what it lacks itself is subtracted.  --truth takes a picture of
SPP even samples for the truth instead: pictures of rare bright samples know
each other badly.  ratio is printed / true; the last columns are the shares of
runs in which the true error lies within 10 % of the printed one, and in which
it is no more than --error asked for; jury: its samples for those of the picture.
"""
import argparse
import array
import json
import math
import os
import subprocess
import sys
import tempfile

SCENES = "cornell,cornell-balls,materials,garden,garden-plain,terminator"
SETTINGS = "--error 0.2;--error 0.1;--error 0.05;--spp 16;--spp 64;--spp 256"


def read_pfm(path):
    with open(path, "rb") as f:
        assert f.readline() == b"PF\n"
        f.readline()
        assert float(f.readline()) < 0
        return array.array("f", f.read())


def render(a, scene, setting, seed, out):
    command = [a.facet, "render", f"{a.folder}/{scene}.scene", "--engine", "path", "-r", a.size,
               "--seed", str(seed), "-o", out, "-q", "--json"] + setting.split()
    j = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
    return read_pfm(out), j


def relmse(x, ref):
    return sum((p - r) ** 2 / (r * r + 0.01) for p, r in zip(x, ref)) / len(x)


def main():
    p = argparse.ArgumentParser()
    p.add_argument("--seeds", type=int, default=50)
    p.add_argument("--first-seed", type=int, default=0)
    p.add_argument("--size", default="96x60")
    p.add_argument("--facet", default="build/facet")
    p.add_argument("--scenes", default=SCENES)
    p.add_argument("--folder", default="scenes")
    p.add_argument("--settings", default=SETTINGS)
    p.add_argument("--truth", type=int)
    a = p.parse_args()
    settings = a.settings.split(";")
    print(f"{a.seeds} seeds, {a.size}")
    print(f"{'scene':14s} {'setting':13s} {'spp':>5s} {'true':>8s} {'printed':>8s} "
          f"{'ratio':>6s} {'least':>6s} {'most':>6s} {'within 10 %':>11s} {'as asked':>8s} {'jury':>5s}")
    good = runs = 0
    out = os.path.join(tempfile.mkdtemp(), "x.pfm")
    for scene in a.scenes.split(","):
        results = {s: [render(a, scene, s, a.first_seed + k, out) for k in range(a.seeds)] for s in settings}
        # Sums over all settings of a seed, and their number of samples.
        n = len(results[settings[0]][0][0])
        total, weight = [0.0] * n, 0.0
        own = []
        for k in range(a.seeds):
            mine, w = [0.0] * n, 0.0
            for s in settings:
                x, j = results[s][k]
                w += j["samples"]
                mine = [m + j["samples"] * v for m, v in zip(mine, x)]
            own.append((mine, w))
            total = [t + m for t, m in zip(total, mine)]
            weight += w
        refs = [[(t - m) / (weight - w) for t, m in zip(total, mine)] for mine, w in own]
        # How far two references are apart says what one lacks: they share all
        # but one seed each, so that the mean of seeds' squares does it.
        mean = [t / weight for t in total]
        lack = sum(relmse([m / w for m in mine], mean) for mine, w in own) / a.seeds / a.seeds
        if a.truth:
            truth, j = render(a, scene, f"--spp {a.truth}", 1000003, out)
            refs, lack = [truth] * a.seeds, j["error"] ** 2
        for s in settings:
            true = [math.sqrt(max(relmse(results[s][k][0], refs[k]) - lack, 1e-12)) for k in range(a.seeds)]
            said = [results[s][k][1]["error"] for k in range(a.seeds)]
            ratio = [p / t for p, t in zip(said, true)]
            within = sum(abs(t - p) <= 0.1 * p for p, t in zip(said, true))
            asked = s.split()[1] if s.startswith("--error ") else "inf"
            kept = sum(t <= float(asked) for t in true)
            spp = sum(results[s][k][1]["samples"] for k in range(a.seeds)) / a.seeds / (n / 3)
            jury = sum(j.get("jury", {}).get("samples", 0) / j["samples"] for _, j in results[s]) / a.seeds
            print(f"{scene:14s} {s:13s} {spp:5.0f} {sum(true) / a.seeds:8.4f} {sum(said) / a.seeds:8.4f} "
                  f"{sum(ratio) / a.seeds:6.3f} {min(ratio):6.3f} {max(ratio):6.3f} {100 * within / a.seeds:10.0f}% "
                  + (f"{100 * kept / a.seeds:7.0f}%" if asked != "inf" else f"{'-':>8s}")
                  + f" {100 * jury:4.1f}%",
                  flush=True)
            good, runs = good + within, runs + a.seeds
    print(f"within 10 %: {good} of {runs} runs")
    return 0


if __name__ == "__main__":
    sys.exit(main())

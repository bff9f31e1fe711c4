#!/usr/bin/env python3
"""versus_f3d.py ENV OBJ...: seconds from the start of the process to a PNG of
1920x1080 under an environment, by facet's raster engine and by f3d 4 (Python
module f3d, from PyPI; OSMesa), one after the other, --repeat times.

Prints medians: cold, with empty caches, and warm, with those of the run
before.  Skips, with exit status 77, when f3d is not there."""

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time

FACET = os.environ.get("FACET", "build/facet")

# f3d as a user of its Python module has it: the environment lights the model
# and is seen behind it, edges are smoothed.
F3D = """
import sys, f3d
engine = f3d.Engine.create_osmesa()
engine.options["render.hdri.file"] = sys.argv[1]
engine.options["render.hdri.ambient"] = True
engine.options["render.background.skybox"] = "hdri"
engine.options["render.effect.antialiasing.mode"] = "fxaa"
engine.window.size = 1920, 1080
engine.scene.add(sys.argv[2])
engine.window.render_to_image().save(sys.argv[3])
"""


def seconds(command, cache):
    env = dict(os.environ, HOME=cache, XDG_CACHE_HOME=cache)
    start = time.perf_counter()
    subprocess.run(command, env=env, check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    return time.perf_counter() - start


def main():
    p = argparse.ArgumentParser(description=__doc__)
    p.add_argument("--repeat", type=int, default=3)
    p.add_argument("--cold", type=int, default=1)
    p.add_argument("env")
    p.add_argument("obj", nargs="+")
    a = p.parse_args()
    if subprocess.run([sys.executable, "-c", "import f3d"],
                      stderr=subprocess.DEVNULL).returncode != 0:
        print("skipped: no Python module f3d (pip install f3d)")
        return 77
    print(f"{'seconds':24} {'facet cold':>11} {'f3d cold':>9} "
          f"{'facet warm':>11} {'f3d warm':>9}")
    for obj in a.obj:
        with tempfile.TemporaryDirectory() as t:
            png = os.path.join(t, "o.png")
            commands = {
                "facet": [FACET, "render", obj, "-r", "1920x1080", "--env",
                          a.env, "-o", png],
                "f3d": [sys.executable, "-c", F3D, a.env, obj, png],
            }
            times = {(c, k): [] for c in commands for k in ("cold", "warm")}
            for i in range(a.cold):
                for c, command in commands.items():
                    cache = os.path.join(t, f"{c}{i}")
                    os.mkdir(cache)
                    times[c, "cold"].append(seconds(command, cache))
            for _ in range(a.repeat):
                for c, command in commands.items():
                    cache = os.path.join(t, f"{c}0")
                    times[c, "warm"].append(seconds(command, cache))
            m = {k: statistics.median(v) for k, v in times.items() if v}
            print(f"{os.path.basename(obj):24} {m['facet', 'cold']:11.2f} "
                  f"{m['f3d', 'cold']:9.2f} {m['facet', 'warm']:11.2f} "
                  f"{m['f3d', 'warm']:9.2f}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())

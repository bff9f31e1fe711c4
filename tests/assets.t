#!/usr/bin/env python3
"""OBJ files from many programs, against counts made by other parsers.

FACET_ASSETS (../shared/assets) holds expected.json; where it is absent, so are
these tests.  Files under invalid/ must end with exit status 0 or 3, never by
a signal, and say what is wrong with file:line where a line is to blame."""
import json
import os
import re
import subprocess
import sys

facet = os.environ.get("FACET", "build/facet")
assets = os.environ.get("FACET_ASSETS", "../shared/assets")
table = os.path.join(assets, "expected.json")
if not os.path.exists(table):
    print("1..0 # SKIP no " + table)
    sys.exit()
files = {k: v for k, v in json.load(open(table))["files"].items() if k.endswith(".obj")}
print(f"1..{len(files)}")


def near(a, b, tolerance):
    return abs(a - b) <= tolerance * max(abs(a), abs(b)) + 1e-9


def problems(name, want, no_area):
    """What facet says differently about one file.  Polygons that cross
    themselves or leave their plane have no area to be right about."""
    run = subprocess.run([facet, "info", "--json", os.path.join(assets, name)], capture_output=True, timeout=60)
    said = run.stderr.decode("latin-1")
    if run.returncode not in (0, 3):
        return [f"exit {run.returncode}"]
    broken = name.startswith("invalid/") or want["faces_invalid"] or not want["triangles"]
    if run.returncode == 3:
        if not broken:
            return [f"refused: {said}"]
        return [] if re.search(re.escape(name) + r":(\d+:)? ", said) else [f"no place in: {said}"]
    got = json.loads(run.stdout)
    if name.startswith("invalid/") and not want["faces_invalid"]:
        return [] if isinstance(got["warnings"], list) else ["no warnings"]
    bad = [f"{k} {got[k]}, not {want[k]}" for k in ("positions", "normals", "texcoords", "faces", "triangles", "objects", "groups")
           if got[k] != want[k]]
    low, high = want["area"]["min"], want["area"]["max"]
    if not no_area and not low * (1 - 1e-6) - 1e-12 <= got["area"] <= high * (1 + 1e-6) + 1e-12:
        bad.append(f"area {got['area']}, not {low} to {high}")
    for a, b in zip(sum(got["bbox"] or [], []), sum(want["bbox"] or [], [])):
        if not near(a, b, 1e-6):
            bad.append(f"bounds {got['bbox']}, not {want['bbox']}")
            break
    # A name that is UTF-8 arrives as such; the table has bytes as Latin-1.
    here = {}
    for k, v in got["triangles_by_material"].items():
        try:
            k.encode("latin-1")
        except UnicodeEncodeError:
            k = k.encode("utf-8").decode("latin-1")
        here[k] = v
    there = {k: v["triangles"] for k, v in want["per_material"].items() if v["triangles"]}
    if here != there and sorted(here.values()) != sorted(there.values()):
        bad.append(f"materials {here}, not {there}")
    return bad


for n, (name, row) in enumerate(sorted(files.items()), 1):
    bad = problems(name, row["expect"], "ambiguous" in row)
    print(f"not ok {n} - {name}" if bad else f"ok {n} - {name}")
    for line in bad:
        print("# " + line.strip())

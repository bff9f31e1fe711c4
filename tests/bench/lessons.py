#!/usr/bin/env python3
"""What paths gain by what they learn before the first sample (chapter 10).

    tests/bench/lessons.py build/bench --scenes room,cornell-balls --spp 1,4,16

Each scene is rendered with --integrator mis, which learns nothing, and with
auto, in turn, by one thread.  Prints the least processor seconds of the whole
process, lessons and the reading of files included, the mean relMSE of --repeat
seeds against the reference of peers.py in that folder, and efficiency: one over
relMSE times seconds, over that of mis.
"""
import argparse
import pathlib
import resource
import statistics
import subprocess

import peers


def processor_seconds():
    """Of the processes that have ended.  Linux knows their sum well, but of a
    short process hardly what was the system's."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def render(facet, path, integrator, spp, seed, out):
    """The picture, and what it took."""
    before = processor_seconds()
    subprocess.run([facet, "render", path, "--engine", "path", "--integrator", integrator, "--spp", str(spp), "--seed",
                    str(seed), "--max-depth", str(peers.DEPTH), "-j", "1", "-q", "-o", out], check=True)
    return peers.read_pfm(out), processor_seconds() - before


def compare(name, options):
    path, out = options.folder / (name + ".scene"), str(options.folder / "lessons.pfm")
    reference = peers.reference_of(peers.load_scene(path)[0], options.folder, name, options.reference)
    for spp in options.spp:
        rows = {"mis": [], "auto": []}
        for k in range(options.repeat):
            for integrator, row in rows.items():
                picture, seconds = render(options.facet, path, integrator, spp, 300 + k, out)
                row.append((seconds, peers.error_of(picture, reference)))
        got = {i: (min(r[0] for r in row), statistics.mean(r[1] for r in row)) for i, row in rows.items()}
        gain = got["mis"][0] * got["mis"][1] / (got["auto"][0] * got["auto"][1])
        print("| `%s` | %d | %.2f | %.3g | %.2f | %.3g | %.2f |" % (name, spp, *got["mis"], *got["auto"], gain), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    numbers = lambda kind: lambda text: [kind(w) for w in text.split(",")]
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--facet", default=str(peers.ROOT / "build/facet"))
    parser.add_argument("--scenes", default="room,cornell-balls", type=numbers(str))
    parser.add_argument("--spp", default="1,4,16", type=numbers(int))
    parser.add_argument("--repeat", default=5, type=int)
    parser.add_argument("--reference", default=2048, type=int)
    options = parser.parse_args()
    peers.mi.set_variant("llvm_ad_rgb")
    for name in options.scenes:
        compare(name, options)


if __name__ == "__main__":
    main()

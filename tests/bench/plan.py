#!/usr/bin/env python3
"""What the plan saves: facet with and without --no-skip, in turn.

    tests/bench/plan.py [--runs K] [--facet build/facet] NAME ARGUMENT... [, NAME ARGUMENT...]

For each case a table of its stages: what was done of all, why, and by how much
the seconds and bytes of the stage grow with --no-skip; then the whole process,
in seconds of processors at work.  Seconds are the least of K runs, for others
may be at work as well.  The pictures of both must be the same bytes."""
import json, os, resource, subprocess, sys, tempfile


def run(facet, arguments, picture):
    """The JSON of a render, and the seconds of processors that it took."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    said = subprocess.run([facet, "render", "-q", "--json", "--no-cache", "-o", picture, *arguments], check=True, stdout=subprocess.PIPE).stdout
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return json.loads(said), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def least(runs, stage, key):
    """The smallest value of a stage's member, 0 where it is not known."""
    return min(l[key] or 0 for r in runs for l in r["plan"] if l["stage"] == stage)


def bytes_text(n):
    for unit in ("B", "KB", "MB", "GB"):
        if abs(n) < 999.5 or unit == "GB":
            return "%.3g %s" % (n, unit) if n else ""
        n /= 1000


def case(facet, name, arguments, count):
    runs = {False: [], True: []}
    work = {False: [], True: []}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(count):
            for forced in (False, True):
                out = os.path.join(folder, "%d.pfm" % forced)
                said, seconds = run(facet, arguments + ["--no-skip"] * forced, out)
                runs[forced].append(said)
                work[forced].append(seconds)
        same = open(folder + "/0.pfm", "rb").read() == open(folder + "/1.pfm", "rb").read()
    print("**%s** `facet render %s`\n" % (name, " ".join(arguments)))
    print("| stage | | of | why | seconds saved | bytes saved |\n|---|---|---|---|---|---|")
    for line in runs[False][0]["plan"]:
        stage = line["stage"]
        seconds = least(runs[True], stage, "seconds") - least(runs[False], stage, "seconds")
        size = least(runs[True], stage, "bytes") - least(runs[False], stage, "bytes")
        spared = any(l["did"] > line["did"] for l in runs[True][0]["plan"] if l["stage"] == stage)
        print("| %s | %s | %d of %s %s | %s | %s | %s |" % (
            stage, line["verdict"], line["did"], "any" if line["all"] is None else line["all"], line["unit"], line["why"],
            "%.4f" % seconds if spared and line["seconds"] is not None else "", bytes_text(size) if spared else ""))
    assert all(l["kept"] for r in runs[False] + runs[True] for l in r["plan"])
    a, b = min(work[False]), min(work[True])
    print("\nThe whole: %.3f seconds of processors, with --no-skip %.3f; the pictures are %s.\n" % (a, b, "the same bytes" if same else "DIFFERENT"))
    assert same


def main():
    arguments, facet, count = sys.argv[1:], "build/facet", 3
    while arguments and arguments[0] in ("--runs", "--facet"):
        if arguments[0] == "--runs":
            count = int(arguments[1])
        else:
            facet = arguments[1]
        arguments = arguments[2:]
    cases = [[]]
    for a in arguments:
        if a == ",":
            cases.append([])
        else:
            cases[-1].append(a)
    for name, *rest in cases:
        case(facet, name, rest, count)


main()

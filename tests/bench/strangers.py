#!/usr/bin/env python3
"""Scenes of models and skies by others, for peers.py.

    tests/bench/strangers.py build/strangers &&
    tests/bench/peers.py build/strangers --scenes teapot,eagle,jungle,flat,box

They are read from FACET_ASSETS (../shared/assets) and are as nobody made them
for this book.  Both programs must be able to show them: textures are left out,
colours kept between 0.1 and 0.8, and all is matt.

teapot  on a floor, in an even light
eagle   a scan of 218k triangles on a floor, in the light of a studio
jungle  a low-polygon hut under a sky between trees
flat    inside of an apartment of 178k triangles, a town's sky in the windows
box     the Cornell box with its lamp
"""
import math
import os
import pathlib
import re
import shutil
import sys

ASSETS = pathlib.Path(os.environ.get("FACET_ASSETS", "../shared/assets"))


def word(line):
    return re.sub(r"\W", "_", line.split(None, 1)[1].strip())


def read_mtl(path):
    colors, now = {}, None
    for line in open(path, errors="replace"):
        words = line.split()
        if words[:1] == ["newmtl"]:
            now = colors.setdefault(word(line), {})
        elif now is not None and words[:1] in (["Kd"], ["Ke"]):
            now[words[0]] = [float(w) for w in words[1:4]]
    return colors


def corner(text, counts):
    """v or v//vn, counted from 1 and not from here."""
    place, *rest = text.split("/")
    wanted = [place] + rest[1:2]
    found = [str(int(w) if int(w) > 0 else n + 1 + int(w)) for w, n in zip(wanted, counts) if w]
    return "//".join(found)


class Model:
    """Lines of an OBJ with nothing but geometry and names of materials."""

    def __init__(self, source):
        self.lines, self.points, self.used, library, normals = ["usemtl plain"], [], {"plain"}, None, 0
        for line in open(source, errors="replace"):
            words = line.split()
            if words[:1] == ["mtllib"]:
                library = source.parent / line.split(None, 1)[1].strip()
            elif words[:1] == ["usemtl"]:
                self.used.add(word(line))
                self.lines.append("usemtl " + word(line))
            elif words[:1] == ["v"]:
                self.points.append([float(w) for w in words[1:4]])
                self.lines.append("v " + " ".join(words[1:4]))
            elif words[:1] == ["vn"]:
                self.lines.append(line.strip())
                normals += 1
            elif words[:1] == ["f"]:
                counts = len(self.points), normals
                self.lines.append("f " + " ".join(corner(w, counts) for w in words[1:]))
        self.colors = read_mtl(library) if library and library.exists() else {}
        self.lo = [min(p[i] for p in self.points) for i in range(3)]
        self.hi = [max(p[i] for p in self.points) for i in range(3)]

    def at(self, x, y, z):
        """A place of the box, in shares of its sides."""
        return [a + t * (b - a) for a, b, t in zip(self.lo, self.hi, (x, y, z))]

    def outside(self):
        """An eye that sees all of it, and the middle."""
        middle, ahead = self.at(0.5, 0.5, 0.5), (0.4, 0.3, 1)
        far = 0.375 * math.dist(self.lo, self.hi) / math.tan(math.radians(20)) / math.hypot(*ahead)
        return [m + far * a for m, a in zip(middle, ahead)], middle

    def add_floor(self, sides):
        half = sides * max(b - a for a, b in zip(self.lo, self.hi))
        x, y, z = self.at(0.5, -0.001, 0.5)
        for a, b in ((-1, 1), (1, 1), (1, -1), (-1, -1)):
            self.points.append([x + a * half, y, z + b * half])
            self.lines.append("v %g %g %g" % tuple(self.points[-1]))
        n = len(self.points)
        self.used.add("ground")
        self.lines += ["usemtl ground", "f %d %d %d %d" % (n - 3, n - 2, n - 1, n)]

    def write(self, folder, name):
        with open(folder / (name + ".mtl"), "w") as f:
            for material in sorted(self.used):
                color = self.colors.get(material, {})
                kd = [min(max(c, 0.1), 0.8) for c in color.get("Kd", (0.6, 0.6, 0.6))]
                if any(color.get("Ke", [0])):
                    f.write("newmtl %s\nKd 0 0 0\nKe %g %g %g\nillum 1\n" % (material, *color["Ke"]))
                else:
                    f.write("newmtl %s\nKd %g %g %g\nillum 1\n" % (material, *kd))
        text = "\n".join(["mtllib %s.mtl" % name] + self.lines)
        (folder / (name + ".obj")).write_text(text + "\n")


def scene(folder, name, eye, target, fov, env):
    if env.endswith(".hdr"):
        shutil.copyfile(ASSETS / "hdr" / env, folder / env)
    (folder / (name + ".scene")).write_text(
        "mesh %s.obj\ncamera front\neye %g %g %g\ntarget %g %g %g\nfov %g\nfilm 320 240\nenv %s\n"
        % (name, *eye, *target, fov, env))


def main():
    folder, models = pathlib.Path(sys.argv[1]), ASSETS / "models"
    if not models.is_dir():
        sys.exit("strangers.py: skipped, no models in %s" % ASSETS)
    folder.mkdir(parents=True, exist_ok=True)
    for name, path, env, floor in (("teapot", "teapot_maya/teapot.obj", "constant 1 1 1", 3),
                                   ("eagle", "eagle_scan/eagle.obj", "studio_small_03_1k.hdr", 2),
                                   ("jungle", "jungle/jungle.obj", "roof_garden_1k.hdr", 0)):
        model = Model(models / path)
        if floor:
            model.add_floor(floor)
        scene(folder, name, *model.outside(), 40, env)
        model.write(folder, name)
    flat = Model(models / "dream_apartment/dream_apartment.obj")
    scene(folder, "flat", flat.at(0.45, 0.5, 0.35), flat.at(0.75, 0.3, 0.7), 70, "dresden_square_1k.hdr")
    flat.write(folder, "flat")
    box = Model(models / "cornell_original/CornellBox-Original.obj")
    scene(folder, "box", (0, 1, 4.2), (0, 1, 0), 30, "none")
    box.write(folder, "box")


main()

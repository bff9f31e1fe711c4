#!/usr/bin/env python3
"""Scenes to measure path tracers on, written into a folder:

    tests/bench/scenes.py build/bench

balls   13 balls of glass, mirror and clay under a constant sky, 67k triangles
lump    a lump of 328k triangles on a floor under the sky with the sun
room    a room of 29 balls, lit through a small opening, 148k triangles
"""
import math
import pathlib
import shutil
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scenes"))
import objfile  # noqa: E402

objfile.HERE = pathlib.Path(sys.argv[1])
objfile.HERE.mkdir(parents=True, exist_ok=True)
GLASS = ("Kd 0 0 0", "Ks 1 1 1", "Ni 1.5", "illum 7")
MIRROR = ("Kd 0 0 0", "Ks 0.9 0.9 0.9", "illum 3")
CLAYS = ((0.7, 0.3, 0.2), (0.25, 0.5, 0.7), (0.6, 0.6, 0.25), (0.75, 0.75, 0.72))


def clay(obj, name, color):
    obj.material(name, "Kd %g %g %g" % color, "illum 1")


def scene(name, *lines):
    (objfile.HERE / (name + ".scene")).write_text("mesh %s.obj\ncamera front\n" % name + "\n".join(lines) + "\n")


def floor(obj, side):
    obj.quad("floor", "floor", (-side, 0, side), (side, 0, side), (side, 0, -side), (-side, 0, -side))


def balls():
    obj = objfile.Obj()
    clay(obj, "floor", (0.6, 0.58, 0.55))
    obj.material("glass", *GLASS)
    obj.material("mirror", *MIRROR)
    for i, color in enumerate(CLAYS):
        clay(obj, "clay_%d" % i, color)
    floor(obj, 12)
    names = ["glass", "clay_0", "mirror", "clay_1", "clay_2", "glass", "clay_3",
             "mirror", "clay_0", "glass", "clay_1", "mirror", "clay_2"]
    for i, name in enumerate(names):
        radius = 0.55 + 0.25 * math.sin(1.7 * i) ** 2
        turn, away = 2.4 * i, 0.95 * math.sqrt(i)
        obj.ball("ball_%d" % i, name, (away * math.cos(turn), radius, away * math.sin(turn)), radius, 4)
    obj.write("balls")
    scene("balls", "eye 1.5 3.2 8.5", "target 0 0.5 0", "fov 36", "film 320 240", "env constant 1 1 1")


def lump():
    points, faces = objfile.icosphere(7)

    def radius(p):
        x, y, z = p
        r = 1.0
        for k in range(1, 6):
            f = 1.9 ** k
            r += 0.34 / f * math.sin(f * x + 2 * k) * math.sin(f * 1.1 * y + k) * math.sin(f * 0.9 * z - k)
        return r

    at = [tuple(c * radius(p) + s for c, s in zip(p, (0, 1.05, 0))) for p in points]
    normals = [[0, 0, 0] for _ in at]
    for face in faces:
        a, b, c = (at[i] for i in face)
        u, v = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        for i in face:
            normals[i] = [s + t for s, t in zip(normals[i], n)]
    obj = objfile.Obj()
    clay(obj, "floor", (0.5, 0.5, 0.5))
    clay(obj, "stone", (0.72, 0.66, 0.58))
    floor(obj, 12)
    obj.add("lump", "stone", at, faces, [objfile.unit(n) for n in normals])
    obj.write("lump")
    shutil.copy(ROOT / "scenes" / "sky.hdr", objfile.HERE)
    scene("lump", "eye 2.2 2.4 4.2", "target 0 0.9 0", "fov 36", "film 320 240", "env sky.hdr")


def room():
    obj = objfile.Obj()
    clay(obj, "wall", (0.72, 0.7, 0.66))
    clay(obj, "red", (0.65, 0.2, 0.15))
    obj.material("lamp", "Kd 0 0 0", "Ke 60 55 48", "illum 1")
    for i, color in enumerate(CLAYS):
        clay(obj, "clay_%d" % i, color)
    x, y, z = 3, 2.6, 4  # half width, height, half length
    obj.quad("floor", "wall", (-x, 0, z), (x, 0, z), (x, 0, -z), (-x, 0, -z))
    obj.quad("ceiling", "wall", (-x, y, -z), (x, y, -z), (x, y, z), (-x, y, z))
    obj.quad("back", "wall", (-x, 0, -z), (x, 0, -z), (x, y, -z), (-x, y, -z))
    obj.quad("front", "wall", (x, 0, z), (-x, 0, z), (-x, y, z), (x, y, z))
    obj.quad("right", "red", (x, 0, -z), (x, 0, z), (x, y, z), (x, y, -z))
    a, b, low, high = -1.6, -0.6, 1.2, 2.0  # the opening in the left wall
    for i, (z0, z1, y0, y1) in enumerate(((-z, a, 0, y), (b, z, 0, y), (a, b, 0, low), (a, b, high, y))):
        obj.quad("left_%d" % i, "wall", (-x, y0, z1), (-x, y0, z0), (-x, y1, z0), (-x, y1, z1))
    obj.quad("lamp", "lamp", (-x - 1.6, 0.6, 0.6), (-x - 1.6, 0.6, -2.8), (-x - 1.6, 3.4, -2.8), (-x - 1.6, 3.4, 0.6))
    for i in range(29):
        radius = 0.16 + 0.12 * math.sin(2.3 * i) ** 2
        at = (-2.4 + 4.8 * ((i * 0.618) % 1), radius, -3.2 + 6.2 * ((i * 0.755) % 1))
        obj.ball("ball_%d" % i, "clay_%d" % (i % 4), at, radius, 4)
    obj.write("room")
    scene("room", "eye 2.4 1.6 3.6", "target -0.8 0.7 -1.6", "fov 62", "film 320 240", "env none")


balls()
lump()
room()

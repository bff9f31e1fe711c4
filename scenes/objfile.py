"""Writes OBJ, MTL and PNG files for the scene scripts that need no Blender."""
import math
import pathlib
import struct
import zlib

HERE = pathlib.Path(__file__).resolve().parent


class Obj:
    """Objects in the order in which they are added, and their materials."""

    def __init__(self):
        self.lines, self.positions, self.normals, self.texcoords = [], 0, 0, 0
        self.materials = {}

    def material(self, name, *statements):
        self.materials[name] = statements

    def add(self, name, material, vertices, faces, normals=None, texcoords=None):
        """An object; faces are tuples of 0-based indices of vertices, which
        normals and texcoords share."""
        self.lines.append("o " + name)
        self.lines += ["v %.6f %.6f %.6f" % v for v in vertices]
        self.lines += ["vt %.6f %.6f" % t for t in texcoords or ()]
        self.lines += ["vn %.6f %.6f %.6f" % n for n in normals or ()]
        self.lines.append("usemtl " + material)
        for face in faces:
            corners = []
            for i in face:
                corner = str(self.positions + i + 1)
                if texcoords:
                    corner += "/%d" % (self.texcoords + i + 1)
                if normals:
                    corner += "/" * (1 if texcoords else 2) + str(self.normals + i + 1)
                corners.append(corner)
            self.lines.append("f " + " ".join(corners))
        self.positions += len(vertices)
        self.normals += len(normals or ())
        self.texcoords += len(texcoords or ())

    def quad(self, name, material, a, b, c, d, uv=None):
        """Front side where a b c d run counter-clockwise."""
        self.add(name, material, [a, b, c, d], [(0, 1, 2, 3)], None, uv)

    def ball(self, name, material, center, radius, level, smooth=True):
        """An icosphere of 20 * 4^level triangles; smooth: with the normals of
        the sphere."""
        points, faces = icosphere(level)
        at = [tuple(c + radius * x for c, x in zip(center, p)) for p in points]
        self.add(name, material, at, faces, points if smooth else None)

    def write(self, stem):
        text = ["# scenes/%s.py" % stem.split("-")[0], "mtllib %s.mtl" % stem, *self.lines]
        (HERE / (stem + ".obj")).write_text("\n".join(text) + "\n")
        text = ["# scenes/%s.py" % stem.split("-")[0]]
        for name, statements in self.materials.items():
            text += ["", "newmtl " + name, *statements]
        (HERE / (stem + ".mtl")).write_text("\n".join(text) + "\n")


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v)


def icosphere(level):
    """Points on the unit sphere and triangles: an icosahedron, each triangle
    cut in four level times."""
    g = (1 + math.sqrt(5)) / 2
    points = [unit(p) for p in (
        (-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g),
        (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1))]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11),
             (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
             (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9),
             (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(level):
        middles, cut = {}, []

        def middle(i, j):
            key = (min(i, j), max(i, j))
            if key not in middles:
                middles[key] = len(points)
                points.append(unit([x + y for x, y in zip(points[i], points[j])]))
            return middles[key]

        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            cut += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        faces = cut
    return points, faces


def write_png(path, width, height, pixel):
    """8-bit RGB; pixel(x, y) gives three numbers 0..255."""
    rows = b"".join(b"\0" + b"".join(bytes(pixel(x, y)) for x in range(width))
                    for y in range(height))

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))

    (HERE / path).write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
        + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))

"""Every kind of surface that facet knows, in two rows on a textured floor.

    python3 scenes/materials.py

Back row: Lambert, Blinn-Phong with exponents 10, 100 and 1000.  Front row:
mirror, glass, and metallic-roughness (Pr, Pm): a rough metal, a glossy paint.
"""
import math

from objfile import Obj, write_png

SIDE = 256


def tile(x, y):
    """A square of encaustic tiles: a ring in a diamond in a border."""
    u, v = (x + 0.5) / SIDE * 2 - 1, (y + 0.5) / SIDE * 2 - 1
    r, diamond, border = math.hypot(u, v), abs(u) + abs(v), max(abs(u), abs(v))
    if border > 0.94:
        return 96, 84, 76
    if 0.36 < r < 0.50:
        return 178, 74, 48
    if diamond < 0.86:
        return 226, 214, 190
    return 58, 84, 104


write_png("materials-tile.png", SIDE, SIDE, tile)
row = Obj()
row.material("floor", "Kd 1 1 1", "map_Kd -s 24 24 1 materials-tile.png", "illum 1")
row.quad("floor", "floor", (-24, 0, 24), (24, 0, 24), (24, 0, -24), (-24, 0, -24),
         uv=[(0, 0), (1, 0), (1, 1), (0, 1)])
CLAY = "Kd 0.60 0.22 0.12"
kinds = (
    ("lambert", CLAY, "illum 1"),
    ("exponent_10", CLAY, "Ks 0.25 0.25 0.25", "Ns 10", "illum 2"),
    ("exponent_100", CLAY, "Ks 0.25 0.25 0.25", "Ns 100", "illum 2"),
    ("exponent_1000", CLAY, "Ks 0.25 0.25 0.25", "Ns 1000", "illum 2"),
    ("mirror", "Kd 0 0 0", "Ks 0.92 0.92 0.92", "illum 3"),
    ("glass", "Kd 0 0 0", "Ks 1 1 1", "Ni 1.5", "illum 7"),
    ("rough_copper", "Kd 0.95 0.52 0.34", "Pr 0.45", "Pm 1", "illum 3"),
    ("blue_paint", "Kd 0.03 0.10 0.40", "Pr 0.15", "Pm 0", "illum 2"))
for i, (name, *statements) in enumerate(kinds):
    row.material(name, *statements)
    row.ball("ball_" + name, name, (2.15 * (i % 4) - 3.225, 0.9, -1.6 if i < 4 else 1.2), 0.9,
             4 if name in ("mirror", "glass") else 3)
row.write("materials")

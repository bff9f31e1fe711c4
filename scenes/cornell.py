"""The Cornell box, and the same room with a glass and a mirror ball.

    python3 scenes/cornell.py

The corners are those that were measured in the laboratory, in units of 100 mm
(Cornell University Program of Computer Graphics, "Cornell Box Data",
after Goral et al. 1984).  The colours are linear RGB chosen to resemble the
measured paints and lamp.  The lamp glows downwards alone.
"""
from objfile import Obj

WHITE = ("Kd 0.73 0.71 0.68", "illum 1")
RED = ("Kd 0.61 0.06 0.05", "illum 1")
GREEN = ("Kd 0.13 0.43 0.10", "illum 1")
LAMP = ("Kd 0.75 0.75 0.75", "Ke 17 12 4", "illum 1")


def units(*corner):
    return tuple(x / 100 for x in corner)


def block(box, name, top, height):
    """A block without its bottom: its upper corners, counter-clockwise from
    above."""
    up = [units(x, height, z) for x, z in top]
    down = [units(x, 0, z) for x, z in top]
    faces = [(0, 1, 2, 3)] + [(i, 4 + i, 4 + (i + 1) % 4, (i + 1) % 4) for i in range(4)]
    box.add(name, "white", up + down, faces)


def room():
    box = Obj()
    box.material("white", *WHITE)
    box.material("red", *RED)
    box.material("green", *GREEN)
    box.material("lamp", *LAMP)
    floor = [units(*c) for c in ((552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2))]
    top = [units(*c) for c in ((556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0))]
    box.quad("floor", "white", *floor)
    box.quad("back", "white", floor[3], floor[2], top[2], top[1])
    box.quad("right", "green", floor[2], floor[1], top[3], top[2])
    box.quad("left", "red", floor[0], floor[3], top[1], top[0])
    # The ceiling around the lamp, so that neither lies on the other.
    lamp = [units(x, 548.8, z) for x, z in ((343, 227), (343, 332), (213, 332), (213, 227))]
    box.add("ceiling", "white", top + lamp,
            [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)])
    box.quad("lamp", "lamp", *lamp)
    return box


blocks = room()
block(blocks, "short_block", ((130, 65), (82, 225), (240, 272), (290, 114)), 165)
block(blocks, "tall_block", ((423, 247), (265, 296), (314, 456), (472, 406)), 330)
blocks.write("cornell")

balls = room()
balls.material("mirror", "Kd 0 0 0", "Ks 0.9 0.9 0.9", "illum 3")
balls.material("glass", "Kd 0 0 0", "Ks 1 1 1", "Ni 1.5", "illum 7")
balls.ball("ball_mirror", "mirror", (3.85, 1.0, 3.75), 1.0, 4)
balls.ball("ball_glass", "glass", (1.75, 1.0, 1.85), 1.0, 4)
balls.write("cornell-balls")

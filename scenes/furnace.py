"""A white furnace: under light 1 from everywhere, what absorbs nothing cannot
be seen.

    python3 scenes/furnace.py

A cube whose normals are those of a sphere is the hardest shape for this: its
interpolated normals lean up to 55 degrees away from the faces.
"""
from objfile import Obj, unit

furnace = Obj()
furnace.material("white", "Kd 1 1 1", "illum 1")
furnace.material("mirror", "Kd 0 0 0", "Ks 1 1 1", "illum 3")
furnace.material("glass", "Kd 0 0 0", "Ks 1 1 1", "Ni 1.5", "illum 7")
furnace.ball("ball_white", "white", (-2.4, 0, 0), 1, 3)
furnace.ball("ball_glass", "glass", (2.4, 0, 0), 1, 3)
corners = [(x, y, z) for z in (-0.7, 0.7) for y in (-0.7, 0.7) for x in (-0.7, 0.7)]
furnace.add("cube_mirror", "mirror", corners,
            [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)],
            [unit(c) for c in corners])
furnace.write("furnace")

"""A coarse ball with smooth normals under one point light: where the facets
turn away from the light before the normals do, a plain renderer shows teeth.

    python3 scenes/terminator.py
"""
from objfile import Obj

scene = Obj()
scene.material("plaster", "Kd 0.8 0.8 0.8", "illum 1")
scene.ball("ball_smooth", "plaster", (-1.15, 0, 0), 1, 2)
scene.ball("ball_flat", "plaster", (1.15, 0, 0), 1, 2, smooth=False)
scene.write("terminator")

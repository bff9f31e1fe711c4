"""Model the garden in Blender and export it with Blender's own OBJ exporter.

    blender --background --factory-startup --python scenes/garden.py

writes beside this script, the same bytes every time (Blender 3.4.1):

    garden.obj, .mtl         balls with interpolated normals; the materials
                             with Blender's PBR extensions (Pr, Pm, Tf)
    garden-facets.obj, .mtl  the same, the glass and the iron ball coarser and as
                             the flat triangles they are
    garden-plain.obj, .mtl   as garden, materials without the extensions:
                             names alone say what is glass and what a mirror

Blender's +Z is up; its exporter turns that into the +Y of the files.  Lengths
are metres.  An OBJ file knows no lamp and no camera: the .scene files beside
these have them.
"""
import math
import pathlib

import bmesh
import bpy

HERE = pathlib.Path(__file__).resolve().parent

def clear():
    """An empty Blender."""
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    for material in list(bpy.data.materials):
        bpy.data.materials.remove(material)


def material(name, color, roughness=1.0, metallic=0.0, specular=0.0, **more):
    """A Principled material; color is linear."""
    m = bpy.data.materials.new(name)
    m.use_nodes = True
    inputs = m.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value = (*color, 1)
    inputs["Roughness"].default_value = roughness
    inputs["Metallic"].default_value = metallic
    inputs["Specular"].default_value = specular
    for key, value in more.items():
        inputs[key].default_value = value
    return m


def add(name, mesh, mat, at=(0, 0, 0), smooth=False):
    """An object of one material in the scene."""
    for polygon in mesh.polygons:
        polygon.use_smooth = smooth
    mesh.materials.append(mat)
    thing = bpy.data.objects.new(name, mesh)
    thing.location = at
    bpy.context.scene.collection.objects.link(thing)


def polygons(vertices, faces):
    mesh = bpy.data.meshes.new("mesh")
    mesh.from_pydata(vertices, [], faces)
    return mesh


def icosphere(radius, divisions, stretch=(1, 1, 1)):
    """20 * 4^(divisions - 1) triangles."""
    grown = bmesh.new()
    bmesh.ops.create_icosphere(grown, subdivisions=divisions, radius=radius)
    bmesh.ops.scale(grown, vec=stretch, verts=grown.verts)
    mesh = bpy.data.meshes.new("mesh")
    grown.to_mesh(mesh)
    grown.free()
    return mesh


def boxes(corners):
    """Boxes (low corner, high corner) without their bottoms, as one mesh."""
    vertices, faces = [], []
    for (x0, y0, z0), (x1, y1, z1) in corners:
        n = len(vertices)
        vertices += [(x0, y0, z0), (x1, y0, z0), (x1, y1, z0), (x0, y1, z0),
                     (x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)]
        faces += [[n + i for i in face] for face in (
            (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))]
    return polygons(vertices, faces)


def frustum(radius0, radius1, height, sides):
    """A trunk: open below, since it stands in the ground, and above."""
    ring = [(math.cos(2 * math.pi * i / sides), math.sin(2 * math.pi * i / sides))
            for i in range(sides)]
    vertices = [(radius0 * c, radius0 * s, 0) for c, s in ring]
    vertices += [(radius1 * c, radius1 * s, height) for c, s in ring]
    faces = [(i, (i + 1) % sides, sides + (i + 1) % sides, sides + i)
             for i in range(sides)]
    return polygons(vertices, faces)


def extruded(outline, thickness):
    """A slab: the outline (x, z), counter-clockwise seen from -y, made thick
    towards +y.  Its front and its back are one polygon each."""
    n = len(outline)
    vertices = [(x, 0, z) for x, z in outline]
    vertices += [(x, thickness, z) for x, z in outline]
    faces = [tuple(range(n)), tuple(range(2 * n - 1, n - 1, -1))]
    faces += [(i, n + i, n + (i + 1) % n, (i + 1) % n) for i in range(n)]
    return polygons(vertices, faces)


def wall(width, height, door, door_width, spring, steps):
    """The outline of a wall with a round-arched door, whose middle is at x =
    door; the arch begins at the height spring.  A concave polygon."""
    r = door_width / 2
    arch = [(door + r * math.cos(math.pi * i / steps),
             spring + r * math.sin(math.pi * i / steps)) for i in range(steps + 1)]
    return [(0, 0), (door - r, 0), *reversed(arch), (door + r, 0), (width, 0),
            (width, height), (0, height)]


def ground():
    grass = material("grass", (0.085, 0.15, 0.035))
    disc = [(90 * math.cos(math.pi * i / 36), 90 * math.sin(math.pi * i / 36), 0)
            for i in range(72)]
    add("lawn", polygons(disc, [tuple(range(72))]), grass)
    hill = material("hill", (0.10, 0.17, 0.09))
    for i, (x, y, r, h) in enumerate(((-46, 62, 34, 7), (-8, 74, 30, 4.5),
                                      (30, 66, 32, 6.5), (66, 52, 30, 5))):
        add("hill_%d" % i, icosphere(r, 4, (1, 0.5, h / r)), hill, (x, y, 0), True)
    light = material("slab_light", (0.58, 0.51, 0.41))
    dark = material("slab_dark", (0.23, 0.14, 0.10))
    gap, slabs = 0.015, ([], [])
    for i in range(-5, 5):
        for j in range(-5, 3):
            slabs[(i + j) % 2].append(((i + gap, j + gap, 0),
                                       (i + 1 - gap, j + 1 - gap, 0.06)))
    add("terrace_light", boxes(slabs[0]), light)
    add("terrace_dark", boxes(slabs[1]), dark)
    add("terrace_bed", polygons([(-5, -5, 0.04), (5, -5, 0.04), (5, 3, 0.04),
                                 (-5, 3, 0.04)], [(0, 1, 2, 3)]),
        material("sand", (0.20, 0.17, 0.13)))


def masonry():
    lime = material("lime_wash", (0.62, 0.44, 0.29))
    brick = material("brick", (0.36, 0.12, 0.065))
    outline = wall(7.4, 2.35, 3.55, 1.5, 1.15, 24)
    add("wall", extruded(outline, 0.4), lime, (-0.9, 3.1, 0))
    add("coping", boxes([((-1.0, 3.0, 2.35), (6.6, 3.6, 2.5))]), brick)


def tree(name, at, trunk, crown, leaf, bark, more=(), divisions=4):
    """A trunk and round crowns: (radius, height) on top and (x, y, z, radius)
    beside it."""
    radius, height = crown
    add(name + "_trunk", frustum(0.13 * trunk, 0.07 * trunk, height, 12), bark,
        at, True)
    add(name + "_crown", icosphere(radius, divisions), leaf,
        (at[0], at[1], height + 0.35 * radius), True)
    for i, (x, y, z, r) in enumerate(more):
        add("%s_crown_%d" % (name, i), icosphere(r, divisions), leaf,
            (at[0] + x, at[1] + y, z), True)


def trees():
    bark = material("bark", (0.12, 0.075, 0.045))
    gloss = dict(roughness=0.5, specular=0.05)
    spring = material("leaf_spring", (0.22, 0.36, 0.05), **gloss)
    summer = material("leaf_summer", (0.06, 0.20, 0.045), **gloss)
    autumn = material("leaf_autumn", (0.55, 0.19, 0.03), **gloss)
    tree("tree_left", (-4.2, 4.6, 0), 1.5, (1.45, 2.2), summer, bark,
         ((1.0, 0.3, 2.1, 0.85), (-1.1, -0.2, 2.3, 0.9)))
    tree("tree_gate", (0.6, 6.4, 0), 1.3, (1.2, 2.9), spring, bark,
         ((-0.9, 0.2, 2.6, 0.7),))
    tree("tree_right", (5.7, 6.1, 0), 1.5, (1.3, 2.75), autumn, bark,
         ((-0.75, -0.9, 2.5, 0.8), (1.0, 0.2, 2.6, 0.8)))
    for i, (x, y, r, leaf) in enumerate((
            (-12, 17, 1.9, spring), (-8.5, 20, 2.2, summer), (-3.0, 23, 2.0, autumn),
            (3.6, 21, 2.1, summer), (10.5, 19, 2.0, spring), (15, 16, 1.8, summer))):
        tree("tree_far_%d" % i, (x, y, 0), 2, (r, 1.9), leaf, bark,
             divisions=3)


def balls(divisions, smooth):
    glass = material("glass", (1, 1, 1), 0, specular=0.5, Transmission=1, IOR=1.5)
    iron = material("iron", (0.78, 0.76, 0.73), 0, 1, specular=0.76)
    add("ball_glass", icosphere(0.85, divisions), glass,
        (-2.45, -0.75, 0.06 + 0.85), smooth)
    add("ball_iron_mirror", icosphere(1.05, divisions), iron,
        (-0.15, 0.55, 0.06 + 1.05), smooth)
    row = (("gold", (1.0, 0.70, 0.26), 0.9, 0.3),
           ("copper", (0.93, 0.46, 0.32), 0.9, 0.6),
           ("lacquer", (0.45, 0.02, 0.02), 0.05, 0.25),
           ("porcelain", (0.05, 0.12, 0.42), 0.0, 0.1),
           ("chalk", (0.75, 0.73, 0.70), 0.0, 1.0))
    for i, (name, color, metallic, roughness) in enumerate(row):
        at = (0.1 + 0.9 * i, -2.75 + 0.16 * i * i, 0.06 + 0.36)
        add("ball_pbr_" + name, icosphere(0.36, 4),
            material("pbr_" + name, color, roughness, metallic,
                     specular=0.7 if metallic > 0.5 else 0.04 if roughness < 1 else 0), at, True)


def garden(divisions, smooth):
    clear()
    ground()
    masonry()
    trees()
    balls(divisions, smooth)


def export(name, extensions):
    bpy.ops.wm.obj_export(filepath=str(HERE / (name + ".obj")), export_uv=False,
                          export_pbr_extensions=extensions, path_mode="STRIP")


garden(5, True)
export("garden", True)
export("garden-plain", False)
garden(4, False)
export("garden-facets", True)

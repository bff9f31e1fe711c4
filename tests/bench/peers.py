#!/usr/bin/env python3
"""facet and Mitsuba 3 on the same scenes, in turn: seconds against error.

    tests/bench/scenes.py build/bench && tests/bench/peers.py build/bench

Needs `pip install mitsuba numpy`, and an LLVM of 17 or later for the fast
variant (libllvm19).  Prints, for balls, lump, room and cornell-balls, the
median seconds to render and relMSE = mean((x - ref)^2 / (ref^2 + 0.01)) of
both at each number of samples, and then the seconds to each error, between
the measured points.  Beside them facet --error, asked for the root of each mark:
its seconds and the relMSE that it came to.  With --whole these are seconds of whole processes, from
reading files to a file written, where what both keep on disk for their next
run is there.  With --z-test instead: do both converge to the same
picture?  Each renders with --parts seeds; their means' difference over its
standard deviation, in every pixel and channel, passes where it is no less
likely than 1 in 100 for the largest of as many (Sidak); 99.75 % have to.
Where Mitsuba's pixels are dark but for rare bright samples (caustics), their
means are far from normal until there are hundreds of them: --theirs gives its
samples a part.
Source: the render tests of Mitsuba 3, Subr and Arvo 2007.  The reference is Mitsuba's own, rendered once with
--reference samples and kept in the folder; scripts that compare facet with
itself are facet bench error's matter.
"""
import argparse
import json
import math
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
LLVM = "/usr/lib/x86_64-linux-gnu/libLLVM.so.19.1"
if os.path.exists(LLVM):
    os.environ.setdefault("DRJIT_LIBLLVM_PATH", LLVM)
try:
    import mitsuba as mi
    import numpy as np
except ImportError:
    sys.exit("peers.py: skipped, needs pip install mitsuba numpy")

DEPTH = 16


def read_mtl(path):
    materials, now = {}, None
    for words in (line.split() for line in open(path)):
        if words[:1] == ["newmtl"]:
            now = materials.setdefault(words[1], {})
        elif words and now is not None and not words[0].startswith("#"):
            now[words[0]] = [float(w) for w in words[1:]]
    return materials


def read_obj(path):
    """(positions, normals, {material: faces}); a face is a list of corners
    (position, normal or None)."""
    points, normals, faces, now = [], [], {}, None
    for words in (line.split() for line in open(path)):
        if not words:
            continue
        if words[0] == "v":
            points.append([float(w) for w in words[1:4]])
        elif words[0] == "vn":
            normals.append([float(w) for w in words[1:4]])
        elif words[0] == "usemtl":
            now = faces.setdefault(words[1], [])
        elif words[0] == "f":
            corner = [w.split("/") for w in words[1:]]
            now.append([(int(c[0]) - 1, int(c[2]) - 1 if len(c) > 2 else None) for c in corner])
    return points, normals, faces


def rgb(value):
    return {"type": "rgb", "value": value}


def bsdf_of(m):
    illum = int(m.get("illum", [1])[0])
    if illum == 3:
        return {"type": "conductor", "material": "none", "specular_reflectance": rgb(m["Ks"])}
    if illum == 7:
        return {"type": "dielectric", "int_ior": m["Ni"][0], "ext_ior": 1.0}
    return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": rgb(m["Kd"])}}


def mesh_of(name, points, normals, faces, material):
    """Triangles of one material; vertices apart where their normals are."""
    number, at, by, triangles = {}, [], [], []
    for face in faces:
        corners = []
        for key in face:
            if key not in number:
                number[key] = len(at)
                at.append(points[key[0]])
                by.append(normals[key[1]] if key[1] is not None else [0, 0, 1])
            corners.append(number[key])
        triangles += [[corners[0], b, c] for b, c in zip(corners[1:], corners[2:])]
    smooth = faces[0][0][1] is not None
    properties = mi.Properties()
    properties["bsdf"] = mi.load_dict(bsdf_of(material))
    if any(material.get("Ke", [0])):
        properties["emitter"] = mi.load_dict({"type": "area", "radiance": rgb(material["Ke"])})
    mesh = mi.Mesh(name, len(at), len(triangles), has_vertex_normals=smooth, props=properties)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = np.ravel(np.array(at, np.float32))
    parameters["faces"] = np.ravel(np.array(triangles, np.uint32))
    if smooth:
        parameters["vertex_normals"] = np.ravel(np.array(by, np.float32))
    parameters.update()
    return mesh


def sky_of(path):
    """The same function of directions for Mitsuba, whose first and last rows
    are the poles: with two rows for one both interpolate between equal values."""
    rows = np.array(mi.Bitmap(str(path)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))
    h = len(rows)
    at = np.clip(np.arange(2 * h + 1) / 2 - 0.5, 0, h - 1)
    low = np.minimum(at.astype(int), h - 2)
    part = (at - low)[:, None, None].astype(np.float32)
    return mi.Bitmap((1 - part) * rows[low] + part * rows[low + 1])


def describe(path, shape):
    """The scene for Mitsuba as a dictionary, and its size; shape makes one
    object of a name, points, normals, faces and material."""
    said = {}
    for words in (line.split("#")[0].split() for line in open(path)):
        if words:
            said[words[0]] = words[1:]
    three = lambda key: [float(w) for w in said[key][:3]]
    folder = path.parent
    points, normals, faces = read_obj(folder / said["mesh"][0])
    materials = read_mtl(folder / said["mesh"][0].replace(".obj", ".mtl"))
    width, height = (int(w) for w in said["film"])
    to_world = mi.ScalarTransform4f().look_at(origin=three("eye"), target=three("target"), up=[0, 1, 0])
    scene = {
        "type": "scene",
        "sensor": {
            "type": "perspective", "fov": float(said["fov"][0]), "fov_axis": "y", "to_world": to_world,
            "film": {"type": "hdrfilm", "width": width, "height": height, "pixel_format": "rgb",
                     "component_format": "float32", "rfilter": {"type": "box"}},
        },
        "integrator": {"type": "path", "max_depth": DEPTH},
    }
    env = said.get("env", ["none"])
    if env[0] == "constant":
        scene["env"] = {"type": "constant", "radiance": rgb([float(w) for w in env[1:4]])}
    elif env[0] != "none":
        turn = mi.ScalarTransform4f().rotate([0, 1, 0], 180)
        scene["env"] = {"type": "envmap", "bitmap": sky_of(folder / env[0]), "to_world": turn}
    for i, (name, list_of) in enumerate((n, f) for n, f in faces.items() if f):
        scene["mesh_%d" % i] = shape(name, points, normals, list_of, materials[name])
    return scene, width, height


def load_scene(path):
    scene, width, height = describe(path, mesh_of)
    return mi.load_dict(scene), width, height


def write_scene(path):
    """A file beside path that Mitsuba's own program reads, with binary meshes."""
    def shape(name, points, normals, faces, material):
        file = str(path.with_suffix("")) + "-" + name + ".ply"
        mesh_of(name, points, normals, faces, material).write_ply(file)
        found = {"type": "ply", "filename": file, "bsdf": bsdf_of(material)}
        if any(material.get("Ke", [0])):
            found["emitter"] = {"type": "area", "radiance": rgb(material["Ke"])}
        return found
    scene = describe(path, shape)[0]
    if "bitmap" in scene.get("env", {}):
        sky = str(path.with_suffix("")) + "-sky.exr"
        scene["env"].pop("bitmap").write(sky)
        scene["env"]["filename"] = sky
    scene["sensor"]["sampler"] = {"type": "independent", "sample_count": 1}
    file = path.with_suffix(".xml")
    state = mi.parser.parse_dict(mi.parser.ParserConfig(mi.variant()), scene)
    mi.parser.write_file(state, str(file))
    return file


def read_pfm(path):
    with open(path, "rb") as f:
        assert f.readline().strip() == b"PF"
        width, height = (int(w) for w in f.readline().split())
        order = "<" if float(f.readline()) < 0 else ">"
        return np.frombuffer(f.read(), order + "f4").reshape(height, width, 3)[::-1].astype(np.float64)


def by_mitsuba(scene, spp, seed):
    start = time.perf_counter()
    picture = np.array(mi.render(scene, spp=spp, seed=seed), np.float64)
    return picture, time.perf_counter() - start


def limit(spp, error):
    return ["--spp", str(spp)] if error is None else ["--error", str(error)]


def by_facet(facet, path, spp, seed, out, error=None):
    said = subprocess.run([facet, "render", path, "--engine", "path", *limit(spp, error), "--seed", str(seed),
                           "--max-depth", str(DEPTH), "-o", out, "-q", "--json"], check=True, capture_output=True)
    return read_pfm(out), json.loads(said.stdout)["seconds"]["render"]


def seconds_of(command):
    start = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return time.perf_counter() - start


def facet_whole(facet, path, spp, seed, out, error=None):
    seconds = seconds_of([facet, "render", path, "--engine", "path", *limit(spp, error), "--seed", str(seed),
                          "--max-depth", str(DEPTH), "-q", "-o", out])
    return read_pfm(out), seconds


def mitsuba_whole(file, spp, out):
    seconds = seconds_of(["mitsuba", "-m", mi.variant(), "-Dspp=%d" % spp, "-o", out, str(file)])
    picture = mi.Bitmap(out).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
    return np.array(picture, np.float64), seconds


def competitors(path, scene, options):
    """Who renders: names, and functions of samples and seed that give a picture
    and seconds."""
    out, exr = (str(options.folder / ("peers" + s)) for s in (".pfm", ".exr"))
    if not options.whole:
        return {"facet": lambda spp, seed: by_facet(options.facet, path, spp, seed, out),
                "mitsuba": lambda spp, seed: by_mitsuba(scene, spp, seed)}
    file = write_scene(path)
    return {"facet": lambda spp, seed: facet_whole(options.facet, path, spp, seed, out),
            "mitsuba": lambda spp, seed: mitsuba_whole(file, spp, exr)}


def print_adaptive(name, path, mark, reference, options):
    """What facet --error needs for a mark, and what it comes to."""
    out = str(options.folder / "peers.pfm")
    draw = facet_whole if options.whole else by_facet
    rows = []
    for k in range(options.repeat):
        picture, seconds = draw(options.facet, path, None, 100 + k, out, math.sqrt(mark))
        rows.append((seconds, error_of(picture, reference)))
    seconds, error = (statistics.median(r[i] for r in rows) for i in range(2))
    print("%-14s relMSE %-6g facet --error %.4f: %8.4f s  relMSE %.3e" % (name, mark, math.sqrt(mark), seconds, error),
          flush=True)


def error_of(picture, reference):
    return float(np.mean((picture - reference) ** 2 / (reference ** 2 + 0.01)))


def seconds_to(points, error):
    """Log-log between two measured points; None outside of them."""
    for (s0, e0), (s1, e1) in zip(points, points[1:]):
        if e1 <= error <= e0:
            k = (math.log(e0) - math.log(error)) / max(math.log(e0) - math.log(e1), 1e-9)
            return math.exp(math.log(s0) + k * (math.log(s1) - math.log(s0)))
    return None


def reference_of(scene, folder, name, spp):
    kept = folder / ("%s-reference-%d.npy" % (name, spp))
    if not kept.exists():
        parts = max(spp // 256, 1)
        total = sum(by_mitsuba(scene, min(spp, 256), 9000 + i)[0] for i in range(parts))
        np.save(kept, total / parts)
    return np.load(kept)


def compare(name, options):
    path = options.folder / (name + ".scene")
    scene, width, height = load_scene(path)
    reference = reference_of(scene, options.folder, name, options.reference)
    who_draws = competitors(path, scene, options)
    curve = {who: [] for who in who_draws}
    for spp in options.spp:
        who_draws["mitsuba"](spp, 0)  # traced and compiled once, not counted
        runs = {who: [] for who in who_draws}
        for k in range(options.repeat):
            for who, draw in who_draws.items():
                picture, seconds = draw(spp, 100 + k)
                runs[who].append((seconds, error_of(picture, reference)))
        for who, rows in runs.items():
            seconds, error = (statistics.median(r[i] for r in rows) for i in range(2))
            curve[who].append((seconds, error))
            print("%-14s %-8s %5d spp %9.4f s  relMSE %.3e" % (name, who, spp, seconds, error), flush=True)
    for mark in options.marks:
        ours, theirs = seconds_to(curve["facet"], mark), seconds_to(curve["mitsuba"], mark)
        if ours and theirs:
            print("%-14s relMSE %-6g facet %8.4f s  mitsuba %8.4f s  ratio %.2f" % (name, mark, ours, theirs, theirs / ours))
    for mark in options.marks:
        print_adaptive(name, path, mark, reference, options)


def parts_of(draw, parts):
    """The mean of independent pictures, and the variance of that mean."""
    pictures = np.stack([draw(7000 + k) for k in range(parts)])
    return pictures.mean(0), pictures.var(0, ddof=1) / parts


def z_test(name, options):
    path = options.folder / (name + ".scene")
    scene, width, height = load_scene(path)
    out = str(options.folder / "peers.pfm")
    spp = options.spp[-1]
    theirs = parts_of(lambda seed: by_mitsuba(scene, options.theirs or spp, seed)[0], options.parts)
    ours = parts_of(lambda seed: by_facet(options.facet, path, spp, seed, out)[0], options.parts)
    # Where neither saw anything vary, the rounding of sums is what is left.
    z = (ours[0] - theirs[0]) / np.sqrt(ours[1] + theirs[1] + (1e-6 * (1 + theirs[0])) ** 2)
    alpha = 1 - 0.99 ** (1 / z.size)
    limit = statistics.NormalDist().inv_cdf(1 - alpha / 2)
    print("%-14s %d x %d spp  pass %.4f %%  |z| < 3 %.3f %%  mean z %+.4f  z^2 %.3f  mean ratio %.5f" % (
        name, options.parts, spp, 100 * np.mean(np.abs(z) < limit), 100 * np.mean(np.abs(z) < 3), z.mean(),
        np.mean(z * z), ours[0].mean() / theirs[0].mean()), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    numbers = lambda kind: lambda text: [kind(w) for w in text.split(",")]
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--facet", default=str(ROOT / "build/facet"))
    parser.add_argument("--scenes", default="balls,lump,room,cornell-balls", type=numbers(str))
    parser.add_argument("--spp", default="1,2,4,8,16,32,64", type=numbers(int))
    parser.add_argument("--repeat", default=3, type=int)
    parser.add_argument("--marks", default="0.1,0.03,0.01,0.003", type=numbers(float))
    parser.add_argument("--reference", default=2048, type=int)
    parser.add_argument("--z-test", action="store_true")
    parser.add_argument("--whole", action="store_true")
    parser.add_argument("--parts", default=32, type=int)
    parser.add_argument("--theirs", type=int)
    parser.add_argument("--variant", default="llvm_ad_rgb")
    options = parser.parse_args()
    mi.set_variant(options.variant)
    for suffix in (".obj", ".mtl"):
        shutil.copy(ROOT / "scenes" / ("cornell-balls" + suffix), options.folder)
    scene = (ROOT / "scenes" / "cornell-balls.scene").read_text()
    (options.folder / "cornell-balls.scene").write_text(scene.replace("400 400", "256 256"))
    for name in options.scenes:
        (z_test if options.z_test else compare)(name, options)


if __name__ == "__main__":
    main()

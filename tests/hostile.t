#!/usr/bin/env python3
"""Files from strangers: what they may name, and what is said of those that are
broken.  Each row makes a folder of files, runs facet in it, and looks at the
exit status and at what was said: one line for each text of `says`, none for
those of `not`.  No run may take 10 s, or end by a signal."""
import os
import pathlib
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import zlib

facet = os.path.abspath(os.environ.get("FACET", "build/facet"))
home = pathlib.Path(tempfile.mkdtemp(prefix="facet-hostile-"))
OUTSIDE = "--allow-outside"
TRI = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
USES = TRI + "usemtl m\nf 1 2 3\n"
MTL = "newmtl m\nKd 1 0 0\n"


def chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def png(width=1, height=1, depth=8, colour=2, rows=b"\0\1\2\3", tail=None):
    head = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, 0)
    tail = chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"") if tail is None else tail
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + tail


def tga(kind, width, height, bits, body=b"", flags=0, palette=0, entries=0, entry=0, name=0):
    return (struct.pack("<BBBHHBHHHHBB", name, palette, kind, 0, entries, entry, 0, 0, width, height, bits, flags)
            + body)


def hdr(size=b"-Y 1 +X 1", body=b"\x80\x80\x80\x80", head=b"FORMAT=32-bit_rle_rgbe\n"):
    return b"#?RADIANCE\n" + head + b"\n" + size + b"\n" + body


def pfm(head=b"PF\n1 1\n-1\n", body=struct.pack("<3f", 1, 2, 3)):
    return head + body


class Link(str):
    """A symbolic link to that path."""


class Kind(str):
    """fifo, socket or folder."""


def make(folder, files):
    for name, what in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(what, Link):
            path.symlink_to(what.replace("HOME", str(folder)))
        elif what == Kind("fifo"):
            os.mkfifo(path)
        elif what == Kind("socket"):
            here = os.getcwd()
            os.chdir(path.parent)  # names of sockets are short
            socket.socket(socket.AF_UNIX).bind(path.name)
            os.chdir(here)
        elif what == Kind("folder"):
            path.mkdir(exist_ok=True)
        elif isinstance(what, bytes):
            path.write_bytes(what)
        else:
            path.write_text(what.replace("HOME", str(folder)), encoding="latin-1")


done, failed = 0, 0


def row(title, files, args, code, says=(), never=()):
    """One test: facet ARGS with these files, in the folder in/ beside which
    lies out/."""
    global done, failed
    done += 1
    folder = home / str(done)
    (folder / "in").mkdir(parents=True)
    make(folder, files)
    args = [a.replace("HOME", str(folder)) for a in args.split()]
    stdin = files.get("-", b"")
    try:
        run = subprocess.run([facet, *args], cwd=folder / "in", capture_output=True, timeout=10,
                             input=stdin if isinstance(stdin, bytes) else stdin.encode())
        got, said = run.returncode, (run.stderr + run.stdout).decode("latin-1")
    except subprocess.TimeoutExpired:
        got, said = "none after 10 s", ""
    says = [says] if isinstance(says, str) else says
    never = [never] if isinstance(never, str) else never
    said = said.replace(str(folder), "HOME")
    bad = [f"exit {got}, not {code}"] if got != code else []
    bad += [f"never said: {t}" for t in says if t not in said]
    bad += [f"said: {t}" for t in never if t in said]
    failed += bool(bad)
    print(f"not ok {done} - {title}" if bad else f"ok {done} - {title}")
    for line in bad + (said.splitlines()[:6] if bad else []):
        print("# " + line)
    shutil.rmtree(folder, ignore_errors=True)


def paths():
    """Names that leave the folder of the scene, and those that do not."""
    out = {"out/m.mtl": MTL, "out/t.png": png(), "out/a.obj": USES, "out/e.hdr": hdr()}
    quiet = ("warning", "error")
    for title, name in [("a parent", "../out/m.mtl"), ("an absolute path", "HOME/out/m.mtl"),
                        ("back-slashes", "..\\out\\m.mtl"), ("down and up", "sub/../../out/m.mtl"),
                        ("dots", "./.././out/m.mtl"), ("words of a line", "x.mtl ../out/m.mtl")]:
        files = out | {"in/a.obj": f"mtllib {name}\n" + USES, "in/sub/x": ""}
        row(f"mtllib by {title}", files, "info a.obj", 0,
            ["a.obj:1: material library", "is outside of the folder of the scene, --allow-outside reads it"])
        never = "outside" if "words" in title else quiet
        row(f"mtllib by {title}, allowed", files, "info a.obj " + OUTSIDE, 0, "kd 1 0 0", never)
    for title, more in [("a link", {"in/m.mtl": Link("../out/m.mtl")}),
                        ("a link to a path", {"in/m.mtl": Link("HOME/out/m.mtl")}),
                        ("a link to a link", {"in/m.mtl": Link("n.mtl"), "in/n.mtl": Link("../out/m.mtl")})]:
        files = out | more | {"in/a.obj": "mtllib m.mtl\n" + USES}
        row(f"mtllib by {title}", files, "info a.obj", 0, "m.mtl is outside of the folder", "kd 1 0 0")
        row(f"mtllib by {title}, allowed", files, "info a.obj " + OUTSIDE, 0, "kd 1 0 0", quiet)
    row("a link that stays inside", out | {"in/m.mtl": Link("n.mtl"), "in/n.mtl": MTL, "in/a.obj": "mtllib m.mtl\n" + USES},
        "info a.obj", 0, "kd 1 0 0", quiet)
    row("a link in a circle", {"in/m.mtl": Link("m.mtl"), "in/a.obj": "mtllib m.mtl\n" + USES},
        "info a.obj", 0, "library not found, tried m.mtl")
    row("a folder whose name begins alike", {"in-2/m.mtl": MTL, "in/a.obj": "mtllib ../in-2/m.mtl\n" + USES},
        "info a.obj", 0, "../in-2/m.mtl is outside")
    row("an absolute path inside", {"in/m.mtl": MTL, "in/a.obj": "mtllib HOME/in/m.mtl\n" + USES},
        "info a.obj", 0, "kd 1 0 0", quiet)
    row("a file outside, and its namesake inside",
        {"out/m.mtl": "newmtl m\nKd 0 0 1\n", "in/m.mtl": MTL, "in/a.obj": "mtllib ../out/m.mtl\n" + USES},
        "info a.obj", 0, "kd 1 0 0", quiet)
    row("another case outside is not looked for", {"out/m.mtl": MTL, "in/a.obj": "mtllib ../OUT/M.MTL\n" + USES},
        "info a.obj", 0, "not found, tried ../OUT/M.MTL", "kd 1 0 0")
    row("the folder is that of the file asked for",
        {"in/sub/b.mtl": MTL + "map_Kd ../t.png\n", "in/t.png": png(), "in/a.obj": "mtllib sub/b.mtl\n" + USES},
        "render a.obj -r 8x8 -o o.png", 0, "no warnings")
    row("not that of the file that names",
        {"in/sub/a.obj": "mtllib ../m.mtl\n" + USES, "in/m.mtl": MTL}, "info sub/a.obj", 0, "../m.mtl is outside")
    row("by way of a scene above it",
        {"in/s.scene": "mesh sub/a.obj\n", "in/sub/a.obj": "mtllib ../m.mtl\n" + USES, "in/m.mtl": MTL},
        "info s.scene", 0, "kd 1 0 0", quiet)
    row("from another working folder", {"in/m.mtl": MTL, "in/a.obj": "mtllib m.mtl\n" + USES},
        "info ../in/a.obj", 0, "kd 1 0 0", quiet)
    row("the file itself may be a link", out | {"in/b.obj": Link("../out/a.obj")}, "info b.obj", 0, "triangles 1")
    row("standard input: the working folder", out | {"-": "mtllib ../out/m.mtl\n" + USES}, "info -", 0,
        "standard input:1: material library ../out/m.mtl is outside".replace("standard input", "-"))
    for title, name in [("a parent", "../out/t.png"), ("an absolute path", "HOME/out/t.png")]:
        files = out | {"in/a.obj": "mtllib m.mtl\n" + USES, "in/m.mtl": MTL + f"map_Kd {name}\nmap_Ks {name}\n"}
        row(f"a texture by {title}", files, "render a.obj -r 8x8 -o o.png", 0,
            ["m.mtl:3: texture ", "out/t.png is outside of the folder of the scene, --allow-outside reads it", "1 warning"],
            "m.mtl:4")
        row(f"a texture by {title}, allowed", files, "render a.obj -r 8x8 -o o.png " + OUTSIDE, 0, "no warnings")
    row("a texture by a linked folder",
        out | {"in/a.obj": "mtllib m.mtl\n" + USES, "in/m.mtl": MTL + "map_Kd t/t.png\n", "in/t": Link("../out")},
        "render a.obj -r 8x8 -o o.png", 0, "t/t.png is outside")
    row("is an error with --strict",
        out | {"in/a.obj": "mtllib m.mtl\n" + USES, "in/m.mtl": MTL + "map_Kd ../out/t.png\n"},
        "render a.obj --strict -r 8x8 -o o.png", 1, "outside")
    for what, line in [("mesh", "mesh ../out/a.obj\n"), ("environment", "env ../out/e.hdr\n")]:
        files = out | {"in/s.obj": TRI + "f 1 2 3\n", "in/s.scene": line}
        row(f"{what} of a scene", files, "render s.scene -r 8x8 -o o.png", 3,
            f"s.scene:1: {what} ../out/{'a.obj' if what == 'mesh' else 'e.hdr'} is outside")
        row(f"{what} of a scene, allowed", files, "render s.scene -r 8x8 -o o.png " + OUTSIDE, 0, "o.png")
    row("a texture in a scene", out | {"in/s.obj": USES, "in/s.scene": "newmtl m\nmap_Kd ../out/t.png\n"},
        "render s.scene -r 8x8 -o o.png", 0, "s.scene:2: texture ../out/t.png is outside")
    row("--env is named by the user", out | {"in/a.obj": TRI + "f 1 2 3\n"},
        "render a.obj -r 8x8 -o o.png --env ../out/e.hdr", 0, "no warnings")
    row("a linked scene beside an OBJ", {"in/a.obj": USES, "out/a.scene": "film 8 8\n", "in/a.scene": Link("../out/a.scene")},
        "render a.obj -o o.png", 3, "scene file a.scene is outside")
    row("a linked OBJ beside a scene", out | {"in/s.scene": "film 8 8\n", "in/s.obj": Link("../out/a.obj")},
        "render s.scene -o o.png", 3, "mesh s.obj is outside")
    row("what info --scene prints works elsewhere with the flag",
        {"in/b.scene": "mesh HOME/out/a.obj\n", "out/a.obj": USES}, "info --scene b.scene " + OUTSIDE, 0,
        "# For use in another folder: facet render --allow-outside")


def kinds():
    """What is no regular file is refused at once, whoever reads."""
    for kind, word in [("fifo", "a pipe"), ("socket", ""), ("folder", "a folder")]:
        what = {"in/x.obj": Kind(kind), "in/x.scene2": Kind(kind)}
        row(f"{kind} as OBJ", what, "info x.obj", 3, [word, "x.obj"])
        row(f"{kind} as scene", {"in/x.scene": Kind(kind)}, "render x.scene", 3, [word, "x.scene"])
        row(f"{kind} as picture", {"in/x.png": Kind(kind)}, "info x.png", 3, [word, "x.png"])
        row(f"{kind} as A of compare", {"in/x.png": Kind(kind), "in/y.png": png()}, "compare x.png y.png", 3, word)
        row(f"{kind} as environment", {"in/a.obj": USES, "in/x.hdr": Kind(kind)}, "render a.obj --env x.hdr -o o.png", 3)
        row(f"{kind} as script", {"in/a.obj": USES, "in/x": Kind(kind)}, "view a.obj --script x", 3, word)
        row(f"{kind} as questions", {"in/x": Kind(kind)}, "ibl 1,1,1 --eval x", 3, word)
        row(f"{kind} as rays", {"in/a.obj": USES, "in/x": Kind(kind)}, "bench rays a.obj --rays x", 3, word)
        # A folder is no library, as in a path that ends early.
        row(f"{kind} as library", {"in/a.obj": "mtllib x.mtl\n" + USES, "in/x.mtl": Kind(kind)},
            "render a.obj -r 8x8 -o o.png", 0 if kind == "folder" else 3, "x.mtl")
        row(f"{kind} as texture", {"in/a.obj": "mtllib m.mtl\n" + USES, "in/m.mtl": MTL + "map_Kd x.png", "in/x.png": Kind(kind)},
            "render a.obj -r 8x8 -o o.png", 0, ["m.mtl:3: texture left out: x.png", word])
    for device in ["/dev/zero", "/dev/full", "/dev/tty0", "/dev/stdin"]:
        if os.path.exists(device):
            row(f"{device} as picture", {}, f"info {device}", 3, device)
    row("/dev/zero as library", {"in/a.obj": "mtllib /dev/zero\n" + USES}, "info a.obj", 0, "/dev/zero is outside")
    row("/dev/zero as library, allowed", {"in/a.obj": "mtllib /dev/zero\n" + USES}, "render a.obj -o o.png " + OUTSIDE, 3,
        "/dev/zero: is a device, expected a regular file")
    row("/dev/zero as mesh, allowed", {"in/s.scene": "mesh /dev/zero\n"}, "info s.scene " + OUTSIDE, 3, "is a device")


def terminals():
    """Names are shown without what a terminal would obey."""
    name = "a\x1b]0;title\x07b\x9b2J\xc2\x9b2J\x7f"
    files = {"in/a.obj": f"mtllib {name}\n" + TRI + f"usemtl {name}\nf 1 2 3\n"}
    row("escapes in names", files, "info -v a.obj", 0, "a?]0;title?b", ["\x1b", "\x07", "\xc2\x9b", "\x7f"])
    row("escapes in an error", {"in/a.scene": "mesh a\x1b[2J.obj\n"}, "info a.scene", 3, "a?[2J.obj", "\x1b")


paths()
kinds()
terminals()
print(f"1..{done}")
shutil.rmtree(home, ignore_errors=True)
sys.exit(failed > 0)

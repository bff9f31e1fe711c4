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
import threading
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

# Seconds; sanitizers make everything several times slower.
LONGEST = 60 if os.environ.get("FACET_SANITIZED") else 10


def run(args, folder, stdin):
    """Exit status, peak memory in MB (no less than this script's own), and what
    was said."""
    with open(folder / "said", "w+b") as said, open(folder / "stdin", "w+b") as given:
        given.write(stdin)
        given.seek(0)
        p = subprocess.Popen([facet, *args], cwd=folder / "in", stdin=given, stdout=said, stderr=said)
        killer = threading.Timer(LONGEST, p.kill)
        killer.start()
        _, status, usage = os.wait4(p.pid, 0)
        killer.cancel()
        p.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        return p.returncode, usage.ru_maxrss // 1024, said.read().decode("latin-1")


def row(title, files, args, code, says=(), never=(), most=None):
    """One test: facet ARGS with these files, in the folder in/ beside which
    lies out/; in at most so many MB of memory."""
    global done, failed
    done += 1
    folder = home / str(done)
    (folder / "in").mkdir(parents=True)
    make(folder, {k: v for k, v in files.items() if k != "-"})
    args = [a.replace("HOME", str(folder)) for a in args.split()]
    stdin = files.get("-", b"")
    got, peak, said = run(args, folder, stdin if isinstance(stdin, bytes) else stdin.encode())
    says = [says] if isinstance(says, str) else says
    never = [never] if isinstance(never, str) else never
    said = said.replace(str(folder), "HOME")
    bad = [f"exit {got}, not {code}"] if got != code else []
    bad += [f"{peak} MB, more than {most}"] if most is not None and peak > most else []
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
    quiet = ("warning:", "facet: error:")
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
        row(f"{kind} as part", {"in/x.part": Kind(kind)}, "merge x.part -o o.png", 3, [word, "x.part"])
        row(f"{kind} as checkpoint", {"in/a.obj": USES, "in/x": Kind(kind)},
            "render a.obj --engine path -r 8x8 --spp 1 --checkpoint x --resume -o o.png", 4 if kind == "folder" else 3,
            "x: cannot be written: Is a directory" if kind == "folder" else word)
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


def objs():
    """OBJ files that are broken, or only odd."""
    big = 1 << 31
    table = [
        # title, text, exit, says
        ("nothing at all", "", 3, "no faces"),
        ("blanks only", " \n\t\n\r\r\n", 3, "no faces"),
        ("zeros only", "\0" * 100, 3, "no faces"),
        ("bytes only", "".join(map(chr, range(256))) * 4, 3, "a.obj: nothing to render"),
        ("vertices, no faces", TRI, 3, "no faces"),
        ("a face before its vertices", "f 1 2 3\n" + TRI, 0, "no warnings"),
        ("an index beyond the end", TRI + "f 1 2 4\n", 3, "a.obj:4:"),
        ("index 0", TRI + "f 0 1 2\n", 3, "a.obj:4:"),
        ("an index before the start", TRI + "f -1 -2 -4\n", 3, "a.obj:4:"),
        ("2^31", TRI + f"f 1 2 {big}\n", 3, "a.obj:4:"),
        ("-2^31", TRI + f"f 1 2 -{big}\n", 3, "a.obj:4:"),
        ("2^32 + 1", TRI + f"f 1 2 {2 * big + 1}\n", 3, "a.obj:4:"),
        ("2^64 + 1", TRI + f"f 1 2 {1 + (1 << 64)}\n", 3, "a.obj:4:"),
        ("30 digits", TRI + "f 1 2 " + "9" * 30 + "\n", 3, "a.obj:4:"),
        ("a fraction", TRI + "f 1.5 2 3\n", 3, "a.obj:4: malformed"),
        ("a word", TRI + "f 1 two 3\n", 3, 'a.obj:4: malformed corner "two"'),
        ("four parts", TRI + "f 1/1/1/1 2 3\n", 3, "a.obj:4: malformed"),
        ("slashes only", TRI + "f / // ///\n", 3, "a.obj:4: malformed"),
        ("a texture index that is a word", TRI + "f 1/x 2 3\n", 3, "a.obj:4: malformed"),
        ("a texture index beyond the end", TRI + "vt 0 0\nf 1/9 2/1 3/1\n", 0, "texture coordinate that does not exist"),
        ("a normal index beyond the end", TRI + "vn 0 0 1\nf 1//9 2//1 3//1\n", 0, "normal that does not exist"),
        ("two corners", TRI + "f 1 2\nf 1 2 3\n", 0, "a.obj:4: 1 face with fewer than 3 corners skipped"),
        ("no corners", TRI + "f\nf 1 2 3\n", 0, "fewer than 3 corners"),
        ("one corner three times", TRI + "f 1 1 1\n", 0, "without area, which nothing can hit"),
        ("a negative and a positive index", TRI + "f 1 -2 3\n", 0, "no warnings"),
        ("a number that is a word", "v 0 zero 0\n", 3, 'a.obj:1: malformed number "zero"'),
        ("a hexadecimal number", "v 0x10 0 0\n", 3, "a.obj:1: malformed number"),
        ("a comma", "v 0,5 0 0\n", 3, "a.obj:1: malformed number"),
        ("two points", "v 1.2.3 0 0\n", 3, "a.obj:1: malformed number"),
        ("an exponent without digits", "v 1e 0 0\n", 3, "a.obj:1: malformed number"),
        ("two numbers", "v 0 0\n", 3, "a.obj:1: too few numbers"),
        ("no numbers", "v\n", 3, "a.obj:1: too few numbers"),
        ("seven numbers", "v 0 0 0 1 1 1 1\n" + TRI + "f 1 2 3\n", 0, "triangles"),
        ("a normal of two", TRI + "vn 0 1\n", 3, "a.obj:4: too few numbers"),
        ("not a number", TRI + "v nan 0 0\nf 1 2 3\n", 0, "a.obj:4: 1 vertex with a number that is not finite"),
        ("infinity", TRI + "v inf -inf 0\nf 1 2 3\n", 0, "not finite"),
        ("a triangle with NaN", TRI + "v nan 0 0\nf 1 2 4\nf 1 2 3\n", 0, "not finite"),
        ("all is NaN", "v nan nan nan\n" * 3 + "f 1 2 3\n", 0, "not finite"),
        ("numbers too large", "v 1e999 0 0\n" + TRI + "f 1 2 3\n", 0, "not finite"),
        ("the largest floats", "v 3e38 0 0\nv -3e38 0 0\nv 0 3e38 0\nf 1 2 3\n", 3,
         ["a.obj:1: 3 vertices beyond 1e37",
          "a.obj: too large to be seen whole, from -3e+38 0 0 to 3e+38 3e+38 0; expected coordinates well below 1e37"]),
        ("the smallest floats", "v 1e-45 0 0\nv 0 1e-45 0\nv 0 0 1e-45\nf 1 2 3\n", 0, "a"),
        ("a million digits", "v 0." + "3" * 1000000 + " 0 0\n" + TRI + "f 2 3 4\n", 0, "no warnings"),
        ("a line of a megabyte", "# " + "x" * (1 << 20) + "\n" + TRI + "f 1 2 3\n", 0, "no warnings"),
        ("a name of a megabyte", TRI + "o " + "x" * (1 << 20) + "\nf 1 2 3\n", 0, "no warnings"),
        ("a library of a megabyte", "mtllib " + "x" * (1 << 20) + "\n" + TRI + "f 1 2 3\n", 0, "library not found"),
        ("libraries without number", "mtllib " + "a b " * (1 << 17) + "\n" + TRI + "f 1 2 3\n", 0, "library not found"),
        ("lines of libraries", "mtllib a\n" * 50000 + TRI + "f 1 2 3\n", 0, "1 warning"),
        ("continued for ever", TRI + "f 1 2 3 " + "\\\n" * 300000, 0, "no warnings"),
        ("a backslash at the end", TRI + "f 1 2 3\\", 0, "no warnings"),
        ("no end of line at the end", TRI + "f 1 2 3", 0, "no warnings"),
        ("carriage returns only", (TRI + "f 1 2 3\n").replace("\n", "\r"), 0, "no warnings"),
        ("a byte-order mark", "\xef\xbb\xbf" + TRI + "f 1 2 3\n", 0, "no warnings"),
        ("UTF-16", "\xff\xfev\0 \0001\0\n\0", 3, "a.obj: nothing to render"),
        ("a NUL in a word", TRI + "f 1 2\0 3\n", 0, "no warnings"),
        ("a NUL in a name", TRI + "usemtl a\0b\nf 1 2 3\n", 0, "a b"),
        ("a face of 100,000 corners", TRI + "f " + "1 2 3 " * 33334 + "\n", 0, "triangles"),
        ("100,000 materials", TRI + "".join(f"usemtl {i}\n" for i in range(100000)) + "f 1 2 3\n", 0, "warning"),
        ("100,000 groups of a face", TRI + "".join(f"g {i}\nf 1 2 3\n" for i in range(100000)), 0, "100000 triangles"),
        ("a smoothing group that is a word", TRI + "s round\nf 1 2 3\n", 0, "smoothing group that is no number"),
        ("a smoothing group beyond counting", TRI + "s 99999999999999999999\nf 1 2 3\n", 0, "a"),
        ("curves and surfaces", TRI + "cstype bezier\ndeg 3\nsurf 0 1 0 1 1 2 3\nend\nf 1 2 3\n", 0, "no warnings"),
        ("unknown statements", TRI + "frob 1\n" * 1000 + "f 1 2 3\n", 0, "no warnings"),
        ("HTML", "<!DOCTYPE html>\n<html><body>404 Not Found</body></html>\n", 3, "nothing to render"),
        ("a picture called .obj", png().decode("latin-1"), 3, "a.obj: nothing to render"),
    ]
    for title, text, code, says in table:
        row(f"OBJ: {title}", {"in/a.obj": text.encode("latin-1")}, "render a.obj -r 8x8 --engine path --spp 1 -o o.png", code, says,
            most=128 + len(text) // 4000)


def mtls():
    """The same for libraries; the OBJ uses material m."""
    table = [
        ("nothing at all", "", 0, 'material "m" is not defined'),
        ("bytes only", "".join(map(chr, range(256))), 0, "warning"),
        ("a statement before newmtl", "Kd 1 0 0\n" + MTL, 0, "m.mtl:1: statement before the first newmtl skipped"),
        ("newmtl without a name", "newmtl\n" + MTL, 0, "m.mtl:1: newmtl without a name"),
        ("a material twice", MTL + MTL, 0, 'm.mtl:3: material "m" again, this one counts'),
        ("a colour of a word", "newmtl m\nKd red\n", 3, 'm.mtl:2: Kd: malformed number "red"'),
        ("a colour of two numbers", "newmtl m\nKd 1 0\n", 3, "m.mtl:2: Kd has 2 numbers, expected 1 or 3"),
        ("a colour of none", "newmtl m\nKd\n", 3, "m.mtl:2: Kd has 0 numbers"),
        ("a colour of four", "newmtl m\nKd 1 0 0 1\n", 0, "no warnings"),
        ("a colour that is not a number", "newmtl m\nKd nan 0 0\n", 0, "m.mtl:2: Kd is not finite"),
        ("a colour below black", "newmtl m\nKd -1 0 0\n", 0, "a"),
        ("light without end", "newmtl m\nKe inf inf inf\n", 0, "m.mtl:2: Ke is not finite"),
        ("light of 1e38", "newmtl m\nKe 1e38 1e38 1e38\n", 0, "a"),
        ("a number without one", "newmtl m\nNs\n", 3, "m.mtl:2: Ns without its number"),
        ("a number that is a word", "newmtl m\nNs shiny\n", 3, 'm.mtl:2: Ns: malformed number "shiny"'),
        ("an exponent below 0", "newmtl m\nKs 1 1 1\nNs -5\n", 0, "a"),
        ("glass of index 0", "newmtl m\nillum 7\nNi 0\n", 0, "a"),
        ("glass of index NaN", "newmtl m\nillum 7\nNi nan\n", 0, "not finite"),
        ("illum 11", "newmtl m\nillum 11\n", 0, "m.mtl:2: illum is no model, expected 0 to 10"),
        ("illum 1.5", "newmtl m\nillum 1.5\n", 0, "illum is no model"),
        ("illum of a word", "newmtl m\nillum metal\n", 3, "m.mtl:2: illum: malformed number"),
        ("d and Tr at odds", "newmtl m\nd 0.2\nTr 0.2\n", 0, "m.mtl:3: d and Tr contradict each other"),
        ("roughness 7, metallic -3", "newmtl m\nPr 7\nPm -3\n", 0, "a"),
        ("a texture without a file", "newmtl m\nmap_Kd\n", 0, "m.mtl:2: texture without a file name"),
        ("a texture that is not there", "newmtl m\nmap_Kd none.png\n", 0, "m.mtl:2: texture left out: none.png"),
        ("an option without its number", "newmtl m\nmap_Kd -s x.png\n", 3, "m.mtl:2: -s without its number"),
        ("an option without its word", "newmtl m\nmap_Kd -clamp maybe x.png\n", 3, 'm.mtl:2: -clamp "maybe", expected on or off'),
        ("a channel that is none", "newmtl m\nmap_d -imfchan q x.png\n", 3, "m.mtl:2: -imfchan"),
        ("options only", "newmtl m\nmap_Kd -clamp on\n", 0, "texture without a file name"),
        ("100,000 options", "newmtl m\nmap_Kd " + "-clamp on " * 100000 + "x.png\n", 0, "texture left out"),
        ("an unknown statement", "newmtl m\nfrob 1\n", 0, "no warnings"),
        ("50,000 materials", "".join(f"newmtl {i}\n" for i in range(50000)) + MTL, 0, "no warnings"),
        ("textures that are not there", MTL + "".join(f"map_K{k} {'./' * 500}x{k}.png\n" for k in "ades"), 0, "texture left out"),
        ("a texture that is text", "newmtl m\nmap_Kd a.obj\n", 0, "m.mtl:2: texture left out: a.obj: not a picture"),
        ("a texture that is the library", "newmtl m\nmap_Kd m.mtl\n", 0, "texture left out: m.mtl: not a picture"),
    ]
    for title, text, code, says in table:
        files = {"in/m.mtl": text.encode("latin-1"), "in/a.obj": "mtllib m.mtl\n" + USES}
        row(f"MTL: {title}", files, "render a.obj -r 8x8 --engine path --spp 1 -o o.png", code, says, most=128 + len(text) // 4000)
    row("MTL: itself as its OBJ", {"in/a.obj": "mtllib a.obj\n" + USES}, "render a.obj -r 8x8 -o o.png", 0, "warning")


def scenes():
    """Scene files: ours to define, so what is odd is an error."""
    one = {"in/t.obj": TRI + "o ball\nf 1 2 3\n"}
    table = [
        ("nothing at all, and no OBJ", "", "s.obj: "),
        ("an unknown statement", "mehs t.obj\n", 's.scene:1: unknown statement "mehs", expected "mesh"?'),
        ("a mesh that is not there", "mesh x.obj\n", "s.scene:1: mesh not found, tried x.obj"),
        ("a mesh without a name", "mesh\n", "s.scene:1: mesh: expected a name"),
        ("scale 0", "mesh t.obj scale 0\n", "s.scene:1: mesh: 0 is not above 0"),
        ("up X", "mesh t.obj up X\n", "s.scene:1: mesh: expected Y or Z"),
        ("eye outside a camera", "eye 0 0 1\n", "s.scene:1: eye outside a camera"),
        ("a camera without an eye", "mesh t.obj\ncamera c\ntarget 0 0 0\n", "s.scene: camera c: no eye"),
        ("an eye that is nowhere", "camera c\neye nan 0 0\n", "s.scene:2: eye: expected a finite number"),
        ("fov 180", "camera c\nfov 180\n", "s.scene:2: fov"),
        ("two cameras of a name", "camera c\ncamera c\n", 's.scene:2: a second camera "c"'),
        ("a light of no kind", "light spot 0 0 0\n", "s.scene:1: light: expected point or dir"),
        ("a light below 0", "light point 0 0 0 intensity -1 0 0\n", "s.scene:1: light: -1 is below 0"),
        ("a direction of no length", "light dir 0 0 0 irradiance 1 1 1\n", "s.scene:1: light: a direction of length 0"),
        ("an environment that is not there", "mesh t.obj\nenv x.hdr\n", "s.scene:2: environment not found, tried x.hdr"),
        ("an environment that is text", "mesh t.obj\nenv t.obj\n", "t.obj: not a picture"),
        ("film 0", "film 0 10\n", "s.scene:1: film: 0 is not in 1..65535"),
        ("a film of 4 gigapixels", "film 65535 65535\n", "s.scene:1: film: 65535 x 65535 has more than 67108864 pixels"),
        ("assign to nothing", "mesh t.obj\nassign gold object ball\n", 's.scene:2: assign: no material "gold"'),
        ("assign by nothing", "newmtl gold\nassign gold ball\n", "s.scene:2: assign: expected object or material"),
        ("Kd outside a material", "Kd 1 1 1\n", "s.scene:1: Kd outside a material"),
        ("two materials of a name", "newmtl m\nnewmtl m\n", 's.scene:2: a second newmtl "m"'),
        ("5,000 meshes", "mesh t.obj\n" * 5000, "s.scene:4097: more than 4096 mesh statements"),
        ("5,000 cameras", "".join(f"camera {i}\n" for i in range(5000)), "more than 4096 camera statements"),
        ("5,000 materials", "".join(f"newmtl {i}\n" for i in range(5000)), "more than 4096 newmtl statements"),
        ("600 assigns", "newmtl m\n" + "assign m object x\n" * 600, "s.scene:514: more than 512 assign statements"),
        ("70,000 lights", "light point 0 0 0 intensity 1 1 1\n" * 70000, "more than 65536 light statements"),
        ("bytes only", "".join(map(chr, range(128, 256))), "s.scene:1: unknown statement"),
    ]
    for title, text, says in table:
        row(f"scene: {title}", one | {"in/s.scene": text.encode("latin-1")}, "render s.scene -r 8x8 --engine path --spp 1 -o o.png", 3,
            says, most=128)
    row("scene: a mesh of itself", one | {"in/s.scene": "mesh s.scene\n"}, "render s.scene -r 8x8 -o o.png", 0, "no faces")
    stars = one | {"in/s.scene": "mesh t.obj\nnewmtl m\nassign m object " + "*b" * 300 + "*x\n", "in/t.obj": TRI + "o " + "b" * 3000 + "\nf 1 2 3\n"}
    row("scene: a pattern of stars", stars, "render s.scene -r 8x8 --engine path --spp 1 -o o.png", 0, "no warnings")


def pictures():
    """Pictures that are not what they say, by facet info."""
    good = png()
    idat = zlib.compress(b"\0" * 100000, 9)
    table = [
        ("png", "nothing at all", b"", "nor a picture"),
        ("png", "text", b"hello\n", "nor a picture"),
        ("png", "its signature only", good[:8], "not a whole PNG file"),
        ("png", "no pixels", png(tail=chunk(b"IEND", b"")), "not a whole PNG file"),
        ("png", "cut short", good[:-14], "not a whole PNG file"),
        ("png", "a wrong checksum", good[:-5] + b"\0" + good[-4:], "not a whole PNG file"),
        ("png", "width 0", png(0, 1), "not a whole PNG file"),
        ("png", "65,536 wide", png(65536, 1), "not a whole PNG file"),
        ("png", "2^31 high", png(1, 1 << 31), "not a whole PNG file"),
        ("png", "3 bits", png(depth=3), "not a whole PNG file"),
        ("png", "colour type 5", png(colour=5), "not a whole PNG file"),
        ("png", "a palette without one", png(colour=3, rows=b"\0\1"), "not a whole PNG file"),
        ("png", "a claim of 4 gigapixels", png(65535, 65535), "too short for its width and height"),
        ("png", "no compression", png(tail=chunk(b"IDAT", b"junkjunk") + chunk(b"IEND", b"")), "not a whole PNG file"),
        ("png", "a text of a gigabyte", png(tail=struct.pack(">I", 1 << 30) + b"tEXtTitle"), "not a whole PNG file"),
        ("png", "an unknown critical chunk", png(tail=chunk(b"ABCD", b"")), "not a whole PNG file"),
        ("hdr", "its signature only", b"#?RADIANCE\n", "header ends early"),
        ("hdr", "no size", b"#?RADIANCE\n\n", "bad Radiance size"),
        ("hdr", "another format", hdr(head=b"FORMAT=16-bit\n"), "FORMAT=16-bit, expected"),
        ("hdr", "size 0", hdr(b"-Y 0 +X 1"), "bad Radiance size"),
        ("hdr", "a size of words", hdr(b"-Y one +X 1"), "bad Radiance size"),
        ("hdr", "both axes alike", hdr(b"-Y 1 +Y 1"), "bad Radiance size"),
        ("hdr", "an exposure of 0", hdr(head=b"EXPOSURE=0\n"), "expected a positive number"),
        ("hdr", "a claim of 4 gigapixels", hdr(b"-Y 65535 +X 65535"), "too short for its width and height"),
        ("hdr", "a run of nothing", hdr(b"-Y 1 +X 8", b"\2\2\0\10\0\0\0\0"), "a run leaves its scanline"),
        ("hdr", "a run too long", hdr(b"-Y 1 +X 8", b"\2\2\0\10\377\0\0\0"), "a run leaves its scanline"),
        ("hdr", "a run of no pixel", hdr(b"-Y 1 +X 2", b"\1\1\1\2\0\0\0\0"), "a run repeats nothing"),
        ("hdr", "another width in a row", hdr(b"-Y 1 +X 8", b"\2\2\0\11\0\0\0\0"), "announces another width"),
        ("pfm", "its signature only", b"PF\n", "bad PFM header"),
        ("pfm", "a width of a word", pfm(b"PF\nx 1\n-1\n"), "bad PFM header"),
        ("pfm", "scale 0", pfm(b"PF\n1 1\n0\n"), "expected a scale"),
        ("pfm", "cut short", pfm(body=b"1234"), "PFM ends early, 4 bytes of pixels"),
        ("pfm", "a claim of 4 gigapixels", pfm(b"PF\n65535 65535\n-1\n"), "PFM ends early"),
        ("jpg", "its signature only", b"\xff\xd8\xff", "not a whole JPEG file"),
        ("jpg", "a marker cut short", b"\xff\xd8\xff\xe0\0\x10JFIF", "not a whole JPEG file"),
        ("jpg", "a claim of 4 gigapixels", b"\xff\xd8\xff\xc0\0\x0b\x08\xff\xff\xff\xff\1\1\x11\0\xff\xda", "not a whole JPEG file"),
        ("tga", "its header only", tga(2, 4, 4, 24), "too short for its width and height"),
        ("tga", "width 0", tga(2, 0, 4, 24), "nor a picture"),
        ("tga", "13 bits", tga(2, 4, 4, 13), "nor a picture"),
        ("tga", "a claim of 4 gigapixels", tga(10, 65535, 65535, 24, b"\xff\0\0\0"), "too short for its width and height"),
        ("tga", "a run too long", tga(10, 2, 2, 24, b"\xff\1\2\3"), "a run of pixels leaves the picture"),
        ("tga", "a palette cut short", tga(1, 1, 1, 8, b"\0", palette=1, entries=9, entry=24), "ends in its palette"),
        ("tga", "an index outside the palette", tga(1, 1, 1, 8, b"\1\2\3\7", palette=1, entries=1, entry=24), "outside the palette"),
    ]
    for suffix, title, data, says in table:
        row(f"{suffix}: {title}", {f"in/x.{suffix}": data}, f"info x.{suffix}", 3, [f"x.{suffix}: ", says], most=128)
    for title, data in [("inf", struct.pack("<3f", float("inf"), 1, 1)), ("nan", struct.pack("<3f", float("nan"), 1, 1)),
                        ("below 0", struct.pack("<3f", -1, 1, 1))]:
        row(f"pfm: {title} in an environment", {"in/a.obj": TRI + "f 1 2 3\n", "in/e.pfm": pfm(body=data)},
            "render a.obj -r 8x8 --env e.pfm -o o.png", 0, "e.pfm: 1 of 1 pixels have negative or non-finite values")
    # What compresses as hard as it can: memory in proportion to the file.
    side = 4000
    flat = png(side, side, 8, 0, b"\0" * (side + 1) * side)
    row("a PNG of nothing but black", {"in/x.png": flat}, "info x.png", 0, f"{side} x {side}", most=128 + 14000 * len(flat) // 1000000)
    side = 20000
    bits = png(side, side, 1, 0, b"\0" * (side // 8 + 1) * side)
    row("one of single bits", {"in/x.png": bits}, "info x.png", 3, "too short for its width and height", most=128)
    long = hdr(b"-Y 4096 +X 65535", b"".join([b"\0\0\0\1" + b"\1\1\1\xff" + b"\1\1\1\xff"] * 4096))
    row("an HDR of long runs", {"in/x.hdr": long}, "info x.hdr", 3, "too short for its width and height", most=128)


def seeds():
    """The fuzzers' seeds are those of the script that says how they are made."""
    global done, failed
    done += 1
    sys.path.insert(0, "tests/fuzz")
    sys.dont_write_bytecode = True
    import seeds as made
    bad = [f"{kind}/{name}" for kinds in (made.PICTURES, made.TEXTS) for kind, files in kinds.items()
           for name, data in files.items() if pathlib.Path("tests/fuzz/seeds", kind, name).read_bytes() != data]
    failed += bool(bad)
    print(f"{'not ' if bad else ''}ok {done} - seeds of the fuzzers {' '.join(bad)}")


paths()
kinds()
terminals()
seeds()
objs()
mtls()
scenes()
pictures()
print(f"1..{done}")
shutil.rmtree(home, ignore_errors=True)
sys.exit(failed > 0)

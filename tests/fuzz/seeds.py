#!/usr/bin/env python3
"""The seeds of the fuzzers, small files of every format and flavour:

    tests/fuzz/seeds.py FOLDER     writes FOLDER/obj/... and so on

Nothing is drawn by chance: the same files every time, those of tests/fuzz/seeds.
JPEG files need an encoder, which Python's own library has not: jpeg_seeds.c has one.  Those of
part are facet's: of --shard 1/1, of --shard 2/2 --aov normal,depth, and a
--checkpoint with --error."""
import pathlib
import struct
import sys
import zlib


def chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def png(width, height, depth, colour, rows, extra=b"", interlace=0):
    head = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, interlace)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + extra + chunk(b"IDAT", zlib.compress(rows, 9))
            + chunk(b"IEND", b""))


def ramp(n):
    return bytes(i * 37 & 255 for i in range(n))


def png_rows(row_bytes, height):
    return b"".join(bytes([y % 5]) + ramp(row_bytes) for y in range(height))


def tga(kind, width, height, bits, body, flags=0, palette=b"", entry=0, name=b""):
    n = len(palette) // ((entry + 7) // 8) if palette else 0
    return (bytes([len(name), 1 if palette else 0, kind]) + struct.pack("<HHB", 0, n, entry)
            + struct.pack("<HHHHBB", 0, 0, width, height, bits, flags) + name + palette + body)


def hdr(width, height, body, size=None, extra=b""):
    size = size or b"-Y %d +X %d" % (height, width)
    return b"#?RADIANCE\n" + extra + b"FORMAT=32-bit_rle_rgbe\n\n" + size + b"\n" + body


def hdr_runs(width, height):
    row = b"".join(bytes([128 + width, 60 + c]) for c in range(4))
    return (bytes([2, 2, width >> 8, width & 255]) + row) * height


PICTURES = {
    "png": {
        "grey1": png(9, 3, 1, 0, png_rows(2, 3)),
        "grey8": png(4, 5, 8, 0, png_rows(4, 5)),
        "grey16": png(3, 2, 16, 0, png_rows(6, 2)),
        "rgb8": png(3, 5, 8, 2, png_rows(9, 5)),
        "rgb16": png(2, 2, 16, 2, png_rows(12, 2)),
        "palette4": png(5, 2, 4, 3, png_rows(3, 2).replace(b"\xff", b"\x00"),
                        chunk(b"PLTE", ramp(48)) + chunk(b"tRNS", ramp(7))),
        "greyalpha8": png(3, 2, 8, 4, png_rows(6, 2)),
        "rgba8": png(2, 3, 8, 6, png_rows(8, 3), chunk(b"gAMA", struct.pack(">I", 45455))),
        "interlaced": png(1, 1, 8, 2, png_rows(3, 1), chunk(b"tEXt", b"Title\0x"), 1),
    },
    "hdr": {
        "flat": hdr(2, 2, ramp(16)),
        "runs": hdr(9, 2, hdr_runs(9, 2)),
        "old": hdr(12, 1, bytes([9, 8, 7, 128, 1, 1, 1, 11])),
        "exposed": hdr(2, 1, ramp(8), extra=b"EXPOSURE=2.5e-1\nCOLORCORR=1 .5 2\n# comment\n"),
        "turned": hdr(2, 3, ramp(24), b"+X 2 -Y 3"),
        "xyz": b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n" + bytes([128, 64, 32, 129]),
    },
    "pfm": {
        "colour": b"PF\n2 2\n-1.0\n" + struct.pack("<12f", *range(12)),
        "grey": b"Pf\n3 1\n1\n" + struct.pack(">3f", 0.5, 1e30, -1),
        "odd": b"PF 1 1 -1e0\n" + struct.pack("<3f", float("inf"), float("nan"), 1),
    },
    "tga": {
        "bgr": tga(2, 3, 2, 24, ramp(18)),
        "bgra": tga(2, 2, 2, 32, ramp(16), 0x28),
        "five": tga(2, 2, 2, 16, ramp(8), 0x10),
        "grey": tga(3, 4, 2, 8, ramp(8), name=b"name"),
        "palette": tga(1, 3, 2, 8, bytes([0, 1, 2, 2, 1, 0]), palette=ramp(9), entry=24),
        "runs": tga(10, 5, 2, 24, bytes([0x84, 1, 2, 3, 0x04]) + ramp(15)),
        "greyruns": tga(11, 5, 2, 8, bytes([0x89, 7])),
    },
}

TEXTS = {
    "obj": {
        # The first byte is the size of pieces, from 128 on one for all.
        "cube": b"\x80# cube\nmtllib a.mtl b.mtl\no box\ng left right\nusemtl red stone\ns 1\n"
                b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1 1 0.5 0.25\nvt 0 0\nvt 1 0 0.5\nvn 0 0 1\n"
                b"f 1/1/1 2/2/1 3/1/1 4/2/1\nf -5//-1 -4//-1 -1//-1\ns off\nf 1/1 2/2 5/1\nl 1 2 3\np 4\n",
        "pieces": b"\x07v 0 0 0\r\nv 1 0 0\r\nv 1 1 \\\r\n 0\rv 0 1 0\n\xef\xbb\xbf\nf 1 2 3 4\nf 1 2 \\\n3",
        "concave": b"\x10v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nv 1e-3 1E+2 -.5\nf 1 2 3 4 5\nf 1 4 2 5 3 6\n",
        "numbers": b"\x80v 1e38 -1e-45 +0.1\nv nan inf -inf\nv 123456789012345678901234567890 .5 5.\n"
                   b"v 0.1 0.2 0.3 4 5 6\nf 1 2 3\n",
        "curves": b"\x80vp 0 1\ncstype bezier\ndeg 3\ncurv 0 1 1 2\nparm u 0 1\nend\nsh\nfoo bar\nf 1\nf\n",
    },
    "mtl": {
        "all": b"# m\nnewmtl red stone\nKa 1 0 0\nKd 0.8\nKs 0 0 0\nKe 1 2 3\nTf 1 1 1\nNs 96.1\nNi 1.45\nd 0.5\n"
               b"Tr 0.5\nPr 0.3\nPm 1\nillum 7\nmap_Kd -s 2 2 1 -o .5 0 -clamp on a b.png\n"
               b"map_Bump -bm 0.3 -imfchan r \"n.png\"\nnorm -mm 0 1 -texres 8 -type cube_top n.png\n"
               b"map_d -halo d.tga\nrefl x\nnewmtl red stone\nd -halo 1\nKd spectral a.rfl\nKs xyz 1 1 1\n",
        "early": b"Kd 1 1 1\nnewmtl\nKd 1 1\n",
        "crlf": b"\xef\xbb\xbfnewmtl a\r\nKd 1 1 \\\r\n1\rmap_Kd\r\nmap_Kd -s a\r\n",
    },
    "scene": {
        "all": b"mesh a b.obj scale 2 up Z\nmesh \"scale up.obj\"\ncamera main\neye 0 1 2\ntarget 0 0 0\nup 0 1 0\n"
               b"fov 40\nenv dusk.hdr rotate 90 scale 0.7\nlight point 1 2 3 intensity 4 5 6\n"
               b"light dir 0 -1 0 irradiance 1 1 1\nnewmtl gold\nKd 1 .8 .2\nPm 1\nPs 1\nmap_Kd t.png\n"
               b"assign gold object *ball*\nassign gold material [a-c]?\nfilm 640 480\nexposure -1.5\n",
        "env": b"env constant 1 2 3 scale 2 # c\nenv none\nenv sky rotate -10\n",
        "slips": b"camera c\neye 0 0 nan\nmehs a.obj\nfilm 0 70000\n",
    },
    "option": {
        "render": b"render\na.obj\n-o\nx.png\n--engine=path\n-r\n640x480\n-qj4\n--eye\n1,2,3\n--aov=normal,depth\n",
        "error": b"bench\nerror\ns.scene\n--spp\n1,4,16\n--crop=0,0,4,4\n--\n-x\n",
        "raster": b"bench\nraster\ns.scene\n-r\n8x4,16x8\n--post\nfrosted=3\n",
        "compare": b"compare\na\nb\n--metric\nrelmse\n--fail\n1e-3\n--diff=d.png\nfrosted=3",
        "slips": b"rendr\nrender\n--spq\n--shading\nalbdo\n--strict=1\n",
    },
    "script": {
        "all": b"key w down # go\nwait 0.5\nkey w up\nmouse 10 -3.5\nspp 4\nframe \"a b.png\"\nkey space\nkey f12\n",
        "slips": b"key x\nwait -1\nspp 0\nframe\nmouse 1\n",
    },
}


def main():
    out = pathlib.Path(sys.argv[1])
    for kinds in (PICTURES, TEXTS):
        for kind, files in kinds.items():
            (out / kind).mkdir(parents=True, exist_ok=True)
            for name, data in files.items():
                (out / kind / name).write_bytes(data)


if __name__ == "__main__":
    main()

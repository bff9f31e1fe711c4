"""What the sky scripts share: writing a Radiance picture."""
import math
import pathlib


def rgbe(color):
    """Three mantissas and the shared exponent of the largest."""
    mantissa, exponent = math.frexp(max(color))
    scale = mantissa * 256 / max(color)
    return [min(255, round(c * scale)) for c in color] + [exponent + 128]


def run_lengths(values):
    """One component of a row: runs of 4 and more equal values, and the rest."""
    out, i, plain = bytearray(), 0, []
    while i <= len(values):
        n = 1
        while i + n < len(values) and n < 127 and values[i + n] == values[i]:
            n += 1
        if plain and (i == len(values) or n >= 4 or len(plain) == 128):
            out += bytes([len(plain), *plain])
            plain = []
        if i == len(values):
            break
        if n >= 4:
            out += bytes([128 + n, values[i]])
            i += n
        else:
            plain.append(values[i])
            i += 1
    return out


def write(name, width, height, radiance):
    """The picture beside this script whose pixel (x, y) is radiance(x, y)."""
    data = bytearray(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width))
    for y in range(height):
        pixels = [rgbe(radiance(x, y)) for x in range(width)]
        data += bytes([2, 2, width >> 8, width & 255])
        for component in zip(*pixels):
            data += run_lengths(component)
    (pathlib.Path(__file__).resolve().parent / name).write_bytes(data)

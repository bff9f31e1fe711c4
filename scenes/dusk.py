"""The sky of the garden half an hour after sunset, as an equirectangular
Radiance picture.

    python3 scenes/dusk.py

Row 0 is straight up, the middle of a row is -Z.  No measured sky: a blue that
darkens upwards, and a glow on the horizon about where the sun went down.
"""
import math

import hdrfile

WIDTH, HEIGHT = 256, 128
SUNSET = math.radians(24)  # from -Z towards +X

ZENITH = (0.13, 0.17, 0.34)
HORIZON = (0.56, 0.40, 0.34)
GLOW = (0.95, 0.50, 0.22)
EMBER = (0.55, 0.10, 0.00)  # a thin red line below the glow
GROUND = (0.035, 0.035, 0.03)


def radiance(azimuth, elevation):
    if elevation < 0:
        return GROUND
    near = 0.5 + 0.5 * math.cos(azimuth - SUNSET)  # 1 at the sunset, 0 opposite
    up = 1 - math.exp(-3.2 * math.sin(elevation))
    glow = near ** 3 * math.exp(-elevation / 0.30)
    ember = near ** 5 * math.exp(-elevation / 0.08)
    return tuple((h + (z - h) * up) * (1 - glow) + g * glow + e * ember
                 for z, h, g, e in zip(ZENITH, HORIZON, GLOW, EMBER))


hdrfile.write("dusk.hdr", WIDTH, HEIGHT,
              lambda x, y: radiance(((x + 0.5) / WIDTH - 0.5) * 2 * math.pi,
                                    (0.5 - (y + 0.5) / HEIGHT) * math.pi))

"""A clear afternoon with its sun, as an equirectangular Radiance picture.

    python3 scenes/sky.py

Row 0 is straight up, the middle of a row is -Z.  The colours are chosen by eye;
the shape is that of the CIE clear sky: darker upwards and away from the sun,
brighter towards the horizon.  The sun is half a degree wide and as bright as
makes it give the ground about twice the light that the sky gives.
"""
import math

import hdrfile

WIDTH, HEIGHT = 1024, 512
SUN_AZIMUTH = math.radians(-52)  # from -Z towards +X
SUN_HEIGHT = math.radians(34)
SUN_RADIUS = math.radians(0.265)
SUN = (46000, 41000, 33000)

ZENITH = (0.13, 0.26, 0.62)
HORIZON = (0.72, 0.82, 0.95)
HALO = (1.3, 1.15, 0.85)
GROUND = (0.21, 0.18, 0.14)
FAR_GROUND = (0.34, 0.33, 0.32)


def direction(azimuth, elevation):
    c = math.cos(elevation)
    return c * math.sin(azimuth), math.sin(elevation), -c * math.cos(azimuth)


TO_SUN = direction(SUN_AZIMUTH, SUN_HEIGHT)


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def sky(azimuth, elevation):
    d = direction(azimuth, elevation)
    if elevation < 0:
        return mix(GROUND, FAR_GROUND, math.exp(9 * math.sin(elevation)))
    cos_sun = sum(a * b for a, b in zip(d, TO_SUN))
    angle = math.acos(max(-1.0, min(1.0, cos_sun)))
    haze = 1 - math.exp(-0.32 / max(math.sin(elevation), 1e-3))
    halo = 0.9 * math.exp(-3 * angle) + 5 * math.exp(-14 * angle)
    base = mix(ZENITH, HORIZON, haze)
    side = 0.8 + 0.35 * cos_sun ** 2
    return tuple(b * side + h * halo for b, h in zip(base, HALO))


def sun_cover(x, y):
    """The share of a texel that the sun covers, by 24 x 24 points."""
    n, inside = 24, 0
    for j in range(n):
        elevation = (0.5 - (y + (j + 0.5) / n) / HEIGHT) * math.pi
        for i in range(n):
            azimuth = ((x + (i + 0.5) / n) / WIDTH - 0.5) * 2 * math.pi
            d = direction(azimuth, elevation)
            cos_sun = sum(a * b for a, b in zip(d, TO_SUN))
            inside += cos_sun > math.cos(SUN_RADIUS)
    return inside / n ** 2


def radiance(x, y):
    azimuth = ((x + 0.5) / WIDTH - 0.5) * 2 * math.pi
    elevation = (0.5 - (y + 0.5) / HEIGHT) * math.pi
    color = sky(azimuth, elevation)
    d = direction(azimuth, elevation)
    if sum(a * b for a, b in zip(d, TO_SUN)) < math.cos(math.radians(1)):
        return color
    cover = sun_cover(x, y)
    return tuple(c + cover * s for c, s in zip(color, SUN))


hdrfile.write("sky.hdr", WIDTH, HEIGHT, radiance)

#!/usr/bin/env python3
"""sky_pfm.py WIDTH OUT.pfm [studio]: a lat-long sky with a small sun, or a dim room with three softboxes, for programs that
read portable float maps."""
import math
import struct
import sys


def texel(x, y, width):
    up = math.cos(2.0 * math.pi * (y + 0.5) / width)
    if math.hypot(x / width - 0.35, y / width - 0.12) < 0.01:
        return (3000.0, 2900.0, 2700.0)
    return (0.4 + 0.4 * up, 0.4 + 0.6 * up, 0.5 + 0.9 * up) if up > 0.0 else (0.15, 0.14, 0.12)


SOFTBOXES = [  # column and row of the middle, width and height, as shares of the map; radiance
    (0.15, 0.25, 0.06, 0.10, (60.0, 58.0, 54.0)),
    (0.70, 0.38, 0.02, 0.20, (90.0, 90.0, 95.0)),
    (0.45, 0.42, 0.10, 0.04, (25.0, 20.0, 14.0)),
]


def studio(x, y, width):
    u, v = x / width, 2.0 * y / width
    for column, row, wide, high, light in SOFTBOXES:
        if abs(u - column) < wide / 2.0 and abs(v - row) < high / 2.0:
            return light
    return (0.10, 0.12, 0.16) if v < 0.5 else (0.02, 0.02, 0.02)


def main(width, path, light=texel):
    with open(path, "wb") as file:
        file.write(b"PF\n%d %d\n-1.0\n" % (width, width // 2))
        for y in reversed(range(width // 2)):
            for x in range(width):
                file.write(struct.pack("<3f", *light(x, y, width)))


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2], studio if sys.argv[3:] == ["studio"] else texel)

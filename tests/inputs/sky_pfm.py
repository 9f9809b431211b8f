#!/usr/bin/env python3
"""sky_pfm.py WIDTH OUT.pfm: a lat-long sky with a small sun, for programs that read portable float maps."""
import math
import struct
import sys


def texel(x, y, width):
    up = math.cos(2.0 * math.pi * (y + 0.5) / width)
    if math.hypot(x / width - 0.35, y / width - 0.12) < 0.01:
        return (3000.0, 2900.0, 2700.0)
    return (0.4 + 0.4 * up, 0.4 + 0.6 * up, 0.5 + 0.9 * up) if up > 0.0 else (0.15, 0.14, 0.12)


def main(width, path):
    with open(path, "wb") as file:
        file.write(b"PF\n%d %d\n-1.0\n" % (width, width // 2))
        for y in reversed(range(width // 2)):
            for x in range(width):
                file.write(struct.pack("<3f", *texel(x, y, width)))


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2])

#!/usr/bin/env python3
"""visibility_scenes.py FOLDER: writes the scenes of docs/visibility.md, meshes (.obj, z up) and the .json that names them.

The same on every machine. Meshes are named by absolute paths, so that --data of acdf render can be the folder of probes.
"""
import json
import math
import pathlib
import random
import sys


class Mesh:
    def __init__(self):
        self.points, self.faces, self.portals = [], [], []

    def face(self, *points):
        first = len(self.points) + 1
        self.points += points
        self.faces.append(range(first, first + len(points)))

    def grid(self, origin, u, v, steps_u, steps_v, holes=()):
        """A parallelogram of quads without those in holes (low u, low v, high u, high v, in quads).

        Holes are portals: light comes from the side that u x v points to.
        """
        def at(a, b):
            return tuple(o + a / steps_u * x + b / steps_v * y for o, x, y in zip(origin, u, v))
        for h in holes:
            self.portals.append({"corner": at(h[0], h[1]), "across": [(h[2] - h[0]) / steps_u * x for x in u],
                                 "up": [(h[3] - h[1]) / steps_v * y for y in v]})
        for i in range(steps_u):
            for k in range(steps_v):
                if not any(h[0] <= i < h[2] and h[1] <= k < h[3] for h in holes):
                    self.face(at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1))

    def box(self, low, high, steps=4):
        x, y, z = (b - a for a, b in zip(low, high))
        self.grid(low, (0, y, 0), (x, 0, 0), steps, steps)
        self.grid((low[0], low[1], high[2]), (x, 0, 0), (0, y, 0), steps, steps)
        self.grid(low, (x, 0, 0), (0, 0, z), steps, steps)
        self.grid((low[0], high[1], low[2]), (0, 0, z), (x, 0, 0), steps, steps)
        self.grid(low, (0, 0, z), (0, y, 0), steps, steps)
        self.grid((high[0], low[1], low[2]), (0, y, 0), (0, 0, z), steps, steps)

    def ellipsoid(self, centre, radii, steps):
        def at(i, k):
            theta, phi = math.pi * i / steps, math.pi * k / steps
            unit = (math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta))
            return tuple(c + r * x for c, r, x in zip(centre, radii, unit))
        for i in range(steps):
            for k in range(2 * steps):
                self.face(at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1))

    def write(self, path):
        with open(path, "w") as out:
            for point in self.points:
                out.write("v %.6g %.6g %.6g\n" % point)
            for face in self.faces:
                out.write("f " + " ".join(map(str, face)) + "\n")


def room():
    """Two windows in one wall, a door in another; nothing else lets light in."""
    mesh = Mesh()
    mesh.grid((-3, -4, 0), (6, 0, 0), (0, 8, 0), 24, 32)
    mesh.grid((-3, -4, 3), (0, 8, 0), (6, 0, 0), 32, 24)
    mesh.grid((3, -4, 0), (0, 8, 0), (0, 0, 3), 40, 30, [(6, 9, 14, 24), (24, 9, 34, 24)])
    mesh.grid((-3, -4, 0), (0, 0, 3), (0, 8, 0), 12, 32)
    mesh.grid((-3, 4, 0), (0, 0, 3), (6, 0, 0), 12, 24)
    mesh.grid((-3, -4, 0), (6, 0, 0), (0, 0, 3), 30, 30, [(12, 0, 16, 21)])
    mesh.box((-1.2, -0.6, 0), (-0.2, 1.0, 0.75))
    mesh.ellipsoid((1.0, 1.8, 0.5), (0.5, 0.5, 0.5), 16)
    return mesh, {"from": [-2.6, -3.4, 1.9], "to": [1.2, 2.0, 0.6], "fov": 62}, "probes/venice_sunset_1k.hdr"


def courtyard():
    """Four house fronts of different heights around a yard."""
    mesh = Mesh()
    mesh.grid((-15, -15, 0), (30, 0, 0), (0, 30, 0), 40, 40)
    for low, high in (((-9, -9, 0), (-6, 9, 7)), ((6, -9, 0), (9, 9, 5)), ((-6, 6, 0), (6, 9, 9)), ((-6, -9, 0), (1, -6, 4))):
        mesh.box(low, high, 12)
    mesh.ellipsoid((0.5, 0, 1), (1, 1, 1), 20)
    return mesh, {"from": [-4.5, -5, 2.6], "to": [2, 2, 1.2], "fov": 55}, "probes/noon_grass_1k.hdr"


def car():
    """A body, a cabin and four wheels on the floor of a studio: over 100,000 triangles."""
    mesh = Mesh()
    mesh.grid((-8, -8, 0), (16, 0, 0), (0, 16, 0), 40, 40)
    mesh.ellipsoid((0, 0, 0.75), (2.1, 0.85, 0.45), 130)
    mesh.ellipsoid((-0.2, 0, 1.1), (1.1, 0.7, 0.45), 90)
    for x in (-1.3, 1.3):
        for y in (-0.75, 0.75):
            mesh.ellipsoid((x, y, 0.35), (0.35, 0.12, 0.35), 30)
    return mesh, {"from": [4.2, -3.6, 1.8], "to": [0, 0, 0.6], "fov": 42}, "probes/studio_small_05_1k.hdr"


def trees():
    """Leaves by the ten thousand over a meadow, the worst case: over 100,000 triangles."""
    mesh, numbers = Mesh(), random.Random(5)
    mesh.grid((-10, -10, 0), (20, 0, 0), (0, 20, 0), 40, 40)
    for tree in range(7):
        angle = 2.0 * math.pi * tree / 7
        x, y = 3.6 * math.cos(angle), 3.6 * math.sin(angle)
        mesh.box((x - 0.12, y - 0.12, 0), (x + 0.12, y + 0.12, 2.2), 2)
        for _ in range(15000):
            d = [numbers.gauss(0, 1) for _ in range(3)]
            r = 1.4 * numbers.random() ** (1 / 3) / math.sqrt(sum(c * c for c in d))
            p = (x + r * d[0], y + r * d[1], 2.9 + 0.8 * r * d[2])
            sides = [[0.09 * numbers.gauss(0, 1) for _ in range(3)] for _ in range(2)]
            mesh.face(p, *[tuple(a + b for a, b in zip(p, side)) for side in sides])
    return mesh, {"from": [0.3, -5.6, 1.5], "to": [0, 1, 1.0], "fov": 60}, "probes/noon_grass_1k.hdr"


def roof():
    """A terrace under a roof on four posts, with a table and a ball: the sky is seen at the sides."""
    mesh = Mesh()
    mesh.grid((-12, -12, 0), (24, 0, 0), (0, 24, 0), 40, 40)
    mesh.box((-4, -3, 2.6), (4, 3, 2.8), 12)
    for x in (-3.8, 3.6):
        for y in (-2.8, 2.6):
            mesh.box((x, y, 0), (x + 0.2, y + 0.2, 2.6), 3)
    mesh.box((-1, -0.6, 0.7), (1, 0.6, 0.8), 4)
    mesh.ellipsoid((2, 0.8, 0.5), (0.5, 0.5, 0.5), 16)
    return mesh, {"from": [-5.5, -6.5, 2.2], "to": [0.5, 0, 0.8], "fov": 50}, "probes/venice_sunset_1k.hdr"


def open_ground():
    """Objects on open ground: contact shadows alone."""
    mesh = Mesh()
    mesh.grid((-8, -8, 0), (16, 0, 0), (0, 16, 0), 40, 40)
    mesh.ellipsoid((0, 0, 0.8), (0.8, 0.8, 0.8), 40)
    mesh.box((-2.4, 0.4, 0), (-1.2, 1.6, 1.2), 6)
    mesh.ellipsoid((1.6, -1.0, 0.4), (0.4, 0.4, 0.4), 24)
    return mesh, {"from": [4, -5, 2.4], "to": [0, 0, 0.5], "fov": 40}, "probes/venice_sunset_1k.hdr"


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    for make in (room, courtyard, car, trees, roof, open_ground):
        name = make.__name__
        mesh, camera, probe = make()
        mesh.write(folder / f"{name}.obj")
        scene = {"description": make.__doc__.split("\n")[0], "camera": camera, "image": {"width": 64, "height": 48},
                 "light": {"probe": probe},
                 "objects": [{"mesh": {"file": str(folder / f"{name}.obj")}, "brdf": "lambert:albedo=0.6"}],
                 "samples": 16, "samplers": ["local:1MB", "visibility:4MB", "full-cdf", "cosine", "mis(local:1MB,cosine)"]}
        if mesh.portals:
            scene["portals"] = mesh.portals
        (folder / f"{name}.json").write_text(json.dumps(scene, indent=1) + "\n")
        print(name, sum(len(face) - 2 for face in mesh.faces), "triangles")


if __name__ == "__main__":
    main()

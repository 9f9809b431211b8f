#!/usr/bin/env python3
"""partner_exact.py DATA: what files for an MIS partner are worth, by summation over texels: the relative variance of an
estimate of one sample of the light and one of the cosine, mean over the pixels of hidden-grace.json (16 x 12 of them)
with nothing hidden and behind its wall, and over 400 random normals. DATA holds probes/; ACDF names the program
(default: build/release/tools/acdf). Maps are resized to 256 x 128 by oiiotool. Needs numpy."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
ACDF = os.environ.get("ACDF", str(ROOT / "build/release/tools/acdf"))
PROBES = ["venice_sunset_1k.hdr", "city.exr", "noon_grass_1k.hdr"]
FILES = ["env:64KiB", "env:64KiB --mis mean", "env:64KiB --mis cosine", "env:64KiB --mis cosine --scene",
         "env:64KiB --mis cosine --heuristic power --scene", "local:1MB", "local:1MB --mis cosine",
         "local:1MB --mis cosine --heuristic power"]
W, H = 256, 128


def texels():
    """Directions of texels' middles, and their solid angles."""
    theta, phi = (np.arange(H) + 0.5) * np.pi / H, np.pi - 2 * np.pi * (np.arange(W) + 0.5) / W
    band = np.cos(np.pi * np.arange(H) / H) - np.cos(np.pi * (np.arange(H) + 1) / H)
    d = np.stack([np.outer(np.sin(theta), np.cos(phi)), np.outer(np.sin(theta), np.sin(phi)),
                  np.outer(np.cos(theta), np.ones(W))], -1)
    return d.reshape(-1, 3), np.outer(band, np.full(W, 2 * np.pi / W)).ravel()


DIRECTIONS, OMEGA = texels()


class Points:
    """Surfaces that are lit: normals, albedos, and which texels each sees."""

    def __init__(self, normals, albedo, seen=None):
        self.normals, self.albedo, self.seen = normals, albedo, seen
        self.cosine = np.maximum(0, normals @ DIRECTIONS.T)

    def variance(self, light, p, power=False):
        """Of two samples, mean over points, relative to (L^2 + (0.1 mean L)^2) as acdf render has it. p: pdf of each
        texel, for all points or for each."""
        f, b = self.cosine * light, self.cosine / np.pi
        f = f if self.seen is None else f * self.seen
        p = np.broadcast_to(p, f.shape)
        with np.errstate(all="ignore"):
            ours, theirs = (f * p / (p * p + b * b), f * b / (p * p + b * b)) if power else [f / (p + b)] * 2
        ours, theirs = np.where(f > 0, ours, 0), np.where(f > 0, theirs, 0)
        spread = sum(((x * x * q) @ OMEGA - ((x * q) @ OMEGA) ** 2) for x, q in ((ours, p), (theirs, b)))
        bright = self.albedo * (f @ OMEGA)
        return float(np.mean(self.albedo**2 * spread / (bright**2 + (0.1 * bright.mean()) ** 2)))


def blocked(position, on_plane):
    """Which texels the wall, the sphere or the plane hides."""
    with np.errstate(all="ignore"):
        near = (np.array([-9, 1.8, 0.3]) - position) / DIRECTIONS
        far = (np.array([6, 2.2, 7]) - position) / DIRECTIONS
    enter, leave = np.minimum(near, far).max(1), np.maximum(near, far).min(1)
    out = (enter <= leave) & (enter > 0)
    if on_plane:
        middle = DIRECTIONS @ (np.array([0, 0, 1.0]) - position)
        gap = ((np.array([0, 0, 1.0]) - position - middle[:, None] * DIRECTIONS) ** 2).sum(1)
        return out | ((middle > 0) & (gap < 1))
    foot = position[:2] - position[2] / np.where(DIRECTIONS[:, 2:] < 0, DIRECTIONS[:, 2:], -1) * DIRECTIONS[:, :2]
    return out | ((DIRECTIONS[:, 2] < 0) & ((foot**2).sum(1) <= 900))


def scene(width=16, height=12):
    """What the camera of hidden-grace.json sees, a sphere on a plane: with nothing hidden, and behind the wall."""
    eye, centre = np.array([5, -1.5, 2.6]), np.array([0, 0, 1.0])
    forward = np.array([0, 0, 0.75]) - eye
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, [0, 0, 1])
    right /= np.linalg.norm(right)
    above, half = np.cross(right, forward), np.tan(36 * np.pi / 360)
    pixel, normals, albedo, seen = 2 * half / height, [], [], []
    for y in range(height):
        for x in range(width):
            ray = forward + (x + 0.5 - 0.5 * width) * pixel * right + (half - (y + 0.5) * pixel) * above
            ray /= np.linalg.norm(ray)
            middle = (centre - eye) @ ray
            across = centre - eye - middle * ray
            on_plane = across @ across > 1
            at = eye + (-eye[2] / ray[2] if on_plane else middle - np.sqrt(1 - across @ across)) * ray
            if on_plane and not (ray[2] < 0 and np.linalg.norm(at[:2]) <= 30):
                continue
            normals.append([0, 0, 1.0] if on_plane else at - centre)
            albedo.append(0.5 if on_plane else 0.8)
            seen.append(~blocked(at, on_plane))
    normals, albedo = np.array(normals), np.array(albedo)
    return Points(normals, albedo), Points(normals, albedo, np.array(seen))


def luminance(image):
    text = subprocess.run(["oiiotool", "--dumpdata", image], capture_output=True, text=True, check=True).stdout
    rgb = [[float(v) for v in m[1].split()[:3]] for m in re.finditer(r"Pixel \([^)]*\): ([^\n]*)", text)]
    return np.maximum(0, np.array(rgb) @ [0.2126, 0.7152, 0.0722])


def pdf_of(file, normal=None):
    points = "\n".join("%.9g %.9g %.9g" % tuple(d) for d in DIRECTIONS)
    of = [] if normal is None else ["--normal=" + ",".join("%.9g" % v for v in normal)]
    text = subprocess.run([ACDF, "pdf", file, *of], input=points, capture_output=True, text=True, check=True).stdout
    return np.array([float(v) for v in text.split()])


def rows(image, light, work, point_sets):
    compensated = np.maximum(0, light - light @ OMEGA / (4 * np.pi))
    compensated /= compensated @ OMEGA
    for name, power in (("compensated full table", False), ("compensated full table, power heuristic", True)):
        yield name, [points.variance(light, compensated, power) for points in point_sets]
    for name in FILES:
        kind, _, options = name.partition(":")
        budget, *options = options.replace("--scene", "--scene " + work + "/scene.txt").split()
        file = work + "/file.acdf"
        subprocess.run([ACDF, kind, image, "--budget", budget, "-f", "-q", "-o", file, *options], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        if kind == "env":
            p = pdf_of(file)
            yield f"`{name}`", [points.variance(light, p, "power" in name) for points in point_sets]
            continue
        different, which = np.unique(point_sets[0].normals, axis=0, return_inverse=True)
        p = np.array([pdf_of(file, n) for n in different])[which.ravel()]
        yield f"`{name}`", [points.variance(light, p, "power" in name) for points in point_sets[:2]] + [np.nan]


def main(data):
    normals = np.random.default_rng(1).normal(size=(400, 3))
    open_scene, behind = scene()
    point_sets = [open_scene, behind, Points(normals / np.linalg.norm(normals, axis=1)[:, None], np.ones(400))]
    table = {}
    with tempfile.TemporaryDirectory() as work:
        np.savetxt(work + "/scene.txt", open_scene.normals, fmt="%.9g")
        for probe in PROBES:
            image = work + "/" + probe + ".exr"
            subprocess.run(["oiiotool", f"{data}/probes/{probe}", "--ch", "R,G,B", "--resize:filter=box", f"{W}x{H}",
                            "-d", "float", "-o", image], check=True, stdout=subprocess.DEVNULL)
            for name, figures in rows(image, luminance(image), work, point_sets):
                table.setdefault(name, []).append(figures)
    for i, what in enumerate(("nothing hidden", "behind the wall", "all normals")):
        print(f"| one sample of each, {what} |", " | ".join(probe.split(".")[0] for probe in PROBES), "|")
        print("|---|" + "---|" * len(PROBES))
        for name, figures in table.items():
            if figures[0][i] == figures[0][i]:
                print(f"| {name} |", " | ".join("%.4g" % of[i] for of in figures), "|")
        print()


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: docs/make/partner_exact.py DATA")
    main(sys.argv[1])

#!/usr/bin/env python3
"""octahedral_exact.py DATA: files for maps on the octahedral square, beside those for the lat-long probes that the maps were
made of. What `acdf env` prints is held to a sum over 6 x 6 directions in each texel, whose pdfs the reader returns. DATA
holds probes/; ACDF names the program (default: build/release/tools/acdf); PROBES, SIZES and BUDGETS choose among rows.
Needs numpy, oiiotool and, in PYTHONPATH, the module acdf (build/release/lib/python)."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import acdf
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
ACDF = os.environ.get("ACDF", str(ROOT / "build/release/tools/acdf"))
PROBES = os.environ.get("PROBES", "city.exr noon_grass_1k.hdr venice_sunset_1k.hdr").split()
SIZES = [int(size) for size in os.environ.get("SIZES", "256 512 1024 2048").split()]
BUDGETS = os.environ.get("BUDGETS", "64KiB 1MiB").split()
POINTS = 6


def pixels(image):
    """The red, green and blue of an image, (height, width, 3)."""
    text = subprocess.run(["oiiotool", "--dumpdata", image], capture_output=True, text=True, check=True).stdout
    width, height = (int(v) for v in re.search(r": *(\d+) x *(\d+),", text).groups())
    rgb = [m[1].split()[:3] for m in re.finditer(r"Pixel \([^)]*\): ([^\n]*)", text)]
    return np.maximum(0, np.array(rgb, float)).reshape(height, width, 3)


def directions(n, rows, x, y):
    """Of the points (x, y) within the texels of some rows of an octahedral map of n x n texels: Clarberg (2008), eq. 3."""
    u, v = np.meshgrid((2 * np.arange(n) + 2 * x) / n - 1, (2 * rows + 2 * y) / n - 1)
    away = 1 - np.abs(u) - np.abs(v)
    r = 1 - np.abs(away)
    phi = np.pi / 4 * ((np.abs(v) - np.abs(u)) / np.where(r == 0, 1, r) + 1)
    across = r * np.sqrt(np.maximum(0, 2 - r * r))
    return np.stack([np.copysign(np.cos(phi), u) * across, np.copysign(np.sin(phi), v) * across,
                     np.copysign(1 - r * r, away)], -1)


def octahedral(probe, n, bilinear):
    """An n x n map, in its own axes, of a lat-long image in pbrt's: one look at the middle of each texel."""
    height, width = probe.shape[:2]
    d = directions(n, np.arange(n), 0.5, 0.5)
    x = np.mod(np.arctan2(d[..., 1], d[..., 0]), 2 * np.pi) / (2 * np.pi) * width
    y = np.arccos(np.clip(d[..., 2], -1, 1)) / np.pi * height
    if not bilinear:
        return probe[np.minimum(y.astype(int), height - 1), np.minimum(x.astype(int), width - 1)]
    left, top = np.floor(x - 0.5).astype(int), np.floor(y - 0.5).astype(int)
    s, t = (x - 0.5 - left)[..., None], (y - 0.5 - top)[..., None]
    row = [np.clip(top + i, 0, height - 1) for i in (0, 1)]
    column = [np.mod(left + i, width) for i in (0, 1)]
    return ((1 - t) * ((1 - s) * probe[row[0], column[0]] + s * probe[row[0], column[1]])
            + t * ((1 - s) * probe[row[1], column[0]] + s * probe[row[1], column[1]]))


def write_pfm(path, image):
    with open(path, "wb") as file:
        file.write(b"PF\n%d %d\n-1\n" % (image.shape[1], image.shape[0]))
        file.write(image[::-1].astype("<f4").tobytes())


def make(image, budget, projection, file):
    """What `acdf env` prints of the file that it makes."""
    subprocess.run([ACDF, "env", image, "--budget", budget, "--projection", projection, "--filter", "nearest",
                    "-f", "-q", "-o", file],
                   check=True, stdout=subprocess.DEVNULL)
    return json.loads(subprocess.run([ACDF, "info", file, "--json"], check=True, capture_output=True).stdout)["accuracy"]


def summed(image, file):
    """Relative variance, largest weight over the mean, and the share of light with pdf 0, by the reader's pdfs."""
    light = image.astype("<f4").astype(float) @ [0.2126, 0.7152, 0.0722]
    n, view = len(light), acdf.open(file)
    mean, second, largest, lost, step = light.mean() * 4 * np.pi, 0, 0, 0, max(1, 2**20 // len(light))
    for first in range(0, n, step):
        rows = np.arange(first, min(n, first + step))
        f = light[rows]
        for i in range(POINTS * POINTS):
            d = directions(n, rows, (i % POINTS + 0.5) / POINTS, (i // POINTS + 0.5) / POINTS)
            d = np.stack([-d[..., 0], d[..., 1], d[..., 2]], -1)  # pbrt's axes are a mirror image of acdf's
            p = view.pdf(d.reshape(-1, 3).astype("f4")).reshape(f.shape).astype(float)
            with np.errstate(all="ignore"):
                weight = np.where(f > 0, f / p, 0)
            reached = p > 0
            lost += f[~reached].sum()
            second += (f * weight)[reached].sum()
            largest = max(largest, weight[reached].max(initial=0))
    texel = 4 * np.pi / (n * n * POINTS * POINTS)
    return second * texel / mean**2 - 1, largest / mean, lost * texel / mean


def main(data):
    columns = ["printed", "summed", "over lat-long", "largest weight, printed", "summed", "light lost"]
    print("| probe | texels | looked up |", " | ".join(f"{b}: {c}" for b in BUDGETS for c in columns), "|")
    print("|---|---|---|" + "---|" * (len(columns) * len(BUDGETS)))
    with tempfile.TemporaryDirectory() as work:
        for name in PROBES:
            probe = pixels(f"{data}/probes/{name}")
            own = [make(f"{data}/probes/{name}", budget, "latlong", work + "/own.acdf") for budget in BUDGETS]
            print(f"| {name.split('.')[0]} | {probe.shape[1]} × {probe.shape[0]}, lat-long | |",
                  " | ".join(f"{told['relative_variance']:.3g} | | 1 | {told['max_weight']:.3g} | |" for told in own), "|")
            for n in SIZES:
                for how in ("nearest", "bilinear"):
                    image, row = octahedral(probe, n, how == "bilinear"), f"| | {n}² | {how} |"
                    write_pfm(work + "/map.pfm", image)
                    for budget, other in zip(BUDGETS, own):
                        told = make(work + "/map.pfm", budget, "octahedral", work + "/map.acdf")
                        variance, weight, lost = summed(image, work + "/map.acdf")
                        row += (f" {told['relative_variance']:.3g} | {variance:.3g} |"
                                f" {told['relative_variance'] / other['relative_variance']:.2g} |"
                                f" {told['max_weight']:.3g} | {weight:.3g} | {lost:.1g} |")
                    print(row, flush=True)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: docs/make/octahedral_exact.py DATA")
    main(sys.argv[1])

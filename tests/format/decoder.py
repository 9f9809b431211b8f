#!/usr/bin/python3
"""The decoder of format/decoder, which was written from SPEC.md alone, against the program: on the test vectors, on the
examples of format/examples.md, and on files of every kind and fit that the program makes anew.

    decoder.py [--program ACDF --make-vectors MAKE_VECTORS] [--broken-files TEST_RULES]... [FILE.acdf FILE.csv]...

Tolerances are those of SPEC.md §6.7 and §14.1: tables bit for bit; directions to the neighbouring float or 2^-29; densities to a
relative 1e-6 at the direction that the vectors tell.
"""
import argparse
import csv
import math
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "format"))

from decoder import Refused, load  # noqa: E402
from decoder.brdf import Brdf  # noqa: E402
from decoder.halvings import Halvings  # noqa: E402
from decoder.indexed import Indexed, dot  # noqa: E402
from decoder.local import Local  # noqa: E402
from decoder.planes import tree_of_planes  # noqa: E402
from decoder.sphere import Environment, Sphere  # noqa: E402
from decoder.table import Table  # noqa: E402
from decoder.tree import Tree  # noqa: E402

GOLDEN = ROOT / "tests" / "golden" / "v1.0"
VECTORS = ROOT / "format" / "vectors"
DENSITY = 1e-6
WARNINGS = {6012}


class Failures:
    def __init__(self):
        self.count = self.compared = 0

    def check(self, good, what):
        self.compared += 1
        if not good:
            self.count += 1
            if self.count <= 20:
                print("FAIL", what)


def is_near(value, wanted):
    """A float of a direction."""
    return abs(value - wanted) <= max(float(np.spacing(np.float32(abs(wanted)))), 2.0**-29)


def is_pdf(value, wanted):
    return value == wanted if wanted == 0 or not math.isfinite(wanted) else abs(value - wanted) <= DENSITY * wanted


# ---- vectors --------------------------------------------------------------------------------------------


def numbers(row, names):
    return [float(row[name]) for name in names]


def columns_of(row, letter):
    return [name for name in row if name[0] == letter and name[1:].isdigit()]


def compare_table_row(view, row, fail, where):
    index = [int(row[name]) for name in columns_of(row, "i")]
    wanted_x, wanted = numbers(row, columns_of(row, "x")), float(row["pdf"])
    if row["call"] == "pdf":
        return fail.check(view.pdf(index, wanted_x) == wanted, where)
    x, pdf = view.sample(index, numbers(row, columns_of(row, "u")))
    fail.check((x or [0.0] * len(wanted_x)) == wanted_x and pdf == wanted, f"{where}: {x} {pdf}")
    if wanted > 0:
        fail.check(view.pdf(index, wanted_x) == wanted, f"{where}: found again")


def compare_direction_row(view, row, fail, where):
    """Kinds 1 to 3; of 2 and 3 a normal or a view comes first, of 2 there may be a position."""
    letter = {Local: "n", Brdf: "o"}.get(type(view))
    given = [numbers(row, [letter + axis for axis in "xyz"])] if letter else []
    wanted_direction, wanted = numbers(row, "xyz"), float(np.float32(row["pdf"]))
    place = {"position": numbers(row, ["px", "py", "pz"])} if "px" in row else {}
    found = view.pdf(*given, wanted_direction, **place)
    if row["call"] == "pdf":
        return fail.check(is_pdf(found, wanted), f"{where}: {found}")
    *direction, pdf = view.sample(*given, *numbers(row, ["u0", "u1"]), **place)
    same = [float(np.float32(x)) for x in wanted_direction] == direction
    fail.check(all(map(is_near, direction, wanted_direction)), f"{where}: {direction}")
    # A neighbouring float has another pdf where that varies fast: then it is found for the direction given.
    fail.check(is_pdf(pdf if same or not isinstance(view, Brdf) else found, wanted), f"{where}: {pdf}")
    fail.check((found > 0) == (wanted > 0), f"{where}: found again {found}")


def compare_inverse(view, row, fail, where):
    """What the numbers of a direction lead to: within 2^-20 the direction again, as both may lie on a border."""
    direction = numbers(row, "xyz")
    u = view.invert(direction)
    fail.check((u is None) == (view.pdf(direction) == 0), f"{where}: {u}")
    if u is not None:
        again = view.sample(*u)[:3]
        length = math.hypot(*direction)
        fail.check(all(abs(x - y / length) < 2.0**-20 for x, y in zip(again, direction)), f"{where}: again {again}")


def compare_environment_row(view, row, fail, where):
    compare_direction_row(view, row, fail, where)
    compare_inverse(view, row, fail, where)


def compare_indexed_row(view, row, fail, where):
    """Samples of the cone lie as far from its middle; readers choose from where its azimuth counts."""
    sky = view.at(numbers(row, columns_of(row, "t")))
    if row["call"] == "pdf" or not sky.is_in_cone(float(row["u1"])):
        return compare_direction_row(sky, row, fail, where)
    wanted = numbers(row, "xyz")
    *direction, _ = sky.sample(*numbers(row, ["u0", "u1"]))
    fail.check(abs(dot(direction, sky.sun) - dot(wanted, sky.sun)) < 2.0**-22, f"{where}: {direction}")
    fail.check(is_pdf(sky.pdf(wanted), float(np.float32(row["pdf"]))), f"{where}: {sky.pdf(wanted)}")


def compare(view, path, fail):
    if isinstance(view, Indexed):
        compare_row = compare_indexed_row
    elif isinstance(view, Environment):
        compare_row = compare_environment_row
    else:
        compare_row = compare_table_row if isinstance(view, Table) else compare_direction_row
    with open(path, newline="") as lines:
        for number, row in enumerate(csv.DictReader(lines), 2):
            compare_row(view, row, fail, f"{path.name}:{number}")


def stored_vectors(fail):
    paths = sorted(VECTORS.glob("*.csv"))
    fail.check(len(paths) >= 18, "there are vectors")
    for path in paths:
        beside = path.with_suffix(".acdf")
        file = beside if beside.exists() else GOLDEN / beside.name
        compare(load(file.read_bytes()), path, fail)


# ---- examples.md ----------------------------------------------------------------------------------------


def hex_examples():
    """The blocks ```hex: each line an offset, two spaces, bytes, two spaces, a remark. Bytes that are not listed are 0."""
    blocks, inside = [], False
    for line in (ROOT / "format" / "examples.md").read_text(encoding="utf-8").splitlines():
        if line.startswith("```"):
            inside = line == "```hex"
            if inside:
                blocks.append(bytearray())
        elif inside:
            blocks[-1] += bytes(int(line[:4], 16) - len(blocks[-1])) + bytes.fromhex(line[6:].split("  ")[0])
    return [bytes(block) for block in blocks]


def examples_of_the_text(fail):
    """The numbers of the text: a file of halvings, and the planes of a tree for the same grid."""
    file, planes = hex_examples()
    halved = load(file + bytes(-len(file) % 64))
    wanted = (-0.119618, 0.378052, 0.918024, 0.241204)
    fail.check(np.allclose(halved.sample(0.1, 0.25), wanted, rtol=0, atol=1e-6), "halvings, a sample")
    fail.check(abs(halved.pdf((0.0, 0.8, 0.6)) - 0.011942) < 1e-6, "halvings, the second leaf")
    fail.check(halved.pdf((0.6, 0.0, -0.8)) == 0.0, "halvings, below")
    tree = tree_of_planes(zlib.decompress(planes), 14)
    fail.check(tree == bytes.fromhex("8108FF020300000A400300400000"), "the tree of planes")
    second = Environment(Tree(tree), 0, Sphere(8, 4))
    left, right = 64 / 255 * 8 / (2 * math.pi * 3), 191 / 255 * 8 / (2 * math.pi * 5)
    fail.check(is_pdf(second.pdf((-0.6, 0.0, 0.8)), float(np.float32(0.5 * left))), "curves, the seam")
    fail.check(is_pdf(second.pdf((0.6, 0.0, 0.8)), float(np.float32(right))), "curves, right")
    fail.check(second.pdf((0.0, 0.6, -0.8)) == 0.0, "curves, below")
    wanted = (-0.219401, 0.623990, 0.75, 0.108987)
    fail.check(np.allclose(second.sample(0.1, 0.25), wanted, rtol=0, atol=1e-6), "curves, a sample")


# ---- damage ---------------------------------------------------------------------------------------------


def damaged_files(fail):
    """Every byte of a file stands under some check."""
    for name in ("untilted", "local", "brdf_floor", "planes", "halvings", "halvings_zlib", "indexed"):
        data = (GOLDEN / f"{name}.acdf").read_bytes()
        for at in range(0, len(data), 7):
            broken = bytearray(data)
            broken[at] ^= 0x55
            try:
                load(broken)
                refused = at in (14, 15) or 32 <= at < 36  # minor version, optional features: their CRC is wrong
            except Refused:
                refused = True
            fail.check(refused, f"{name}: byte {at}")


def broken_files(programs, fail):
    """Files that break one rule each, as the tests of the reader make them: refused by the number of that rule."""
    with tempfile.TemporaryDirectory() as name:
        for program in programs:
            subprocess.run([program, "--gtest_filter=*.brokenFilesAreWrittenWhereAskedFor"], check=True,
                           capture_output=True, env=dict(os.environ, ACDF_BROKEN_FILES=name))
        files = sorted(pathlib.Path(name).glob("*.acdf"))
        fail.check(len(files) > 250, "there are broken files")
        for file in files:
            wanted = int(file.name.split("_")[0])
            try:
                load(file.read_bytes())
                found = 0
            except Refused as refused:
                found = refused.rule
            fail.check(found == (0 if wanted in WARNINGS else wanted), f"{file.name}: {found or 'not refused'}")


# ---- extremes -------------------------------------------------------------------------------------------


def with_bytes(data, chunk, at, value):
    """A file with other bytes in the payload of a chunk that is stored as it is, and with right CRCs."""
    out = bytearray(data)
    count = struct.unpack_from("<I", out, 36)[0]
    record = next(64 + 48 * i for i in range(count) if out[64 + 48 * i:68 + 48 * i] == chunk)
    codec, _, offset, length = struct.unpack_from("<IIQQ", out, record + 8)
    assert codec == 0 and at + len(value) <= length
    out[offset + at:offset + at + len(value)] = value
    struct.pack_into("<I", out, record + 12, zlib.crc32(out[offset:offset + length]))
    struct.pack_into("<I", out, 60, zlib.crc32(out[64:64 + 48 * count], zlib.crc32(out[:60])))
    return bytes(out)


def extreme_files(make_vectors, fail):
    """Numbers that no program writes and every reader must take: windows that weigh more than a float holds, or less."""
    portals = (GOLDEN / "portals.acdf").read_bytes()
    at = portals.index(b"PORT")
    offset = struct.unpack_from("<Q", portals, at + 16)[0]
    count, maps = struct.unpack_from("<2I", portals, offset)
    with tempfile.TemporaryDirectory() as name:
        folder, files = pathlib.Path(name), []
        for i, unit in enumerate((3.4e38, 1e30, 1e-30, 1e-44)):
            data = portals
            for one in range(maps):
                data = with_bytes(data, b"PORT", 16 + 24 * count + 40 * one + 36, struct.pack("<f", unit))
            files.append(folder / f"unit_{i}.acdf")
            files[-1].write_bytes(data)
        run(folder, make_vectors, folder, *files)
        for file in files:
            compare(load(file.read_bytes()), file.with_suffix(".csv"), fail)


# ---- fresh files ----------------------------------------------------------------------------------------


def write_pfm(path, image):
    height, width, _ = image.shape
    path.write_bytes(b"PF\n%d %d\n-1.0\n" % (width, height) + image[::-1].astype("<f4").tobytes())


def sky(width, height, sun=(0.48, -0.6, 0.64)):
    """A bright disc over a gradient, a dark ground, and a corner without light: nothing symmetric."""
    theta = (np.arange(height)[:, None] + 0.5) * math.pi / height
    phi = math.pi - (np.arange(width)[None, :] + 0.5) * 2 * math.pi / width
    direction = np.stack(np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi),
                                             np.cos(theta)), axis=-1)
    light = 0.05 + np.maximum(direction[..., 2], 0) + 20000.0 * (direction @ np.array(sun) > math.cos(0.035))
    light[3 * height // 4:, : width // 3] = 0.0
    return light[..., None] * np.array([1.0, 0.9, 0.7])


def inputs(folder):
    write_pfm(folder / "sky.pfm", sky(192, 96))
    i, j, k = np.indices((5, 9, 31)) / np.array([5, 9, 31])[:, None, None, None]
    field = np.exp(-8 * (i - j) ** 2 - 30 * (k - 0.3 * i - 0.2) ** 2) * (k < 0.9)
    # (theta_o, phi_o, theta_h, phi_h), a lobe that is wider along one axis
    t, p, h, q = np.indices((5, 6, 16, 8)) / np.array([5, 6, 16, 8])[:, None, None, None, None]
    np.save(folder / "brushed.npy", 0.05 + np.exp(-(8 + 4 * t) * h * (1 + np.cos(2 * math.pi * (q + p)) ** 2)))
    write_pfm(folder / "later.pfm", sky(192, 96, (0.6, 0.48, 0.64)))
    np.save(folder / "line.npy", field[2, 4])
    np.save(folder / "field.npy", field)


FRESH = [["env", "sky.pfm", *options.split()] for options in (
    "--cells 200", "--cells 200 --compress zlib", "--cells 3000 --domain octahedral",
    "--cells 200 --filter bilinear --channel rgb", "--fit cdf --knots 12x9",
    "--fit cdf --order phi --gradient 2 --knots 9x12 --compress zlib", "--fit pdf --knots 12x9",
    "--fit uniform --knots 8x8 --compress zlib")]
FRESH += [["env", "sky.pfm", "later.pfm", *options.split()] for options in (
    "--axis time=6,18 --budget 6KiB", "--axis time=6,18 --no-sun --budget 6KiB --compress zlib --domain latlong")]
FRESH += [["local", "sky.pfm", *options.split()] for options in (
    "--budget 24KiB", "--budget 24KiB --cosine-share 0.25 --compress zlib", "--budget 24KiB --mis cosine",
    "--no-sharing --normals 3 --knots 4x4",
    "--no-sharing --normals 5x3 --fit cdf --knots 6x6 --cosine-share 0.1",
    "--no-sharing --normals 5x3 --fit uniform --knots 6x6 --compress zlib")]
FRESH += [["brdf", *options.split()] for options in (
    "ggx:alpha=0.2 --cells 80 --views 6 --diffuse-floor 0.125 --compress zlib", "brushed.npy --cells 60 --views 4x6",
    "brushed.npy --fit cdf --knots 6x8 --views 3x4", "blinn:e=40 --fit pdf --knots 6x8 --views 5 --compress zlib",
    "lambert --fit uniform --knots 6x8 --views 4")]
FRESH += [["table", *options.split()] for options in (
    "line.npy --cells 12 --names x --range x=-1:1", "field.npy --cells 300 --indexed 1", "field.npy --cells 200",
    "field.npy --cells 600 --indexed 2 --names i,j,nm --range nm=730:380 --compress zlib")]


FEATURES = {"halvings", "tilts", "links", "rows", "trees of bins", "azimuths", "mirrored"}


def features(view):
    """What of the format a file uses: fresh files together shall use it all."""
    halved = isinstance(view.tree, Halvings)
    has_rows = getattr(view, "rows_of_views" if isinstance(view, Brdf) else "rows", None) is not None
    curves = [] if halved else view.tree.curves.values()
    uses = {"halvings": halved, "tilts": any(curve.tilts for curve in curves), "links": any(curve.links for curve in curves),
            "rows": has_rows, "trees of bins": isinstance(view, (Local, Brdf)) and not has_rows,
            "azimuths": getattr(view, "F", 1) > 1, "mirrored": getattr(view, "mirrored", False)}
    return {name for name, there in uses.items() if there}


def run(folder, *command):
    done = subprocess.run([str(part) for part in command], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}: {done.stderr}")


def fresh_files(program, make_vectors, fail):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        inputs(folder)
        files = []
        for i, (kind, source, *options) in enumerate(FRESH):
            files.append(folder / f"{kind}_{i}.acdf")
            run(folder, program, kind, source, *options, "-o", files[-1], "--quiet", "--threads", 2)
        run(folder, make_vectors, folder, *files)
        used = set()
        for file, command in zip(files, FRESH):
            before, view = fail.count, load(file.read_bytes())
            used |= features(view)
            compare(view, file.with_suffix(".csv"), fail)
            if fail.count != before:
                print("in", *command)
        fail.check(used == FEATURES, f"fresh files do not use {FEATURES - used}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program")
    parser.add_argument("--make-vectors")
    parser.add_argument("--broken-files", action="append",
                        help="a test program that writes files that break one rule each")
    parser.add_argument("pairs", nargs="*", type=pathlib.Path)
    options = parser.parse_args()
    fail = Failures()
    for file, path in zip(options.pairs[::2], options.pairs[1::2]):
        compare(load(file.read_bytes()), path, fail)
    if not options.pairs:
        stored_vectors(fail)
        examples_of_the_text(fail)
        damaged_files(fail)
        if options.broken_files:
            broken_files(options.broken_files, fail)
        if options.make_vectors:
            extreme_files(options.make_vectors, fail)
        if options.program:
            fresh_files(options.program, options.make_vectors, fail)
    print(f"{fail.compared} compared, {fail.count} wrong")
    return 1 if fail.count or not fail.compared else 0


if __name__ == "__main__":
    sys.exit(main())

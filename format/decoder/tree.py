"""SPEC.md §7.2 and §7.3: curves, and the traversals that sample and find cells."""
import math
import struct
from bisect import bisect_right

import numpy as np

from .refused import require

LEAST = 2.0**-1000
UNSIGNED = {1: "<u1", 2: "<u2", 4: "<u4"}


class Curve:
    """`cumulative` and `positions` with the implied ends; positions[0] and [n] are None."""

    def __init__(self, tree, unit):
        at = 2 * unit
        h, = struct.unpack_from("<H", tree, at)
        self.axis, c, p, link, tilted, self.n = h & 7, h >> 3 & 3, h >> 5 & 3, h >> 7 & 3, h >> 9 & 1, h >> 10
        require(c <= 2 and p <= 2, 6004)
        at += 2
        if self.n == 0:
            require(len(tree) - at >= 4, 6005)
            self.n, = struct.unpack_from("<I", tree, at)
            require(64 <= self.n <= 1048575, 6005)
            at += 4
        self.maximum = (1 << 8 * (1 << c)) - 1
        gaps = []
        interior, at = array(tree, at, 1 << c, self.n - 1, gaps)
        self.cumulative = [0, *interior, self.maximum]
        knots, at = array(tree, at, 1 << p, self.n - 1, gaps)
        self.positions = [None, *knots, None]
        self.relative = p == 0
        self.links = self.tilts = None
        if link:
            self.links, at = array(tree, at, 1 << link - 1, self.n, gaps)
        at = padded(at, 2, gaps)
        if tilted:
            require(at + 2 * self.n <= len(tree), 6002)
            self.tilts = np.frombuffer(tree, "<i2", self.n, at).tolist()
            at += 2 * self.n
        require(at <= len(tree), 6002)
        require(not any(any(tree[low:high]) for low, high in gaps), 6011)
        self.end = at // 2

    def position(self, i, low):
        """Of interior knot i; `low` is the low end of the inherited range."""
        return self.positions[i] + (low if self.relative else 0)

    def narrowed(self, i, box):
        """The part of the inherited range that segment i covers."""
        low, high = box
        return [low if i == 0 else self.position(i, low), high if i == self.n - 1 else self.position(i + 1, low)]

    def child(self, i):
        return self.links[i] if self.links else 0

    def probability(self, i):
        return self.cumulative[i + 1] - self.cumulative[i]

    def tilt(self, i):
        return self.tilts[i] if self.tilts else 0


def padded(at, size, gaps):
    """The next multiple of `size`; what lies between is padding."""
    to = -(-at // size) * size
    gaps.append((at, to))
    return to


def array(tree, at, size, count, gaps):
    at = padded(at, size, gaps)
    require(at + size * count <= len(tree), 6002)
    return np.frombuffer(tree, UNSIGNED[size], count, at).tolist(), at + size * count


class Tree:
    """All curves by the units at which they start."""

    def __init__(self, data):
        require(len(data) > 0 and len(data) % 2 == 0 and len(data) // 2 <= 4294967294, 6001)
        self.curves, unit = {}, 0
        while unit < len(data) // 2:
            require(len(self.curves) + 1 <= len(data) // 4 + 1, 6018)
            self.curves[unit] = Curve(data, unit)
            unit = self.curves[unit].end

    def draw(self, root, u, box, s):
        """§7.3. `u`, `box` (low and high) and `s`, by axis, become those of the cell. Returns p."""
        p, unit = 1.0, root
        while True:
            curve = self.curves[unit]
            a = curve.axis
            m = float(curve.maximum)
            v = u[a] * m
            if v >= m:
                v = m * (1.0 - 2.0**-53)
            i = bisect_right(curve.cumulative, v) - 1
            u[a] = (v - curve.cumulative[i]) / curve.probability(i)
            p = p * (curve.probability(i) / m)
            box[a] = curve.narrowed(i, box[a])
            if curve.tilts:
                s[a] = curve.tilts[i] / 32768
            if curve.child(i) == 0:
                return max(p, LEAST)
            unit += curve.child(i)

    def find(self, root, square, box, s, strata=None):
        """§7.3. Returns p, 0 where no sample can fall. `strata`, by axis, become l and w of §6.5."""
        p, unit = 1.0, root
        while True:
            curve = self.curves[unit]
            a = curve.axis
            origin = box[a][0] if curve.relative else 0
            i = bisect_right(curve.positions, square[a] - origin, 1, curve.n) - 1
            if curve.probability(i) == 0:
                return 0.0
            p = p * (curve.probability(i) / float(curve.maximum))
            if strata is not None:
                low, width = strata[a]
                strata[a] = [low + width * curve.cumulative[i] / curve.maximum,
                             width * curve.probability(i) / curve.maximum]
            box[a] = curve.narrowed(i, box[a])
            if curve.tilts:
                s[a] = curve.tilts[i] / 32768
            if curve.child(i) == 0:
                return max(p, LEAST)
            unit += curve.child(i)


def fraction_sampled(u, s):
    """t of §7.3."""
    return u if s == 0 else 2 * u / ((1 - s) + math.sqrt((1 - s) * (1 - s) + 4 * s * u))


def random_number_at(low, width, s, t):
    """u of §6.5."""
    return low + width * (t + s * (t * t - t))


def slope(s, t):
    return 1 + s * (2 * t - 1)


# ---- the rules of §7.2 ------------------------------------------------------------------------------------


def check_tree(tree, axes, roots):
    """`roots`: pairs of a unit and the box, by axis, that is inherited there."""
    check_values(tree, axes)
    check_paths(tree, roots)
    for axis, description in enumerate(axes):
        if description.role == 0:
            check_ranges(tree, axis, roots)


def check_values(tree, axes):
    for curve in tree.curves.values():
        require(curve.axis < len(axes) and axes[curve.axis].role == 0, 6003)
        knots = curve.positions[1:-1]
        require(all(p < q for p, q in zip(knots, knots[1:])), 6006)
        require(all(p <= q for p, q in zip(curve.cumulative, curve.cumulative[1:])), 6008)
        require(not curve.tilts or -32768 not in curve.tilts, 6013)


def check_paths(tree, roots):
    depth, tilted = {unit: 1 for unit, _ in roots}, {}
    for unit, curve in tree.curves.items():  # in the order of the file: after all parents
        axes = tilted.get(unit, 0)
        require(depth.get(unit, 0) <= 64, 6016)
        require(not (unit in depth and axes >> curve.axis & 1), 6014)
        for i in range(curve.n if curve.links else 0):
            if curve.links[i] == 0:
                continue
            require(curve.probability(i) > 0, 6015)
            child = unit + curve.links[i]
            require(child in tree.curves, 6009)
            if unit in depth:
                depth[child] = max(depth.get(child, 0), depth[unit] + 1)
                tilted[child] = tilted.get(child, 0) | axes | (curve.tilt(i) != 0) << curve.axis


def check_ranges(tree, axis, roots):
    """§7.2: the largest inherited low end, the smallest high end, and whether all low ends were the same."""
    inherited = {}

    def inherit(unit, low, high, same):
        if unit in inherited:
            known = inherited[unit]
            same = same and known[2] and known[0] == low
            low, high = max(low, known[0]), min(high, known[1])
        inherited[unit] = (low, high, same)

    for unit, box in roots:
        inherit(unit, *box[axis], True)
    for unit, curve in tree.curves.items():
        if unit not in inherited:
            continue
        low, high, same = inherited[unit]
        splits = curve.axis == axis and curve.n > 1
        if splits:
            require(same or not curve.relative, 6019)
            require(curve.position(1, low) > low and curve.position(curve.n - 1, low) < high, 6007)
        for i in range(curve.n if curve.links else 0):
            if curve.links[i] != 0:
                part = curve.narrowed(i, [low, high]) if splits else [low, high]
                inherit(unit + curve.links[i], *part, same or (splits and i > 0))

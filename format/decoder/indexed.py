"""SPEC.md §15: environments of several maps."""
import math
import struct

from .description import check_sphere_axes
from .halvings import STEPS, Bits, Halvings, share, words
from .refused import require


class Map:
    def __init__(self, data):
        self.share, self.sun_share, self.radius, *self.sun = struct.unpack("<6f", data)

    def is_right(self, sun):
        length = sum(x * x for x in self.sun)
        return (math.isfinite(self.share) and self.share > 0 and 0 <= self.sun_share < 1 and (self.radius == 0 or 2.0**-10 <= self.radius <= 1) and
                (abs(length - 1) < 1e-3 if self.radius > 0 else length == 0) and
                (self.sun_share == 0 or (sun > 0 and self.radius > 0)))


def check_indexed_axes(d):
    require(len(d.axes) >= 2, 7020)
    check_sphere_axes(d)
    require(3 <= len(d.axes) <= 5, 7020)
    for axis in d.axes[2:]:
        require(axis.role == 1 and axis.measure == 0 and 2 <= axis.resolution <= 65536, 7020)
    require(d.bin_count == math.prod(axis.resolution for axis in d.axes[2:]), 7020)


class Indexed:
    """Chunks HALV and MAPS."""

    partner = None

    def __init__(self, halvings, data, d):
        self.d = d
        self.tree = Halvings(halvings, [axis.resolution for axis in d.axes[:2]])
        require(len(data) >= 16, 6036)
        count, splits, self.code_bits, self.sun = struct.unpack_from("<4I", data)
        require(count == d.bin_count and splits <= self.tree.count, 6036)
        require(4 <= self.code_bits <= 12 and self.sun <= 4, 6036)
        counts = [axis.resolution for axis in d.axes[2:]]
        maps_at = 16 + 8 * sum(counts)
        bits_at = maps_at + 24 * count
        codes_at = bits_at + 4 * words(self.tree.count)
        require(len(data) == codes_at + 4 * words(count * splits * self.code_bits), 6036)
        self.read_coordinates(data, counts)
        self.maps = [Map(data[maps_at + 24 * i:maps_at + 24 * i + 24]) for i in range(count)]
        require(all(each.is_right(self.sun) for each in self.maps), 7022)
        require(abs(sum(each.share for each in self.maps) - 1) <= 2.0**-20, 7022)
        self.read_splits(Bits(data[bits_at:codes_at]), splits)
        codes = Bits(data[codes_at:])
        self.codes = [[codes.take(self.code_bits) for _ in range(splits)] for _ in range(count)]
        require(codes.is_used_up(), 6038)

    def read_coordinates(self, data, counts):
        at, self.coordinates = 16, []
        for axis, count in zip(self.d.axes[2:], counts):
            here = list(struct.unpack_from(f"<{count}d", data, at))
            at += 8 * count
            require(all(map(math.isfinite, here)) and here[0] == axis.low and here[-1] == axis.high, 7021)
            require(all(a < b for a, b in zip(here, here[1:])), 7021)
            self.coordinates.append(here)

    def read_splits(self, bits, splits):
        """The halved nodes in preorder: `number` of those with codes of maps."""
        found, waiting = 0, [(self.tree.root, True)]
        while waiting:
            node, top = waiting.pop()
            node.number = None
            if not node.halves:
                continue
            own = bits.take(1) == 1
            require(top or not own, 6037)
            if own:
                node.number, found = found, found + 1
            waiting += [(half, own) for half in reversed(node.halves)]
        require(found == splits, 6037)
        require(bits.is_used_up(), 6038)

    def steps(self, number, code_of, node_steps):
        """Of a map: what leads to the lower half of a split."""
        code = code_of[number]
        if node_steps == 0 or code == 0:
            return 0
        if code == (1 << self.code_bits) - 1:
            return node_steps
        lower = max(node_steps * share(code, self.code_bits) >> 31, 1)
        return lower if lower < node_steps else node_steps - 1

    def probability(self, number, square):
        """Of one map: of the cell that holds a square, in the part that the cone leaves to the tree."""
        node, here = self.tree.root, STEPS
        while node.number is not None:
            lower = self.steps(node.number, self.codes[number], here)
            upper = square[node.axis] >= node.halves[1].box[node.axis][0]
            here = here - lower if upper else lower
            node = node.halves[upper]
        tile = node.probability()
        while node.halves:
            node = node.halves[square[node.axis] >= node.halves[1].box[node.axis][0]]
        return here / STEPS * (node.probability() / tile if tile > 0 else 1.0)

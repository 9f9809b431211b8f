"""SPEC.md §9: rows of normals or views at the top of a tree of halvings. What Tiles is to trees of curves."""
import math
import struct

from .halvings import STEPS, Bits, share, words
from .refused import require
from .sphere import clamp

WEIGHTS = 1 << 21


def whole_weights(weights):
    """Step 3 of §15.2."""
    total = sum(weights)
    v = [max(math.floor(w / total * WEIGHTS + 0.5), 1) for w in weights]
    most = weights.index(max(weights))
    v[most] += WEIGHTS - sum(v)
    return v


class NormalRows:
    """Chunk NORM beside the tree of HALV. `tiles` are nodes, in their order."""

    def __init__(self, tree, data, bin_count):
        self.tree = tree
        require(len(data) >= 16 and len(data) % 4 == 0, 6039)
        self.row_count, splits, self.code_bits, reserved = struct.unpack_from("<4I", data)
        codes_at = 16 + 4 * words(tree.count)
        require(len(data) >= codes_at and reserved == 0, 6039)
        require(1 <= self.row_count <= bin_count and splits <= tree.count and 4 <= self.code_bits <= 8, 6039)
        require(self.row_count * splits <= 64 * len(data), 6039)
        self.tiles = []
        self.read_splits(Bits(data[16:codes_at]), splits)
        self.count = len(self.tiles)
        codes = Bits(data[codes_at:])
        self.before = [self.read_row(codes) for _ in range(self.row_count)]
        require(8 * len(codes.data) - codes.at < 32, 6039)
        require(codes.is_used_up(), 6038)
        most = 1
        while most * most < self.count:
            most *= 2
        self.groups = self.groups_below(tree.root, most)

    def tiles_below(self, node):
        return sum(map(self.tiles_below, node.halves)) if node.is_split else 1

    def groups_below(self, node, most):
        """Pairs of a node and its first tile."""
        if self.tiles_below(node) <= most:
            return [(node, self.first_tile(node))]
        return [group for half in node.halves for group in self.groups_below(half, most)]

    @staticmethod
    def first_tile(node):
        while node.is_split:
            node = node.halves[0]
        return node.tile

    def read_splits(self, bits, splits):
        found, waiting = 0, [(self.tree.root, True)]
        while waiting:
            node, top = waiting.pop()
            node.is_split = False
            if node.halves:
                node.is_split = bits.take(1) == 1
                require(top or not node.is_split, 6037)
                found += node.is_split
                waiting += [(half, node.is_split) for half in reversed(node.halves)]
            if top and not node.is_split:
                node.tile = len(self.tiles)
                self.tiles.append(node)
        require(found == splits, 6037)
        require(bits.is_used_up(), 6038)

    def read_row(self, codes):
        """The steps of all tiles before each, and of all."""
        steps, waiting = [], [(self.tree.root, STEPS)]
        while waiting:
            node, n = waiting.pop()
            if not node.is_split:
                steps.append(n)
                continue
            lower = self.lower(codes, n) if n > 0 else 0
            waiting += [(node.halves[1], n - lower), (node.halves[0], lower)]
        before = [0]
        for n in steps:
            before.append(before[-1] + n)
        return before

    def lower(self, codes, n):
        require(8 * len(codes.data) - codes.at >= self.code_bits, 6040)
        code = codes.take(self.code_bits)
        if code == 0:
            return 0
        if code == (1 << self.code_bits) - 1:
            return n
        require(n >= 2, 6040)
        return min(max(n * share(code, self.code_bits) >> 31, 1), n - 1)

    def mixed(self, mixture):
        """M: of a tile, the sum over rows of v times the steps before it."""
        v = whole_weights([w for _, w in mixture])
        return lambda t: sum(k * self.before[row][t] for k, (row, _) in zip(v, mixture))

    def draw(self, mixture, u):
        M = self.mixed(mixture)
        x = u[0] * 2.0**52
        at = min(math.floor(x), 2**52 - 1)
        node, first = [group for group in self.groups if M(group[1]) <= at][-1]
        c = M(first + self.tiles_below(node)) - M(first)
        u[0] = clamp((x - M(first)) / c, 0, 1)
        x = u[1] * float(c)
        m = min(math.floor(x), c - 1)
        while node.is_split:
            upper = self.first_tile(node.halves[1])
            L = M(upper) - M(first)
            is_upper = m >= L
            if is_upper:
                x, m, first = x - L, m - L, upper
            node = node.halves[is_upper]
        c = M(first + 1) - M(first)
        u[1] = clamp(x / c, 0, 1)
        return first, c / 2.0**52

    def tile_of(self, square):
        node = self.tree.root
        while node.is_split:
            node = node.halves[square[node.axis] >= node.halves[1].box[node.axis][0]]
        return node.tile

    def find(self, mixture, square):
        tile, M = self.tile_of(square), self.mixed(mixture)
        return tile, (M(tile + 1) - M(tile)) / 2.0**52

    def sample_within(self, _tree, tile, p, u, box, _s):
        """§6.3 from a tile on: u are shares of its steps."""
        root = node = self.tiles[tile]
        box[:] = node.box
        if not node.halves:
            return p
        step = []
        for a, (low, high) in enumerate(root.steps):
            u[a] = u[a] * (high - low) + low
            step.append(min(math.floor(u[a]), high - 1))
        while node.halves:
            node = node.halves[step[node.axis] >= node.halves[1].steps[node.axis][0]]
        for a, (low, high) in enumerate(node.steps):
            u[a] = clamp((u[a] - low) / (high - low), 0, 1)
        box[:] = node.box
        return self.of_tile(root, node, p)

    def find_within(self, _tree, tile, p, square, box, _s):
        root = node = self.tiles[tile]
        while node.halves:
            node = node.halves[square[node.axis] >= node.halves[1].box[node.axis][0]]
        box[:] = node.box
        return self.of_tile(root, node, p)

    @staticmethod
    def of_tile(root, node, p):
        return p if not root.halves else p * (node.probability() / root.probability())

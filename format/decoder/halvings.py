"""SPEC.md §6.2, and what §6.3, §6.4 and §6.5 say of trees of halvings."""
import math
import struct

from .refused import require

STEPS = 1 << 31
MOST_HALVINGS = 134217727


class Bits:
    """A run of bits, the lowest of each byte first."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, count):
        value = 0
        for i in range(count):
            value |= (self.data[self.at // 8] >> self.at % 8 & 1) << i
            self.at += 1
        return value

    def is_at_end(self):
        return self.at == 8 * len(self.data)

    def is_used_up(self):
        return not any(self.take(1) for _ in range(8 * len(self.data) - self.at))


def words(bits):
    return (bits + 31) // 32


def share(code, code_bits):
    """Of a node's random numbers, what leads to its lower half, in steps of 2^-31."""
    q = float((1 << code_bits) - 1)
    j = 2.0 * code - q
    e = 14.0 * q * q * q
    o = j * (11.0 * q * q + 3.0 * j * j)
    a, b = e + o, e - o
    return math.floor(a * a / (a * a + b * b) * 2147483648.0 + 0.5)


def threshold(low, high, code, code_bits):
    """The first step of [low, high) that leads to the upper half."""
    if code == 0:
        return low
    if code == (1 << code_bits) - 1:
        return high
    wide = high - low
    require(wide >= 2, 6033)
    return low + min(max(wide * share(code, code_bits) >> 31, 1), wide - 1)


class Node:
    """A node: `box` and `steps`, by axis, low and high. One that is halved has `axis` and `halves`, lower and upper."""

    def __init__(self, box, steps):
        self.box, self.steps, self.axis, self.halves = box, steps, None, None

    def halve(self, axis, border):
        """Also where random numbers are divided: at `border`."""
        self.axis = axis
        low, high = self.box[axis]
        middle = (low + high) // 2
        first, last = self.steps[axis]
        self.halves = [self.with_axis(axis, [low, middle], [first, border]),
                       self.with_axis(axis, [middle, high], [border, last])]

    def with_axis(self, axis, box, steps):
        node = Node(list(self.box), list(self.steps))
        node.box[axis], node.steps[axis] = box, steps
        return node

    def is_dark(self):
        return any(low == high for low, high in self.steps)

    def probability(self):
        p = 1.0
        for low, high in self.steps:
            p = p * ((high - low) / STEPS)
        return p

    def leaf(self, is_upper):
        """Below this node."""
        node = self
        while node.halves:
            node = node.halves[is_upper(node)]
        return node


def read_trees(data, roots):
    """Chunk HALV, of a tree below each root. Returns how many nodes of each are halved."""
    require(len(data) >= 16, 6030)
    count, code_bits, *reserved = struct.unpack_from("<4I", data)
    require(count <= MOST_HALVINGS and 2 <= code_bits <= 12 and not any(reserved), 6030)
    axis_bits = (len(roots[0].box) - 1).bit_length() if roots else 0
    codes_at = 16 + 4 * words((2 + axis_bits) * count + len(roots))
    require(len(data) == codes_at + 4 * words(code_bits * count), 6030)
    structure, codes = Bits(data[16:codes_at]), Bits(data[codes_at:])
    counts = []
    for root in roots:
        counts.append(0)
        waiting = [root]
        while waiting:
            node = waiting.pop()
            if structure.is_at_end() or structure.take(1) == 0:
                continue
            counts[-1] += 1
            require(sum(counts) <= count, 6031)
            axis, code = structure.take(axis_bits), codes.take(code_bits)
            require(axis < len(node.box), 6032)
            low, high = node.box[axis]
            require(high - low >= 2, 6032)
            require(not node.is_dark(), 6033)
            node.halve(axis, threshold(*node.steps[axis], code, code_bits))
            waiting += reversed(node.halves)
    require(sum(counts) == count, 6031)
    require(structure.is_used_up() and codes.is_used_up(), 6034)
    return counts


class Halvings:
    """Chunk HALV of one tree. What Tree is to curves: `draw` and `find` change `u`, `box` and, of `find`, `strata`, by
    axis, to those of the cell. The other arguments are those of Tree."""

    def __init__(self, data, resolutions):
        self.root = Node([[0, n] for n in resolutions], [[0, STEPS] for _ in resolutions])
        self.count, = read_trees(data, [self.root])

    def draw(self, _root, u, box, _s):
        """§6.3. Returns p."""
        step = [min(math.floor(v * STEPS), STEPS - 1) for v in u]
        leaf = self.root.leaf(lambda node: step[node.axis] >= node.halves[1].steps[node.axis][0])
        for a, (low, high) in enumerate(leaf.steps):
            u[a] = (u[a] * STEPS - low) / (high - low)
        box[:] = leaf.box
        return leaf.probability()

    def find(self, _root, square, box, _s, strata=None):
        """§6.4. Returns p, 0 where no sample can fall."""
        leaf = self.root.leaf(lambda node: square[node.axis] >= node.halves[1].box[node.axis][0])
        box[:] = leaf.box
        if strata is not None:
            strata[:] = [[low / STEPS, (high - low) / STEPS] for low, high in leaf.steps]
        return leaf.probability()

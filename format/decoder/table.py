"""SPEC.md §8: tables."""
import math

from .halvings import STEPS, Node, read_trees
from .refused import require
from .sphere import clamp, random_number

LEAST, MOST = 2.2250738585072014e-308, 1.7976931348623157e+308
NONE = 0xFFFFFFFF


class Table:
    def __init__(self, halvings, axes, bins):
        self.axes, self.bins = axes, bins
        self.indexed = [axis for axis in axes if axis.role == 1]
        self.sampled = axes[len(self.indexed):]
        resolutions = [axis.resolution for axis in self.sampled]
        self.trees = [Node([[0, n] for n in resolutions], [[0, STEPS] for _ in resolutions]) if share > 0 else None
                      for _, share in bins]
        counts = iter(read_trees(halvings, [tree for tree in self.trees if tree]))
        before = 0
        for tree, (root, _) in zip(self.trees, bins):
            count = next(counts) if tree else 0
            require(root == (before if count else NONE), 9007)
            before += count

    def root(self, index):
        """None where there is nothing to sample."""
        number = 0
        for axis, i in zip(self.indexed, index):
            if not 0 <= i < axis.resolution:
                return None
            number = number * axis.resolution + i
        return self.trees[number]

    def sample(self, index, u):
        """Returns the coordinates and the density; None and 0 where nothing is sampled."""
        root = self.root(index)
        if root is None:
            return None, 0.0
        u = [random_number(v) for v in u]
        step = [min(math.floor(v * STEPS), STEPS - 1) for v in u]
        leaf = root.leaf(lambda node: step[node.axis] >= node.halves[1].steps[node.axis][0])
        out = []
        for axis, v, (r, s), (x0, x1) in zip(self.sampled, u, leaf.steps, leaf.box):
            t = min((v * STEPS - r) / (s - r), 1.0)
            b = 2.0**-48 * max(abs(axis.low), abs(axis.high)) * axis.resolution / abs(axis.high - axis.low)
            position = clamp(x0 + t * (x1 - x0), x0 + b, x1 - b)
            out.append(axis.low + (axis.high - axis.low) * (position / axis.resolution))
        return out, self.density(leaf)

    def density(self, leaf):
        p = leaf.probability()
        if not p > 0:
            return 0.0
        for axis, (x0, x1) in zip(self.sampled, leaf.box):
            p = p * (axis.resolution / (abs(axis.high - axis.low) * (x1 - x0)))
        return clamp(p, LEAST, MOST)

    def pdf(self, index, x):
        root = self.root(index)
        if root is None:
            return 0.0
        square = []
        for axis, coordinate in zip(self.sampled, x):
            if not min(axis.low, axis.high) <= coordinate <= max(axis.low, axis.high):
                return 0.0
            position = (coordinate - axis.low) / (axis.high - axis.low) * axis.resolution
            square.append(min(math.floor(position), axis.resolution - 1))
        return self.density(root.leaf(lambda node: square[node.axis] >= node.halves[1].box[node.axis][0]))

"""SPEC.md §8: tables."""
import math

from .sphere import clamp, random_number
from .tree import fraction_sampled, slope

LEAST, MOST = 2.2250738585072014e-308, 1.7976931348623157e+308


class Table:
    def __init__(self, tree, axes, bins):
        self.tree, self.axes, self.bins = tree, axes, bins
        self.indexed = [axis for axis in axes if axis.role == 1]
        self.sampled = axes[len(self.indexed):]

    def root(self, index):
        """None where there is nothing to sample."""
        number = 0
        for axis, i in zip(self.indexed, index):
            if not 0 <= i < axis.resolution:
                return None
            number = number * axis.resolution + i
        root, share = self.bins[number]
        return root if share > 0 else None

    def whole(self):
        return [[0, axis.resolution] for axis in self.axes], [0.0] * len(self.axes)

    def sample(self, index, u):
        """Returns the coordinates and the density; None and 0 where nothing is sampled."""
        root, first = self.root(index), len(self.indexed)
        if root is None:
            return None, 0.0
        box, s = self.whole()
        left = [0.0] * first + [random_number(v) for v in u]
        p = self.tree.draw(root, left, box, s)
        out = []
        for k in range(first, len(self.axes)):
            axis, (x0, x1) = self.axes[k], box[k]
            b = 2.0**-48 * max(abs(axis.low), abs(axis.high)) * axis.resolution / abs(axis.high - axis.low)
            position = clamp(x0 + fraction_sampled(left[k], s[k]) * (x1 - x0), x0 + b, x1 - b)
            out.append(axis.low + (axis.high - axis.low) * (position / axis.resolution))
        return out, self.density(p, box, s, [self.position(axis, x) for axis, x in zip(self.sampled, out)])

    @staticmethod
    def position(axis, coordinate):
        return (coordinate - axis.low) / (axis.high - axis.low) * axis.resolution

    def density(self, p, box, s, positions):
        if not p > 0:
            return 0.0
        for k, position in enumerate(positions, len(self.indexed)):
            axis, (x0, x1) = self.axes[k], box[k]
            p = p * (axis.resolution / (abs(axis.high - axis.low) * (x1 - x0)))
            if s[k] != 0:
                p = p * slope(s[k], clamp((position - x0) / (x1 - x0), 0.0, 1.0))
        return clamp(p, LEAST, MOST)

    def pdf(self, index, x):
        root = self.root(index)
        if root is None:
            return 0.0
        square, positions = [0] * len(self.indexed), []
        for axis, coordinate in zip(self.sampled, x):
            if not min(axis.low, axis.high) <= coordinate <= max(axis.low, axis.high):
                return 0.0
            positions.append(self.position(axis, coordinate))
            square.append(min(math.floor(positions[-1]), axis.resolution - 1))
        box, s = self.whole()
        return self.density(self.tree.find(root, square, box, s), box, s, positions)

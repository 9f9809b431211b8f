"""SPEC.md §9: what the bins of a file share, and the traversals of its splits."""
import struct

import numpy as np

from .refused import require
from .tree import LEAST

TILE = 0x8000
NO_ROOT = 0xFFFFFFFF


class Split:
    def __init__(self, place, lower, upper):
        self.axis, self.position, self.child = place & 7, place >> 3, (lower, upper)


class Tiles:
    """`roots` is None where all tiles are cells; `boxes` are the inherited ranges of the tiles on axes 0 and 1."""

    def __init__(self, tile, rows, axes):
        require(len(tile) >= 528, 6020)
        self.count, root_count, self.row_count, reserved = struct.unpack_from("<4I", tile)
        require(1 <= self.count <= 32768 and root_count in (0, self.count) and reserved == 0, 6020)
        require(len(tile) == 520 + 8 * self.count + 4 * root_count, 6020)
        book = struct.unpack_from("<256H", tile, 16)
        require(book[0] == 0 and book[255] == 65535 and all(p < q for p, q in zip(book, book[1:])), 6021)
        self.codebook = [float(value) for value in book]
        self.splits = [Split(*fields) for fields in struct.iter_unpack("<IHH", tile[528:520 + 8 * self.count])]
        self.roots = list(struct.unpack_from(f"<{root_count}I", tile, 520 + 8 * self.count)) if root_count else None
        self.whole = [[0, axes[0].resolution], [0, axes[1].resolution]]
        self.boxes = self.walk()
        require(rows is not None and len(rows) == self.row_count * (self.count - 1), 6025)
        self.rows = np.frombuffer(rows, np.uint8).reshape(self.row_count, self.count - 1)

    def first(self):
        return 0 if self.count > 1 else TILE

    def walk(self):
        """Rules 6022 and 6023."""
        boxes, next_split = [], 0
        waiting = [(self.first(), 0, self.whole)]
        while waiting:
            node, depth, box = waiting.pop()
            if node & TILE:
                require(node == TILE | len(boxes), 6022)
                boxes.append(box)
                continue
            require(node == next_split and node < len(self.splits) and depth < 48, 6022)
            next_split += 1
            split = self.splits[node]
            require(split.axis < 2 and box[split.axis][0] < split.position < box[split.axis][1], 6023)
            for upper in (1, 0):
                part = [list(box[0]), list(box[1])]
                part[split.axis][1 - upper] = split.position
                waiting.append((split.child[upper], depth + 1, part))
        require(len(boxes) == self.count, 6022)
        return boxes

    def root(self, tile):
        return NO_ROOT if self.roots is None else self.roots[tile]

    def path(self, tile):
        """The splits above a tile, each with the side that leads to it."""
        box, node, steps = self.boxes[tile], self.first(), []
        while not node & TILE:
            split = self.splits[node]
            upper = int(box[split.axis][0] >= split.position)
            steps.append((node, upper))
            node = split.child[upper]
        return steps

    def is_dark(self, row, tile):
        """Whether a row gives a tile nothing."""
        return any(self.rows[row, node] == (255 if upper else 0) for node, upper in self.path(tile))

    def trees(self):
        """The root of each tile that has one, and its box."""
        return [(root, self.boxes[tile]) for tile, root in enumerate(self.roots or []) if root != NO_ROOT]

    def draw(self, mixture, u):
        """Steps 1 to 3. `mixture`: pairs of a row and its weight. Changes u; returns the tile and its p."""
        w = [weight for _, weight in mixture]
        v, q, whole = list(w), [1.0] * len(w), sum_of(w)
        c, x, node = whole, [u[0] * whole, u[1] * whole], self.first()
        while not node & TILE:
            split = self.splits[node]
            a, o = split.axis, 1 - split.axis
            e = [self.codebook[self.rows[row, node]] for row, _ in mixture]
            lower = [vk * (ek * (1 / 65535)) for vk, ek in zip(v, e)]
            upper = [vk - lk for vk, lk in zip(v, lower)]
            low, high = sum_of(lower), sum_of(upper)
            if x[a] >= low and high > 0:
                x[a], x[o], c, v = x[a] - low, x[o] * (high / c), high, upper
                q = [qk * ((65535 - ek) * (1 / 65535)) for qk, ek in zip(q, e)]
                node = split.child[1]
            else:
                x[o], c, v = x[o] * (low / c), low, lower
                q = [qk * (ek * (1 / 65535)) for qk, ek in zip(q, e)]
                node = split.child[0]
        for a in (0, 1):
            u[a] = 1.0 if x[a] >= c else x[a] / c
        p = sum_of([wk * qk for wk, qk in zip(w, q)])
        return node & ~TILE, max(p / whole, LEAST)

    def find(self, mixture, square):
        """The tile of a square and its p, 0 where P is 0."""
        w, q, node = [weight for _, weight in mixture], [1.0] * len(mixture), self.first()
        while not node & TILE:
            split = self.splits[node]
            upper = int(square[split.axis] >= split.position)
            e = [self.codebook[self.rows[row, node]] for row, _ in mixture]
            q = [qk * ((65535 - ek if upper else ek) * (1 / 65535)) for qk, ek in zip(q, e)]
            node = split.child[upper]
        p = sum_of([wk * qk for wk, qk in zip(w, q)])
        return node & ~TILE, max(p / sum_of(w), LEAST) if p > 0 else 0.0

    def sample_within(self, tree, tile, p, u, box, s):
        """Step 4, from a tile whose probability is p."""
        box[:2] = [list(self.boxes[tile][0]), list(self.boxes[tile][1])]
        if self.root(tile) == NO_ROOT:
            return p
        return max(p * tree.draw(self.root(tile), u, box, s), LEAST)

    def find_within(self, tree, tile, p, square, box, s):
        box[:2] = [list(self.boxes[tile][0]), list(self.boxes[tile][1])]
        if self.root(tile) == NO_ROOT:
            return p
        inside = tree.find(self.root(tile), square, box, s)
        return max(p * inside, LEAST) if inside > 0 else 0.0


def sum_of(values):
    """In their order, in f64."""
    total = 0.0
    for value in values:
        total = total + value
    return total
